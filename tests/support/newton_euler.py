"""Newton–Euler equations of payload, quadrotors and joints as one linear system in NumPy; no law of the package."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from law_values import flat
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Quat, spread, vec3
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.readings import ImuReading

G = 9.81
UP = np.array([0.0, 0.0, 1.0])


class Parts(NamedTuple):
    """The vehicle in plain arrays, body axes from the payload's centre: N joints (N × 3) and N quadrotors (N × 3)."""

    mass: float
    inertia: np.ndarray
    joints: np.ndarray
    quadrotors: np.ndarray
    masses: np.ndarray
    inertias: np.ndarray

    @property
    def centre(self) -> np.ndarray:
        return self.masses @ self.quadrotors / (self.mass + self.masses.sum())


class Given(NamedTuple):
    """The loads at an instant: thrusts (N) and torques (N × 3) of quadrotors, the push [N, world] at a point of the
    payload (body axes), winds (N × 3, world) on the quadrotors."""

    thrusts: np.ndarray
    torques: np.ndarray
    push: np.ndarray
    at: np.ndarray
    winds: np.ndarray


class Answer(NamedTuple):
    """Acceleration of the payload's centre [world], angular acceleration, joint forces and torques, body axes."""

    linear: np.ndarray
    angular: np.ndarray
    force: np.ndarray
    torque: np.ndarray


def paper_parts(extra: float = 0.0) -> Parts:
    """The paper's vehicle, its payload heavier by `extra` [kg]."""
    return Parts(
        0.5 + extra,
        np.diag([0.5 / 3.0, 0.000625, 0.5 / 3.0]),
        np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]),
        np.array([[0.0, 1.0, 0.075], [0.0, -1.0, 0.075]]),
        np.array([1.5, 1.5]),
        np.array([np.diag([0.029125, 0.029125, 0.055225])] * 2),
    )


def vehicle_of(p: Parts, length: float | None = None) -> Any:
    """These parts as estimators read them from a vehicle, with a beam of a length [m] or no beam."""
    payload = SimpleNamespace(mass=p.mass, tensor=p.inertia, center_of_mass=np.zeros(3), span=length)
    quadrotors = [
        SimpleNamespace(mass=mass, joint_position=joint, position=position)
        for mass, joint, position in zip(p.masses, p.joints, p.quadrotors, strict=True)
    ]
    return SimpleNamespace(payload=payload, quadrotors=quadrotors, payload_center=-p.centre)


def random_parts(rng: np.random.Generator, count: int) -> Parts:
    def inertia(size: float) -> np.ndarray:
        a = rng.standard_normal((3, 3))
        return size * (a @ a.T + np.eye(3))

    at = rng.uniform(-1.0, 1.0, (count, 3))
    masses = rng.uniform(0.5, 2.0, count)
    inertias = np.array([inertia(0.02) for _ in range(count)])
    return Parts(
        float(rng.uniform(0.3, 2.0)), inertia(0.1), at, at + 0.1 * rng.standard_normal((count, 3)), masses, inertias
    )


def hat(v: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def solved(p: Parts, R: Rotation, w: np.ndarray, x: Given) -> Answer:
    """Motion and joint wrenches, from 6 + 6N equations in as many unknowns: α = Rᵀa, ω̇, f_i, t_i."""
    N = len(p.masses)
    A, b = np.zeros((6 + 6 * N, 6 + 6 * N)), np.zeros(6 + 6 * N)
    g, push = R.inv().apply(G * UP), R.inv().apply(x.push)
    A[:3, :3], A[3:6, 3:6] = p.mass * np.eye(3), p.inertia
    b[:3], b[3:6] = push - p.mass * g, np.cross(x.at, push) - np.cross(w, p.inertia @ w)
    for i in range(N):
        f, t = slice(6 + 6 * i, 9 + 6 * i), slice(9 + 6 * i, 12 + 6 * i)
        A[:3, f], A[3:6, f], A[3:6, t] = -np.eye(3), -hat(p.joints[i]), -np.eye(3)
        d, m, J = p.quadrotors[i], p.masses[i], p.inertias[i]
        A[f, :3], A[f, 3:6], A[f, f] = m * np.eye(3), -m * hat(d), np.eye(3)
        b[f] = x.thrusts[i] * UP + R.inv().apply(x.winds[i]) - m * g - m * np.cross(w, np.cross(w, d))
        A[t, 3:6], A[t, f], A[t, t] = J, hat(p.joints[i] - d), np.eye(3)
        b[t] = x.torques[i] - np.cross(w, J @ w)
    y = np.linalg.solve(A, b)
    joints = y[6:].reshape(N, 2, 3)
    return Answer(R.apply(y[:3]), y[3:6], joints[:, 0], joints[:, 1])


def felt(R: Rotation, answer: Answer) -> PerfectReadings:
    specific = R.inv().apply(answer.linear + G * UP)
    return PerfectReadings(vec3(specific), spread(answer.force), spread(answer.torque), ZERO)


def quat(R: Rotation) -> Quat:
    return Quat(*map(float, R.as_quat(scalar_first=True)))


def unit(R: Rotation, w: np.ndarray, answer: Answer, fresh: float = 1.0) -> ImuReading:
    """The reading of a perfect IMU."""
    f = felt(R, answer)
    return ImuReading(f.specific_force, vec3(w), f.joint_force, f.joint_torque, quat(R), fresh)


def state(p: Parts, R: Rotation, w: np.ndarray, position: np.ndarray, velocity: np.ndarray) -> State:
    """The state of the system's centre of mass from position and velocity of the payload's centre."""
    r = p.centre
    return State(vec3(position + R.apply(r)), vec3(velocity + R.apply(np.cross(w, r))), quat(R), vec3(w))


class Flight(NamedTuple):
    """A flight at every step: numbers of (State, Felt) as rows, attitudes, pushes in world axes (steps × 3)."""

    truth: np.ndarray
    attitudes: Rotation
    pushes: np.ndarray


def flown(p: Parts, duration: float, step: float, push: Any, at: Any, sway: float = 0.0) -> Flight:
    """A flight from hover, held upright by a plain proportional and derivative torque on the quadrotors.

    `push(t)` [N, world] acts at the point `at` of the payload; `sway` [rad] excites the attitude.
    """
    N, R, w = len(p.masses), Rotation.identity(), np.zeros(3)
    x, v, rows, attitudes, pushes = np.zeros(3), np.zeros(3), [], [], []
    for k in range(round(duration / step)):
        t = k * step
        wanted = sway * np.array([np.sin(2.1 * t), np.sin(2.9 * t), np.sin(1.3 * t)])
        torque = np.array([40.0, 1.5, 40.0]) * (wanted - R.as_rotvec()) - np.array([25.0, 0.6, 25.0]) * w
        thrust = (p.mass + p.masses.sum()) * (G - 1.5 * x[2] - 2.0 * v[2]) / N
        loads = Given(np.full(N, thrust), np.tile(torque / N, (N, 1)), push(t), np.array(at), np.zeros((N, 3)))
        answer = solved(p, R, w, loads)
        rows.append(flat((state(p, R, w, x, v), felt(R, answer))))
        attitudes.append(R)
        pushes.append(push(t))
        x = x + v * step + 0.5 * answer.linear * step**2
        v = v + answer.linear * step
        R = R * Rotation.from_rotvec((w + 0.5 * answer.angular * step) * step)
        w = w + answer.angular * step
    return Flight(np.array(rows), Rotation.concatenate(attitudes), np.array(pushes))
