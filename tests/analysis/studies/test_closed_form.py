"""The numbers of an admittance under a push that lasts, against SciPy's integration of the equation."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.analysis.studies.closed_form import AxisFeel, axes_of

SIZE = st.floats(0.1, 10.0)


def speed_of(k, hold):
    """Time [s] and speed [m/s] under the push for `hold` seconds and after it, by SciPy."""

    def rates(force):
        return lambda t, s: [s[1], (force - k.damping * s[1] - k.stiffness * s[0]) / k.mass]

    tolerance = {"rtol": 1e-9, "atol": 1e-11, "t_eval": np.linspace(0.0, hold, 20_001)}
    pushed = solve_ivp(rates(k.beyond), (0.0, hold), [0.0, 0.0], **tolerance)
    free = solve_ivp(rates(0.0), (0.0, hold), pushed.y[:, -1], **tolerance)
    return pushed.t, pushed.y[1], free.y


@given(SIZE, SIZE, SIZE, st.booleans())
@settings(max_examples=20)
def test_the_numbers_are_those_of_the_curve(mass, damping, push, subtracts_threshold):
    k = AxisFeel("y", mass, damping, 0.0, 0.05, subtracts_threshold, push)
    time, speed, after = speed_of(k, 30.0 * k.time_constant)
    assert np.interp(k.time, time, speed) == pytest.approx(0.95 * k.final_speed, rel=1e-3)
    assert speed[-1] == pytest.approx(k.final_speed)
    assert after[0, -1] - after[0, 0] == pytest.approx(k.stop_distance, rel=1e-3)
    assert speed[1] / time[1] == pytest.approx(k.acceleration, rel=1e-2)


@pytest.mark.parametrize(("damping", "stiffness"), [(0.5, 4.0), (9.0, 4.0), (40.0, 4.0)])
def test_with_a_spring_the_time_is_that_in_which_the_motion_decays_to_5_percent(damping, stiffness):
    """The largest deviation over half a period, at one time and `k.time` later."""
    k = AxisFeel("x", 1.0, damping, stiffness, 0.3, True, 1.5)
    time, speed, _ = speed_of(k, 3.0 * k.time)
    early, late = (np.abs(speed[(time >= t) & (time < t + 1.6)]).max() for t in (k.time, 2.0 * k.time))
    assert late == pytest.approx(0.05 * early, rel=0.25)


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
