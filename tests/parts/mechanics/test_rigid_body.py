"""The rigid body: closed forms, SciPy's integrator, energy and momentum, and the order of the Runge-Kutta step."""

from __future__ import annotations

import numpy as np
import pytest
from law_values import array, free_body, order_of, random_state, tensor
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Mat3, Quat, Vec3, mat3
from tandemlift.parts.mechanics.push import CentralPush, GaussianPush, PointPush, PushSamples, push_at
from tandemlift.parts.mechanics.rigid_body import (
    RigidBody,
    State,
    Wrench,
    inertia_value,
    motion,
    rk4,
)

STILL = PushSamples(*[CentralPush(ZERO)] * 3)
FREE = Wrench(0.0, ZERO)
FULL = np.array([[0.5, 0.05, -0.1], [0.05, 0.8, 0.07], [-0.1, 0.07, 0.6]])
DIAGONAL = np.diag([0.5, 0.8, 0.6])
PUSH = GaussianPush(Vec3(3.0, -2.0, 1.0), 0.5, 1.0 / 0.2, Vec3(0.1, 0.4, -0.2))
NO_PUSH = PointPush(ZERO, mat3(np.zeros((3, 3))))


def flown(s: State, u: Wrench, body: RigidBody, duration: float, steps: int) -> State:
    for _ in range(steps):
        s = rk4(body, s, motion(body, s, u, STILL.start), u, STILL, duration / steps)
    return s


def numbers_of(s: State) -> np.ndarray:
    return np.concatenate([array(part) for part in s])


def scipy_flight(
    s: State, u: Wrench, body: RigidBody, duration: float, pushes: tuple[GaussianPush, ...] = ()
) -> np.ndarray:
    """The same flight by Newton and Euler in NumPy and DOP853: (13,)."""
    m, J = 1.0 / body.inverse_mass, tensor(body.inertia)

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        v, q, w = y[3:6], y[6:10], y[10:]
        R = Rotation.from_quat(q, scalar_first=True).as_matrix()
        force = R[:, 2] * u.thrust + array(body.force) - array(body.drag_force) * v - [0.0, 0.0, m * GRAVITY]
        moment = array(u.moment) + array(body.moment) - array(body.drag_moment) * w - np.cross(w, J @ w)
        for p in pushes:
            F = array(p.force) * np.exp(-0.5 * ((t - p.time) * p.per_sigma) ** 2)
            force = force + F
            moment = moment + np.cross(array(p.point), R.T @ F)
        turn = np.array([[0, *-w], [w[0], 0, w[2], -w[1]], [w[1], -w[2], 0, w[0]], [w[2], w[1], -w[0], 0]])
        return np.concatenate([v, force / m, 0.5 * turn @ q, np.linalg.solve(J, moment)])

    y = solve_ivp(rate, (0.0, duration), numbers_of(s), method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    y[6:10] /= np.linalg.norm(y[6:10])
    return y


def loaded_body(J: np.ndarray) -> tuple[RigidBody, Wrench]:
    """A body with drag and a constant disturbance, and a wrench on it."""
    body = free_body(2.0, J)._replace(
        drag_force=Vec3(0.1, 0.2, 0.3),
        drag_moment=Vec3(0.05, 0.02, 0.04),
        force=Vec3(0.5, -0.3, 0.2),
        moment=Vec3(0.1, -0.2, 0.05),
    )
    return body, Wrench(22.0, Vec3(0.3, -0.2, 0.1))


@pytest.mark.parametrize("J", [DIAGONAL, FULL], ids=["diagonal", "full"])
def test_a_loaded_body_flies_as_by_newton_and_euler_in_scipy(J):
    body, u = loaded_body(J)
    s = random_state(np.random.default_rng(5), rates=2.0)
    assert numbers_of(flown(s, u, body, 1.0, 1000)) == pytest.approx(scipy_flight(s, u, body, 1.0), abs=1e-10)


def test_inertia_values_are_diagonal_only_if_the_tensor_is():
    assert inertia_value(DIAGONAL) == Vec3(0.5, 0.8, 0.6)
    assert isinstance(inertia_value(FULL), Mat3)
    assert isinstance(inertia_value(DIAGONAL + 1e-15 * FULL), Vec3)


@pytest.mark.parametrize("J", [DIAGONAL, FULL], ids=["diagonal", "full"])
def test_the_runge_kutta_step_is_of_order_four_under_a_continuous_push(J):
    body, u = loaded_body(J)
    s = random_state(np.random.default_rng(5), rates=2.0)
    exact = scipy_flight(s, u, body, 1.0, (PUSH,))
    counts, errors = np.array([16, 32, 64, 128]), []
    for n in counts:
        x, h = s, 1.0 / n
        for k in range(n):
            hand = PushSamples(*[push_at(NO_PUSH, PUSH, (k + part) * h) for part in (0.0, 0.5, 1.0)])
            x = rk4(body, x, motion(body, x, u, hand.start), u, hand, h)
        errors.append(np.abs(numbers_of(x) - exact).max())
    assert order_of(1.0 / counts, errors) == pytest.approx(4.0, abs=0.15)


def test_drag_slows_the_body_at_the_rates_of_its_coefficients():
    """Erratum tables: k_r/J is a rate, so k_r is in N·m·s; the printed N·s would leave metres over."""
    body = free_body(3.5, DIAGONAL)._replace(drag_force=Vec3(0.7, 0.7, 0.7), drag_moment=Vec3(0.2, 0.2, 0.2))
    s = State(ZERO, Vec3(1.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0), Vec3(0.0, 0.0, 2.0))
    after = flown(s, FREE, body, 3.0, 300)
    assert after.rates.z == pytest.approx(2.0 * np.exp(-0.2 / 0.6 * 3.0), rel=1e-9)
    assert after.velocity.x == pytest.approx(np.exp(-0.7 / 3.5 * 3.0), rel=1e-9)
