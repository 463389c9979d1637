"""The controller's equations of motion, line by line, against the motion of the body."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from law_values import array, attitudes, free_body, order_of, random_vec3, seeds, vectors

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Vec3, vec3
from tandemlift.parts.mechanics.equations_of_motion import (
    GeneralizedVector,
    drift,
    euler_dynamics,
    expanded_dynamics,
    response,
)
from tandemlift.parts.mechanics.push import CentralPush
from tandemlift.parts.mechanics.rigid_body import State, Wrench, motion
from tandemlift.parts.mechanics.rotation import euler_from_quaternion, euler_rates_from_rates, quaternion_from_euler

NO_PUSH = CentralPush(ZERO)
INERTIA = (3.227327, 0.061286, 3.277117)
BODY = free_body(3.5, np.diag(INERTIA))._replace(
    drag_force=Vec3(0.1, 0.2, 0.3),
    drag_moment=Vec3(0.04, 0.05, 0.06),
    force=Vec3(0.5, -0.3, 0.2),
    moment=Vec3(0.01, -0.02, 0.03),
)
INPUT = Wrench(36.0, Vec3(0.5, -0.02, 0.3))


def exact(state: State, u: Wrench) -> np.ndarray:
    """Θ̈ by differences of the Euler rates along the body's motion."""
    rate, h = motion(BODY, state, u, NO_PUSH), 1e-5

    def euler_rates(at: State) -> np.ndarray:
        return array(euler_rates_from_rates(euler_from_quaternion(at.attitude), at.rates))

    return (euler_rates(state + rate * h) - euler_rates(state + rate * -h)) / (2.0 * h)


def expanded(state: State, u: Wrench) -> GeneralizedVector:
    e = euler_from_quaternion(state.attitude)
    return euler_dynamics(BODY, e, state.velocity, euler_rates_from_rates(e, state.rates), u)


def tilted(angles: Vec3, rates: Vec3 = ZERO, velocity: Vec3 = ZERO) -> State:
    return State(ZERO, velocity, quaternion_from_euler(angles), rates)


@given(attitudes(), vectors(), vectors())
def test_the_lines_of_position_are_exact_at_any_attitude(angles, velocity, rates):
    state = tilted(angles, rates, velocity)
    expected = motion(BODY, state, INPUT, NO_PUSH).velocity
    assert array(expanded(state, INPUT).position) == pytest.approx(array(expected), abs=1e-12)


@given(vectors(), seeds)
def test_every_line_is_drift_plus_disturbance_plus_response(velocity, seed):
    """Against the six printed lines with the virtual inputs, in NumPy."""
    rng = np.random.default_rng(seed)
    rates, u, m, J = random_vec3(rng), GeneralizedVector(random_vec3(rng), random_vec3(rng)), 3.5, np.array(INERTIA)
    w = array(rates)
    linear = (array(u.position) + array(BODY.force) - array(BODY.drag_force) * array(velocity)) / m
    turning = array(u.attitude) + array(BODY.moment) - array(BODY.drag_moment) * w - np.cross(w, J * w)
    found = expanded_dynamics(BODY, velocity, rates, u)
    assert array(found.position) == pytest.approx(linear - [0.0, 0.0, GRAVITY], abs=1e-13)
    assert array(found.attitude) == pytest.approx(turning / J, abs=1e-11)


def test_an_input_acts_by_one_over_mass_and_inertia_and_nothing_else_does():
    one = response(BODY, GeneralizedVector(Vec3(1.0, 1.0, 1.0), Vec3(1.0, 1.0, 1.0)))
    assert array(one.position) == pytest.approx(np.full(3, 1.0 / 3.5))
    assert array(one.attitude) == pytest.approx(1.0 / np.array(INERTIA))
    still = drift(BODY, ZERO, ZERO)
    assert array(still.position) == pytest.approx([0.0, 0.0, -GRAVITY])
    assert array(still.attitude) == pytest.approx(np.zeros(3))


def test_the_lines_of_attitude_are_exact_at_level_and_err_in_proportion_to_the_tilt():
    """From rest; the error is that of taking the Euler rates for the body rates."""
    assert exact(tilted(ZERO), INPUT) == pytest.approx(array(expanded(tilted(ZERO), INPUT).attitude), abs=1e-9)
    tilts = np.array([0.2, 0.1, 0.05, 0.025])
    errors = []
    for tilt in tilts:
        state = tilted(Vec3(tilt, -tilt, 0.0))
        errors.append(np.abs(exact(state, INPUT) - array(expanded(state, INPUT).attitude)).max())
    assert order_of(tilts, errors) == pytest.approx(1.0, abs=0.05)


def test_the_lines_of_attitude_leave_out_terms_as_large_as_the_gyroscopic_ones():
    """At level: q r, −p r and −p q. In roll the whole is 0.0036 q r where the printed line says −0.9964 q r."""
    p, q, r = 0.3, -0.4, 0.5
    state = tilted(ZERO, Vec3(p, q, r))
    left_out = exact(state, INPUT) - array(expanded(state, INPUT).attitude)
    assert left_out == pytest.approx([q * r, -p * r, -p * q], abs=1e-8)
    free = BODY._replace(drag_moment=ZERO, moment=ZERO)
    printed = drift(free, ZERO, vec3((p, q, r))).attitude.x / (q * r)
    assert printed == pytest.approx(-0.9964, abs=5e-5)
    assert printed + 1.0 == pytest.approx(0.0036, abs=5e-5)


@given(seeds)
def test_the_response_to_an_input_is_that_of_the_whole_inertia(seed):
    """With products of inertia too, by NumPy's solver."""
    chance = np.random.default_rng(seed)
    full = np.diag(INERTIA) + 0.02 * (lambda m: m + m.T)(chance.uniform(-1.0, 1.0, (3, 3)))
    u = GeneralizedVector(random_vec3(chance), random_vec3(chance))
    found = response(free_body(3.5, full), u)
    assert array(found.position) == pytest.approx(array(u.position) / 3.5)
    assert array(found.attitude) == pytest.approx(np.linalg.solve(full, array(u.attitude)))
