"""One quadrotor, the payload, the joints, and the composite body as the sum of its parts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import array, free_body, quadrotor, random_state, random_vehicle, seeds
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, vec3
from tandemlift.parts.mechanics.parts import (
    Acceleration,
    Joint,
    Point,
    joint_on_payload,
    joint_wrench,
    payload_acceleration,
    point_on_body,
    quadrotor_acceleration,
)
from tandemlift.parts.mechanics.push import CentralPush
from tandemlift.parts.mechanics.rigid_body import State, Wrench, motion
from tandemlift.parts.mechanics.rotation import body_z_axis, rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle, mixer

NO_PUSH = CentralPush(ZERO)
WEIGHT = np.array([0.0, 0.0, GRAVITY])
counts = st.integers(1, 4)  # of quadrotors
ROOT = 0.5**0.5
PLACES = {  # of rotors 1 to 4, in arms
    "+": [(1, 0), (0, 1), (-1, 0), (0, -1)],
    "x": [(ROOT, ROOT), (-ROOT, ROOT), (-ROOT, -ROOT), (ROOT, -ROOT)],
}


@pytest.mark.parametrize("layout", ["+", "x"])
@given(thrusts=st.lists(st.floats(0.0, 10.0), min_size=4, max_size=4))
def test_the_mixer_sums_the_rotors_forces_lever_arms_and_reaction_torques(layout, thrusts):
    q = quadrotor(layout=layout, arm=0.25)
    force, moment = np.zeros(3), np.zeros(3)
    for (x, y), f, spin in zip(PLACES[layout], thrusts, (1.0, -1.0, 1.0, -1.0), strict=True):
        push = np.array([0.0, 0.0, f])
        force += push
        moment += np.cross([q.arm * x, q.arm * y, 0.0], push)
        moment[2] += spin * q.torque_per_thrust * f
    assert mixer(q) @ thrusts == pytest.approx(np.append(force[2], moment), abs=1e-14)


@pytest.mark.parametrize("layout", ["+", "x"])
def test_the_mixer_of_the_paper_has_its_printed_rows(layout):
    A = mixer(quadrotor(layout=layout))
    printed = np.array([[1, 1, 1, 1], [0, 0.25, 0, -0.25], [-0.25, 0, 0.25, 0], [0.06, -0.06, 0.06, -0.06]])
    assert np.allclose(A, printed) == (layout == "+")  # a real IRIS is an "x"


class Assembly:
    """A random vehicle in a random state under random inputs, its acceleration, and all its joints."""

    def __init__(self, seed: int, count: int) -> None:
        rng = np.random.default_rng(seed)
        self.vehicle: Vehicle = random_vehicle(rng, count)
        self.state: State = random_state(rng)
        inputs = rng.standard_normal((count, 4)) * [20.0, 1.0, 1.0, 1.0]
        total = self.vehicle.B @ inputs.ravel()
        body = free_body(self.vehicle.mass, self.vehicle.inertia)
        rate = motion(body, self.state, Wrench(float(total[0]), vec3(total[1:])), NO_PUSH)
        self.angular = rate.rates
        self.R = rotation_from_quaternion(self.state.attitude)
        self.center = Point(self.state.position, self.state.velocity, rate.velocity)
        self.payload = self.at(-self.vehicle.center_of_mass)
        self.places = [self.at(d) for d in self.vehicle.lever_arms]
        z_axis, rates = body_z_axis(self.state.attitude), self.state.rates
        self.quadrotors = [
            (q.mass, vec3(q.inertia), z_axis, float(u[0]), vec3(u[1:]), rates)
            for q, u in zip(self.vehicle.quadrotors, inputs, strict=True)
        ]
        self.joints = [
            joint_wrench(*q, Acceleration(place.acceleration, self.angular))
            for q, place in zip(self.quadrotors, self.places, strict=True)
        ]

    def at(self, d: np.ndarray) -> Point:
        return point_on_body(self.center, self.R, self.state.rates, self.angular, vec3(d))

    def payload_residual(self, moment_of_joint) -> tuple[float, float]:
        """The payload's two equations in NumPy, relative to their largest term."""
        p = self.vehicle.payload
        forces = [array(j.force) for j in self.joints]
        moments = [
            array(j.couple) + moment_of_joint(np.array(q.position), array(j.force))
            for q, j in zip(self.vehicle.quadrotors, self.joints, strict=True)
        ]
        J, w, dw = np.diag(p.moments), array(self.state.rates), array(self.angular)
        linear = p.mass * (array(self.payload.acceleration) + WEIGHT) - sum(forces)
        angular = J @ dw + np.cross(w, J @ w) - sum(moments)
        return (
            float(np.abs(linear).max() / np.abs(forces).max()),
            float(np.abs(angular).max() / np.abs(moments).max()),
        )


@given(counts, seeds)
def test_the_vehicle_is_the_sum_of_its_parts(count, seed):
    """Newton and Euler of every part, with joint forces, give the acceleration of the one composite body."""
    a = Assembly(seed, count)
    R = array(a.R)
    linear, angular = a.payload_residual(lambda d, F: np.cross(d, R.T @ F))
    assert linear < 1e-12
    assert angular < 1e-12


@given(counts, seeds)
def test_the_payload_and_the_quadrotors_accelerate_as_their_joints_demand(count, seed):
    a = Assembly(seed, count)
    on_payload = [
        joint_on_payload(a.R, vec3(q.position), j) for q, j in zip(a.vehicle.quadrotors, a.joints, strict=True)
    ]
    total = Joint(sum((j.force for j in on_payload), ZERO), sum((j.couple for j in on_payload), ZERO))
    p = a.vehicle.payload
    moved = payload_acceleration(p.mass, vec3(p.moments), a.state.rates, total)
    scale = max(map(abs, total.force)) / p.mass, max(map(abs, total.couple)) / min(p.moments)
    assert array(moved.linear) == pytest.approx(array(a.payload.acceleration), abs=1e-12 * scale[0])
    assert array(moved.angular) == pytest.approx(array(a.angular), abs=1e-11 * scale[1])
    for q, place, joint in zip(a.quadrotors, a.places, a.joints, strict=True):
        own = quadrotor_acceleration(*q, joint)
        assert array(own.linear) == pytest.approx(array(place.acceleration), abs=1e-11)
        assert array(own.angular) == pytest.approx(array(a.angular), abs=1e-9)


def test_a_joint_force_in_world_axes_crossed_with_a_body_vector_does_not_balance():
    """Erratum trans_rot_payload_equ: d × F without Rᵀ leaves a moment unbalanced."""
    printed = [Assembly(seed, 2).payload_residual(np.cross)[1] for seed in range(50)]
    assert np.median(printed) == pytest.approx(1.1, abs=0.2)


class Tumble:
    """A free, tumbling asymmetric body, integrated by SciPy, and a point fixed to it."""

    J = np.array([[0.5, 0.05, -0.1], [0.05, 0.8, 0.07], [-0.1, 0.07, 0.6]])
    d = np.array([0.4, 1.0, -0.3])
    h = 0.02

    def __init__(self) -> None:
        rng = np.random.default_rng(7)
        self.start = random_state(rng, rates=2.0)
        times = 1.0 + self.h * np.arange(-2, 3)
        y0 = np.concatenate([array(self.start.attitude), array(self.start.rates)])
        self.y = solve_ivp(self.rate, (0.0, 1.1), y0, method="DOP853", rtol=1e-13, atol=1e-14, t_eval=times).y
        attitudes = Rotation.from_quat(self.y[:4].T, scalar_first=True)
        fall = np.outer(times, array(self.start.velocity)) - np.outer(times**2 / 2.0, WEIGHT)
        self.points = array(self.start.position) + fall + attitudes.apply(self.d)
        q = self.y[:4, 2] / np.linalg.norm(self.y[:4, 2])
        velocity = array(self.start.velocity) - WEIGHT
        self.state = State(ZERO, vec3(velocity), type(self.start.attitude)(*map(float, q)), vec3(self.y[4:, 2]))

    def rate(self, t: float, y: np.ndarray) -> np.ndarray:
        w = y[4:]
        turn = 0.5 * np.array([[0, *-w], [w[0], 0, w[2], -w[1]], [w[1], -w[2], 0, w[0]], [w[2], w[1], -w[0], 0]])
        return np.concatenate([turn @ y[:4], np.linalg.solve(self.J, -np.cross(w, self.J @ w))])

    def found(self, d: np.ndarray) -> Point:
        rate = motion(free_body(1.0, self.J), self.state, Wrench(0.0, ZERO), NO_PUSH)
        center = Point(ZERO, self.state.velocity, rate.velocity)
        R = rotation_from_quaternion(self.state.attitude)
        return point_on_body(center, R, self.state.rates, rate.rates, vec3(d))


def test_points_of_a_tumbling_body_move_as_the_kinematics_say():
    tumble = Tumble()
    found = tumble.found(tumble.d)
    velocity = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) @ tumble.points / (12.0 * tumble.h)
    acceleration = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) @ tumble.points / (12.0 * tumble.h**2)
    assert array(found.velocity) == pytest.approx(velocity, abs=1e-7)
    assert array(found.acceleration) == pytest.approx(acceleration, abs=1e-7)


def test_lever_arms_in_body_axes_must_be_turned_into_world_axes():
    """Erratum kinematic_equ: ω × d without R is a velocity in the wrong axes."""
    tumble = Tumble()
    right = array(tumble.found(tumble.d).velocity) - array(tumble.state.velocity)
    printed = np.cross(array(tumble.state.rates), tumble.d)
    assert np.linalg.norm(printed - right) / np.linalg.norm(right) == pytest.approx(1.934, abs=1e-3)
    assert np.linalg.norm(printed) == pytest.approx(np.linalg.norm(right))
