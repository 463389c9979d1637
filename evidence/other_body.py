"""Logs of vehicles that no code of the package simulates: rigid bodies under SciPy's adaptive integrator.

All vehicles of a batch have as many quadrotors. Each flies itself: a proportional-derivative pilot hovers at 2 m with
sines in thrust and moments, and commands rotor speeds every 4 ms, which take effect after the vehicle's delay. A
rotor's speed then follows with its own lag up or down, in closed form. `solve_ivp` (RK45, rtol 1e-6, atol 1e-8)
integrates the bodies from one command to the next. Sensors read at the instant of their stamp: the accelerometer at the
payload's origin, joints by Newton's and Euler's laws of each quadrotor alone, each with noise and a bias.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.analysis.logs.log import Log, Stream
from tandemlift.missions import Mission

GRAVITY = 9.81
PERIOD, FINE = 0.004, 0.001  # s, of commands and of samples
NOISE = {  # standard deviations of a sample, and of the bias
    "measured_specific_force": (0.03, 0.05),
    "measured_rates": (0.0025, 0.01),
    "measured_position": (0.003, 0.0),
    "measured_velocity": (0.01, 0.0),
    "measured_attitude": (0.001, 0.0),
    "measured_joint_force": (0.05, 0.3),
    "measured_joint_torque": (0.005, 0.03),
}
MOTION = ("measured_position", "measured_velocity", "measured_attitude")


class Vehicles(NamedTuple):
    """Numbers of V vehicles with N quadrotors: arrays whose first axis is the vehicle; SI units, body axes.

    `r`: quadrotors' centres from the payload's origin, `c`: the payload's centre of mass, `d`: joints from quadrotors'
    centres, `xy`: rotors from these, `up`, `down`: lags, `J`, `Jq`: inertias.
    """

    mass: np.ndarray
    c: np.ndarray
    J: np.ndarray
    mq: np.ndarray
    Jq: np.ndarray
    r: np.ndarray
    d: np.ndarray
    xy: np.ndarray
    spin: np.ndarray
    k: np.ndarray
    kappa: np.ndarray
    up: np.ndarray
    down: np.ndarray
    delay: np.ndarray


def vehicles_of(missions: list[Mission]) -> Vehicles:
    """The numbers of missions' vehicles."""
    tables = [m.vehicle for m in missions]

    def each(form: Any) -> np.ndarray:
        return np.array([[form(q) for q in t.quadrotors] for t in tables], float)

    return Vehicles(
        mass=np.array([t.payload.mass for t in tables]),
        c=np.array([t.payload.center_of_mass for t in tables], float),
        J=np.array([np.array(t.payload.tensor) for t in tables]),
        mq=each(lambda q: q.mass),
        Jq=each(lambda q: np.diag(q.inertia)),
        r=each(lambda q: q.position),
        d=each(lambda q: np.subtract(q.joint_position, q.position)),
        xy=each(lambda q: q.rotors),
        spin=each(lambda q: q.spins),
        k=each(lambda q: q.thrust_constant),
        kappa=each(lambda q: q.torque_per_thrust),
        up=each(lambda q: q.lag_up),
        down=each(lambda q: q.lag_down),
        delay=np.array([m.actuators.delay for m in missions]),
    )


class Whole(NamedTuple):
    """Mass, centre of mass from the payload's origin, inertia about it, and effect of rotors on thrust and moments."""

    mass: np.ndarray
    center: np.ndarray
    J: np.ndarray
    effect: np.ndarray


def whole_of(v: Vehicles) -> Whole:
    """The whole of each vehicle, by the parallel-axis theorem."""
    mass = v.mass + v.mq.sum(1)
    center = (v.mass[:, None] * v.c + np.einsum("vn,vni->vi", v.mq, v.r)) / mass[:, None]

    def about(m: np.ndarray, s: np.ndarray) -> np.ndarray:
        return m[..., None, None] * (np.sum(s * s, -1)[..., None, None] * np.eye(3) - s[..., :, None] * s[..., None, :])

    J = v.J + about(v.mass, v.c - center) + (v.Jq + about(v.mq, v.r - center[:, None])).sum(1)
    place = v.r[:, :, None, :2] + v.xy - center[:, None, None, :2]
    V = len(mass)
    rows = [np.ones((V, 4 * v.mq.shape[1])), place[..., 1].reshape(V, -1), -place[..., 0].reshape(V, -1)]
    rows.append((v.spin * v.kappa[..., None]).reshape(V, -1))
    return Whole(mass, center, J, np.stack(rows, 1))


def rotations(q: np.ndarray) -> np.ndarray:
    """R (…, 3, 3), body to world, of quaternions w, x, y, z."""
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def moved(u: np.ndarray, J: np.ndarray, mass: np.ndarray, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(Acceleration less gravity, body axes; angular acceleration) under thrust and moments u (V, 4)."""
    w = s[:, 10:]
    alpha = np.linalg.solve(J, (u[:, 1:] - np.cross(w, np.einsum("vij,vj->vi", J, w)))[..., None])[..., 0]
    force = np.zeros((len(s), 3))
    force[:, 2] = u[:, 0] / mass
    return force, alpha


def flown(missions: list[Mission], seconds: float, seed: int, push: bool = False) -> list[dict[str, np.ndarray]]:
    """Perfect readings every millisecond, and the commands every 4 ms, of vehicles that fly themselves."""
    v, V = vehicles_of(missions), len(missions)
    whole, chance = whole_of(v), np.random.default_rng(seed)
    inverse = np.linalg.pinv(whole.effect)
    k, up, down = (np.repeat(x, 4, 1) for x in (v.k, v.up, v.down))
    frequencies = np.array([0.35, 0.6, 1.0, 1.7, 2.9, 4.9, 8.0])
    phases = chance.uniform(0.0, 2.0 * np.pi, (V, 4, len(frequencies)))
    sizes = np.stack(
        [
            0.12 * whole.mass,
            0.1 * np.trace(whole.J, axis1=1, axis2=2),
            0.15 * whole.J[:, 1, 1],
            0.03 * whole.J[:, 2, 2],
        ],
        1,
    )
    sizes[:, 1] = 0.2 * whole.J[:, 0, 0]
    s = np.zeros((V, 13))
    s[:, 2], s[:, 6] = 2.0, 1.0
    hover = np.sqrt(np.maximum(inverse[:, :, 0] * (whole.mass * GRAVITY)[:, None], 1e-3) / k)
    omega, current = hover.copy(), hover.copy()
    queue = [(-np.ones(V), hover)]

    def relaxed(x: np.ndarray, to: np.ndarray, time: np.ndarray) -> np.ndarray:
        return to + (x - to) * np.exp(-np.maximum(time, 0.0)[:, None] / np.where(to > x, up, down))

    out: dict[str, list[np.ndarray]] = {name: [] for name in ("s", "u", "thrust")}
    times, commands = [], []
    steps = round(seconds / PERIOD)
    for step in range(steps):
        t = step * PERIOD
        R, w = rotations(s[:, 6:10]), s[:, 10:]
        error, speed = s[:, :3] - [0.0, 0.0, 2.0], s[:, 3:6]
        wanted = -1.5 * error - 2.0 * speed
        tilt = np.stack([wanted[:, 0], wanted[:, 1]], 1) / GRAVITY
        tilt = np.clip(tilt, -0.25, 0.25)
        yaw = np.arctan2(R[:, 1, 0], R[:, 0, 0])
        roll, pitch = np.arctan2(R[:, 2, 1], R[:, 2, 2]), -np.arcsin(np.clip(R[:, 2, 0], -1, 1))
        ahead, left = (
            tilt[:, 0] * np.cos(yaw) + tilt[:, 1] * np.sin(yaw),
            tilt[:, 1] * np.cos(yaw) - tilt[:, 0] * np.sin(yaw),
        )
        angle = np.stack([roll + left, pitch - ahead, yaw], 1)
        alpha = -np.array([36.0, 36.0, 6.0]) * angle - np.array([9.0, 9.0, 4.0]) * w
        wave = np.sum(np.sin(2.0 * np.pi * frequencies * t + phases), -1) * min(1.0, t / 2.0)
        u = np.zeros((V, 4))
        u[:, 0] = whole.mass * (GRAVITY + wanted[:, 2]) / np.maximum(R[:, 2, 2], 0.5)
        u[:, 1:] = np.einsum("vij,vj->vi", whole.J, alpha)
        u += wave * sizes
        command = np.sqrt(np.clip(np.einsum("vri,vi->vr", inverse, u), 0.3, None) / k)
        times.append(t)
        commands.append(command)
        queue.append((t + v.delay, command))
        # the command of each vehicle that takes effect within this period, and when
        switch, after = np.full(V, np.inf), current.copy()
        for begins, held in queue:
            due = (begins < t + PERIOD - 1e-12) & (begins >= t - 1e-12)
            switch[due], after[due] = begins[due], held[due]
        before, begin = current.copy(), omega.copy()

        def speeds(at: float, before=before, begin=begin, after=after, switch=switch, t=t) -> np.ndarray:
            first = relaxed(begin, before, np.minimum(at, switch) - t)
            return np.where(
                (at > switch)[:, None], relaxed(first, after, np.where(np.isfinite(switch), at - switch, 0.0)), first
            )

        def thrusts(at: float) -> np.ndarray:
            return k * speeds(at) ** 2

        def motion(at: float, x: np.ndarray) -> np.ndarray:
            x = x.reshape(V, 13)
            q, rates = x[:, 6:10], x[:, 10:]
            force, turning = moved(np.einsum("vir,vr->vi", whole.effect, thrusts(at)), whole.J, whole.mass, x)
            spin = 0.5 * np.concatenate(
                [-np.sum(q[:, 1:] * rates, 1, keepdims=True), q[:, :1] * rates + np.cross(q[:, 1:], rates)], 1
            )
            pull = np.einsum("vij,vj->vi", rotations(q), force) - [0.0, 0.0, GRAVITY]
            return np.concatenate([x[:, 3:6], pull, spin, turning], 1).ravel()

        grid = t + FINE * np.arange(round(PERIOD / FINE) + 1)
        solved = solve_ivp(motion, (grid[0], grid[-1]), s.ravel(), "RK45", t_eval=grid, rtol=1e-6, atol=1e-8)
        every = solved.y.T.reshape(len(grid), V, 13)
        for at, x in zip(grid[:-1], every[:-1], strict=True):
            out["s"].append(x)
            out["thrust"].append(thrusts(at))
        s, omega = every[-1].copy(), speeds(grid[-1])
        s[:, 6:10] /= np.linalg.norm(s[:, 6:10], axis=1, keepdims=True)
        current = np.where(np.isfinite(switch)[:, None], after, current)
        queue = queue[-40:]
    return [
        {
            "time": FINE * np.arange(len(out["s"])),
            **_read(v, whole, i, np.array([x[i] for x in out["s"]]), np.array([x[i] for x in out["thrust"]])),
            "command_time": np.array(times),
            "commands": np.array([c[i] for c in commands]),
        }
        for i in range(V)
    ]


def _read(v: Vehicles, whole: Whole, i: int, s: np.ndarray, thrust: np.ndarray) -> dict[str, np.ndarray]:
    """Perfect readings of vehicle i in states s (T, 13) under thrusts (T, 4 N)."""
    T, N = len(s), v.mq.shape[1]
    w = s[:, 10:]
    force, alpha = moved(thrust @ whole.effect[i].T, np.tile(whole.J[i], (T, 1, 1)), whole.mass[i], s)

    def felt(place: np.ndarray) -> np.ndarray:
        return force + np.cross(alpha, place) + np.cross(w, np.cross(w, place))

    own, forces, torques = thrust.reshape(T, N, 4), [], []
    for n in range(N):
        F = -v.mq[i, n] * felt(v.r[i, n] - whole.center[i])
        F[:, 2] += own[:, n].sum(1)
        J = v.Jq[i, n]
        tau = np.stack(
            [own[:, n] @ v.xy[i, n, :, 1], -own[:, n] @ v.xy[i, n, :, 0], own[:, n] @ v.spin[i, n] * v.kappa[i, n]], 1
        )
        forces.append(F)
        torques.append(tau - alpha @ J.T - np.cross(w, w @ J.T) - np.cross(v.d[i, n], F))
    R = rotations(s[:, 6:10])
    center = whole.center[i]
    return {
        "measured_specific_force": felt(-center),
        "measured_rates": w,
        "measured_position": s[:, :3],
        "measured_velocity": s[:, 3:6],
        "measured_attitude": s[:, 6:10],
        "measured_joint_force": np.hstack(forces),
        "measured_joint_torque": np.hstack(torques),
        "rotation": R,
    }


def log_of(
    flight: dict[str, np.ndarray], rate: float, seed: int, name: str = "other body", motion: float = 0.005
) -> Log:
    """The log of a flight: IMU and joints at a rate [Hz], motion capture every 5 ms, noise and biases of a seed."""
    chance, streams = np.random.default_rng(seed), dict[str, Stream]()
    for stream, (noise, bias) in NOISE.items():
        every = round((motion if stream in MOTION else 1.0 / rate) / FINE)
        values = flight[stream][::every].copy()
        if stream == "measured_attitude":
            turn = chance.normal(0.0, 0.5 * noise, (len(values), 3))
            w, r = values[:, :1], values[:, 1:]
            values = np.hstack([w - np.sum(r * turn, 1, keepdims=True), r + w * turn + np.cross(r, turn)])
            values /= np.linalg.norm(values, axis=1, keepdims=True)
        else:
            values += chance.normal(0.0, noise, values.shape) + chance.normal(0.0, bias, values.shape[1])
        streams[stream] = Stream(flight["time"][::every], values)
    streams["rotor_speed_commands"] = Stream(flight["command_time"], flight["commands"])
    return Log(streams, name, stamp_offset=0.0)


def drawn(seed: int, count: int = 2, unlike: float = 0.1) -> dict[str, Any]:
    """Changes of mission iris: a vehicle of some quadrotors that are unlike each other, drawn from a seed."""
    chance, start = np.random.default_rng(seed), tl.load_mission("iris")
    base, payload = start.vehicle.quadrotors[0].model_dump(exclude_none=True), start.vehicle.payload
    places = {
        1: [[0.0, 0.0]],
        2: [[0.0, 1.0], [0.0, -1.0]],
        3: [[1.0, 0.0], [-0.6, 0.9], [-0.6, -0.9]],
        4: [[0.9, 0.9], [-0.9, 0.9], [-0.9, -0.9], [0.9, -0.9]],
    }[count]
    common = {
        name: 1.0 + 0.15 * chance.uniform(-1.0, 1.0)
        for name in ("mass", "inertia", "thrust_constant", "torque_per_thrust", "lag_up", "lag_down")
    }
    quadrotors = []
    for x, y in places:
        own = dict(base)
        for name, factor in common.items():
            f = factor * (1.0 + unlike * chance.uniform(-1.0, 1.0))
            own[name] = [float(J * f) for J in own[name]] if name == "inertia" else float(own[name] * f)
        own.pop("max_thrust", None)
        own["position"] = [x, y, 0.075]
        quadrotors.append(own)
    factor = 1.0 + 0.2 * chance.uniform(-1.0, 1.0)
    return {
        "vehicle.quadrotors": quadrotors,
        "vehicle.payload.mass": payload.mass * factor,
        "vehicle.payload.inertia": [float(J * factor) for J in payload.moments],
        "vehicle.payload.center_of_mass": (chance.uniform(-1.0, 1.0, 3) * [0.02, 0.06, 0.01]).tolist(),
        "actuators.delay": float(0.01 * (1.0 + 0.3 * chance.uniform(-1.0, 1.0))),
        "vehicle.drag.force": 0.0,
        "vehicle.drag.moment": 0.0,
        "pushes": [],
    }
