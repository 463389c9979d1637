"""The closed form of an admittance under a push that lasts, against SciPy's integration of the equation."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.analysis.studies.closed_form import AxisFeel, axes_of, speed_at

SIZE = st.floats(0.1, 10.0)


def integrated(k, time, hold):
    """The speed at times [s] by SciPy."""

    def rates(force):
        return lambda t, s: [s[1], (force - k.damping * s[1] - k.stiffness * s[0]) / k.mass]

    tolerance = {"rtol": 1e-10, "atol": 1e-12, "dense_output": True}
    pushed = solve_ivp(rates(k.beyond), (0.0, hold), [0.0, 0.0], **tolerance)
    free = solve_ivp(rates(0.0), (hold, time[-1]), pushed.y[:, -1], **tolerance)
    return np.where(time < hold, pushed.sol(np.minimum(time, hold))[1], free.sol(np.maximum(time, hold))[1])


def check_against_scipy(k, hold=3.0):
    time = np.linspace(0.0, 2.0 * hold, 400)
    expected = integrated(k, time, hold)
    assert speed_at(k, time, hold) == pytest.approx(expected, rel=1e-6, abs=1e-7 * max(1.0, np.abs(expected).max()))


@given(SIZE, SIZE, SIZE, st.booleans())
def test_without_a_spring_it_is_what_scipy_integrates(mass, damping, push, subtracts_threshold):
    check_against_scipy(AxisFeel("x", mass, damping, 0.0, 0.05, subtracts_threshold, push))


@pytest.mark.parametrize(
    ("damping", "stiffness"),
    [(0.0, 0.0), (0.0, 4.0), (0.5, 4.0), (4.0, 4.0), (9.0, 4.0), (40.0, 4.0), (4.0 * (1.0 + 1e-9), 4.0)],
    ids=["free", "undamped", "oscillating", "critical", "overdamped", "slow", "nearly critical"],
)
def test_with_and_without_spring_and_damping_it_is_what_scipy_integrates(damping, stiffness):
    check_against_scipy(AxisFeel("x", 1.0, damping, stiffness, 0.3, True, 1.5))


@given(SIZE, SIZE, SIZE)
def test_the_numbers_are_those_of_the_curve(mass, damping, push):
    k = AxisFeel("y", mass, damping, 0.0, 0.0, False, push)
    long = 40.0 * k.time_constant
    time = np.linspace(0.0, 2.0 * long, 200_001)
    speed = speed_at(k, time, long)
    assert speed_at(k, np.array([k.time]), long) == pytest.approx(0.95 * k.final_speed)
    assert speed[100_000 - 1] == pytest.approx(k.final_speed)
    assert np.trapezoid(speed[100_000:], time[100_000:]) == pytest.approx(k.stop_distance, rel=1e-4)
    assert speed[1] / time[1] == pytest.approx(k.acceleration, rel=1e-3)
    lag = np.trapezoid(1.0 - speed[:100_000] / k.final_speed, time[:100_000])
    assert lag == pytest.approx(k.time_constant, rel=1e-3)


def test_without_damping_there_is_no_final_speed_and_with_a_spring_it_is_zero():
    free = AxisFeel("x", 1.0, 0.0, 0.0, 0.3, False, 1.0)
    assert (free.final_speed, free.time, free.time_constant) == (math.inf,) * 3
    assert AxisFeel("x", 1.0, 2.0, 5.0, 0.3, False, 1.0).final_speed == 0.0


def test_the_standard_push_is_the_feel_s_force_or_one_newton_and_beyond_the_threshold():
    firm = axes_of(tl.load_mission("iris", {"admittance.feel.preset": "firm"}))
    assert [k.push for k in firm] == [2.0, 2.0, 2.0, 0.5]
    assert [k.axis for k in firm] == ["x", "y", "z", "yaw"]
    assert firm[0].final_speed == pytest.approx(0.6)
    assert firm[3].final_speed == pytest.approx((0.5 - 0.15) / 1.6)
    strict = axes_of(tl.load_mission("one-push", {"admittance.threshold": [0.3, 0.8, 3.0]}))
    assert [k.push for k in strict] == [1.0, 1.6, 6.0]
    assert not any(k.subtracts_threshold for k in strict)
