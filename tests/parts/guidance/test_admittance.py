"""The admittance: gates, the answer to a push, and where it leaves the reference."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from law_values import array, numbers, order_of, vectors
from scipy.integrate import solve_ivp
from scipy.signal import lsim

from tandemlift.core.trajectories import Trajectory
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.guidance.admittance import (
    Admittance,
    AdmittanceState,
    HardGate,
    SoftGate,
    admittance_response,
    admittance_step,
    gate,
)
from tandemlift.parts.mechanics.push import GaussianPush, gaussian_force

MASS, DAMPING, STIFFNESS = Vec3(1.0, 2.0, 0.5), Vec3(1.6, 0.7, 3.0), Vec3(0.0, 4.0, 2.0)
THRESHOLD = Vec3(0.3, 0.1, 0.2)
AT_REST = AdmittanceState(ZERO, ZERO, ZERO)
PUSH = GaussianPush(Vec3(3.0, -2.0, 1.0), 3.0, 1.0 / 0.6, ZERO)


def admittance(stiffness: Vec3 = STIFFNESS, hold_after_release: float = 0.0) -> Admittance:
    inverse = Vec3(*(1.0 / m for m in MASS))
    return Admittance(inverse, DAMPING, stiffness, hold_after_release)


def answered(a: Admittance, force, duration: float, dt: float, kind=HardGate(THRESHOLD)) -> AdmittanceState:  # noqa: B008
    """The memory after a push force(t) [N] has been read every dt."""
    m = AT_REST
    for k in range(round(duration / dt)):
        F = gate(kind, force(k * dt))
        m = admittance_step(a, m, F, admittance_response(a, m, F), dt)
    return m


@given(vectors(1.0))
def test_a_hard_gate_lets_a_force_through_whole_or_not_at_all(F):
    expected = [f if abs(f) > c else 0.0 for f, c in zip(F, THRESHOLD, strict=True)]
    assert list(gate(HardGate(THRESHOLD), F)) == expected


@given(vectors(1.0), vectors(1e-6))
def test_a_soft_gate_is_continuous_and_lets_the_excess_through(F, step):
    expected = [math.copysign(max(abs(f) - c, 0.0), f) for f, c in zip(F, THRESHOLD, strict=True)]
    passed = array(gate(SoftGate(THRESHOLD), F))
    assert passed == pytest.approx(expected, abs=1e-15)
    assert np.abs(array(gate(SoftGate(THRESHOLD), F + step)) - passed).max() <= 1e-6 + 1e-15


@given(vectors(5.0))
def test_a_push_moves_the_reference_with_it(F):
    """Erratum equ4: T_r accelerates along the force; with the printed T_d − T_r it would go the other way."""
    a = admittance()
    motion = admittance_response(a, AT_REST, F)
    assert array(motion.acceleration) * array(MASS) == pytest.approx(array(F), abs=1e-15)
    after = admittance_step(a, AT_REST, F, motion, 0.01)
    assert np.all(array(after.position) * array(F) >= 0.0)
    Td, printed = np.zeros(3), array(F) / array(MASS)
    residual = array(MASS) * (Td - printed) - array(F)  # the printed left side minus the right, with T̈_r = F/M
    assert residual == pytest.approx(-2.0 * array(F), abs=1e-14)


@given(vectors(), vectors(), vectors(), vectors())
def test_mass_damping_and_stiffness_balance_the_force_on_every_axis(position, velocity, anchor, F):
    motion = admittance_response(admittance(), AdmittanceState(position, velocity, anchor), F)
    M, C, K = map(np.diag, (MASS, DAMPING, STIFFNESS))
    left = M @ array(motion.acceleration) + C @ array(velocity) + K @ (array(position) - array(anchor))
    assert left == pytest.approx(array(F), abs=1e-13)


def test_the_sampled_answer_tends_to_the_differential_equations_at_first_order():
    """Per axis, M, C and K differ; SciPy integrates the second-order equation."""

    def rate(t, y):
        F = array(gaussian_force(PUSH, t))
        return np.concatenate([y[3:], (F - array(DAMPING) * y[3:] - array(STIFFNESS) * y[:3]) / array(MASS)])

    exact = solve_ivp(rate, (0.0, 5.0), np.zeros(6), method="DOP853", rtol=1e-12, atol=1e-13, max_step=0.1).y[:3, -1]
    steps, errors = np.array([0.04, 0.02, 0.01, 0.005]), []
    for dt in steps:
        m = answered(admittance(), lambda t: gaussian_force(PUSH, t), 5.0, dt, HardGate(ZERO))
        errors.append(np.abs(array(m.position) - exact).max())
    assert order_of(steps, errors) == pytest.approx(1.0, abs=0.1)
    assert errors[-1] < 0.02


def test_a_free_mass_under_a_steady_push_moves_on_an_exact_parabola():
    """T̈_r is held over a step, so that nothing is lost where it is constant."""
    a = admittance(ZERO)._replace(damping=ZERO)
    m = answered(a, lambda t: Vec3(1.0, -2.0, 3.0), 2.0, 0.02, HardGate(ZERO))
    assert array(m.velocity) == pytest.approx([2.0, -2.0, 12.0], rel=1e-13)
    assert array(m.position) == pytest.approx([2.0, -2.0, 12.0], rel=1e-13)


def test_a_steady_push_is_answered_as_by_a_mass_with_damper_and_spring():
    F = Vec3(1.0, -1.5, 2.0)
    m = answered(admittance(), lambda t: F, 4.0, 0.002)
    t = np.linspace(0.0, 4.0, 4001)
    for axis in range(3):
        system = ([1.0], [MASS[axis], DAMPING[axis], STIFFNESS[axis]])
        _, expected, _ = lsim(system, np.full_like(t, F[axis]), t)
        assert m.position[axis] == pytest.approx(expected[-1], abs=0.002)


def test_reanchoring_keeps_the_reference_where_the_push_left_it():
    """With K > 0: held against the spring and let go, T_r stays, and T_d has moved there."""
    a = admittance(Vec3(1.0, 1.0, 1.0), 1.0)
    held = Vec3(2.0, -1.0, 0.0)
    m = answered(a, lambda t: held if t < 40.0 else ZERO, 60.0, 0.01, HardGate(Vec3(0.3, 0.3, 0.3)))
    assert array(m.position) == pytest.approx([2.0, -1.0, 0.0], abs=0.02)  # F/K
    assert array(m.anchor) == pytest.approx(array(m.position), abs=1e-6)
    assert array(m.velocity) == pytest.approx(np.zeros(3), abs=1e-6)


def test_reanchoring_lets_the_reference_coast_to_the_end_of_its_motion():
    """Let go on the way out, T_r goes on until the spring has stopped it, and is not pulled back."""
    a = admittance(Vec3(1.0, 1.0, 1.0), 1.0)
    m, far, dt = AT_REST, 0.0, 0.01
    for k in range(4000):
        F = gate(HardGate(Vec3(0.3, 0.3, 0.3)), Vec3(5.0, 0.0, 0.0) if k * dt < 0.5 else ZERO)
        m = admittance_step(a, m, F, admittance_response(a, m, F), dt)
        far = max(far, m.position.x)
    assert far > 0.5
    assert m.position.x == pytest.approx(far, abs=0.5 * dt)
    assert m.anchor.x == pytest.approx(m.position.x, abs=1e-6)


@given(numbers(), numbers())
def test_the_anchor_stays_while_a_force_comes_through_or_where_reanchoring_is_off(position, velocity):
    m = AdmittanceState(Vec3(position, 0.0, 0.0), Vec3(velocity, 0.0, 0.0), ZERO)
    now = Trajectory(m.position, m.velocity, ZERO)
    assert admittance_step(admittance(hold_after_release=1.0), m, Vec3(1.0, 1.0, 1.0), now, 0.01).anchor == ZERO
    assert admittance_step(admittance(hold_after_release=0.0), m, ZERO, now, 0.01).anchor == ZERO
