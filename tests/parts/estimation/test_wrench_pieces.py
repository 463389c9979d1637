"""Pieces of the wrench observers: the Kalman-Bucy filter by SciPy, signs and limits of what motion confirms."""

import math

import numpy as np
import pytest
from scipy.linalg import solve_continuous_are

from tandemlift.core.low_pass import LowPass, LowPassState
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.missions import load_mission
from tandemlift.parts.estimation import wrench_push
from tandemlift.parts.estimation.confirmed_part import (
    DRIFT_TIME,
    FALL_TIME,
    NEGLIGIBLE,
    QUIET_TIME,
    RISE_TIME,
    confirmed,
    given_up_slowly,
    joint_drift,
    lately_change,
)
from tandemlift.parts.estimation.wrench.fused import (
    FusedFilter,
    JointPush,
    Monitor,
    largest,
    monitored,
    turning_gains,
    unexplained,
)
from tandemlift.parts.estimation.wrench.start_observer import OBSERVERS
from tandemlift.parts.mechanics.vehicle import Vehicle

AT_ONCE, STILL = LowPass(0.0, 0.0, 0.0, 0.0), LowPassState(ZERO, ZERO)


@pytest.mark.parametrize(("b", "a"), [(5.0, 8.0), (12.0, 3.0), (0.7, 0.4)])
def test_the_gains_of_turning_are_those_of_the_kalman_bucy_filter(b, a):
    """ω̇ = d, d a random walk of 1; ω is measured with 1/b² and d with 1/a, as densities: K = P Cᵀ R⁻¹."""
    A, C, R = np.array([[0.0, 1.0], [0.0, 0.0]]), np.eye(2), np.diag([b**-4.0, a**-2.0])
    P = solve_continuous_are(A.T, C.T, np.diag([0.0, 1.0]), R)
    expected = P @ C.T @ np.linalg.inv(R)
    T = 1e-6
    found = turning_gains(Vec3(b, b, b), Vec3(a, a, a), T)
    rows = [[found.rates, found.rates_by_joints], [found.turning, found.turning_by_joints]]
    for i in range(2):
        for j in range(2):
            assert np.array(rows[i][j]) / T == pytest.approx([expected[i, j]] * 3, rel=1e-4)


def test_gains_of_a_slow_sample_are_of_one_interval_at_most():
    """Frequencies are at most one over the interval; the share of an innovation that is taken is below 1."""
    T = 0.01
    found = turning_gains(Vec3(1e4, 1e4, 1e4), ZERO + Vec3(1.0, 1.0, 1.0), T)
    at_most = turning_gains(Vec3(1.0 / T, 1.0 / T, 1.0 / T), Vec3(1.0, 1.0, 1.0), T)
    assert tuple(found.rates) == pytest.approx(tuple(at_most.rates))
    assert 0.0 < found.rates.x < 1.0


# joints and motion


def test_what_the_motion_does_not_show_counts_in_either_direction_over_its_tolerance():
    for sign in (1.0, -1.0):
        e = Vec3(sign * 0.2, sign * 0.6, sign * 0.1)
        assert unexplained(e, ZERO, Vec3(1.0, 2.0, 1.0)) == pytest.approx(0.3)
        assert unexplained(e, Vec3(0.0, 1.0, 0.0), Vec3(1.0, 2.0, 1.0)) == pytest.approx(0.2)
    assert largest(Vec3(1.0, 3.0, 2.0)) == largest(Vec3(3.0, 1.0, 2.0)) == largest(Vec3(1.0, 2.0, 3.0)) == 3.0


def pushed(*, tare=0.0):
    return JointPush(ZERO, ZERO, ZERO, ZERO, tare, 1.0, 1.0, 1.0)


def compared(whole, joints, zero, joint_zero, *, tare=0.0, wrong=0.0, dt=0.01):
    """A comparison whose low-passes follow at once, beside a wrench that was the same before."""
    lowest = dict.fromkeys(FusedFilter._fields)
    k = FusedFilter(**{**lowest, "quick": AT_ONCE, "slow": AT_ONCE})
    m = Monitor(zero, joint_zero, STILL, STILL, STILL)
    one = Vec3(1.0, 1.0, 1.0)
    return monitored(k, m, one * whole, one * joints, pushed(tare=tare), one * 0.5, wrong, dt)[0]


@pytest.mark.parametrize("wrong", [0.0, 1.0])
def test_the_difference_is_of_what_both_show_beyond_their_zeros_and_the_joints_zero_follows_it(wrong):
    """F_o − z − (F_j − j) = 2 − 0.3 − (1.2 − 0.4) = 0.9, which a wrench that stays does not show."""
    one = Vec3(1.0, 1.0, 1.0)
    after = compared(2.0, 1.2, one * 0.3, one * 0.4, wrong=wrong)
    assert after.difference.value.y == pytest.approx(0.9)
    assert after.zero.y == pytest.approx(0.3)
    assert after.joint_zero.y == pytest.approx(0.4 - 0.9 * 0.01 / (2.0 if wrong else 5.0))
    right = compared(2.0, 1.2 + 0.9, one * 0.3, one * 0.4)
    assert right.difference.value.x == pytest.approx(0.0, abs=1e-12)


def test_in_the_tare_the_zero_is_the_mean_of_what_motion_shows():
    after = compared(2.0, 1.2, ZERO, ZERO, tare=0.25)
    assert after.zero.z == pytest.approx(0.5)


# what is confirmed


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_push_that_is_all_of_the_wind_leaves_a_tolerance(sign):
    """F̂ = ρ r with ρ = 0.5: wind alone explains it. Less than 0.4 of it takes nothing away."""
    assert confirmed(sign * 1.0, sign * 2.0, 0.0, 0.2, 0.5) == pytest.approx(sign * 0.2)
    assert confirmed(sign * 1.0, sign * 0.7, 0.0, 0.2, 0.5) == pytest.approx(sign * 1.0)
    assert confirmed(sign * 1.0, 0.0, 0.0, 0.2, 0.5) == pytest.approx(sign * 1.0)
    assert confirmed(sign * 1.0, -sign * 1.0, 0.0, 0.2, 0.5) == pytest.approx(sign * 0.2)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_joints_that_drift_move_the_offset_towards_the_push_and_rest_away_from_it(sign):
    """The common part c of F̂ and −r, c²/(c + a tenth of the tolerance), in a second without a push."""
    common, dt = 0.1, 0.01
    size = common**2 / (common + NEGLIGIBLE * 0.2)
    assert joint_drift(sign * 0.15, -sign * common, 0.2, dt) == pytest.approx(sign * size * dt / QUIET_TIME)
    assert joint_drift(sign * 0.5, -sign * common, 0.2, dt) == pytest.approx(sign * size * dt / DRIFT_TIME)
    assert joint_drift(sign * 0.15, sign * common, 0.2, dt) == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("size", [0.01, 1.0])
def test_a_push_that_was_confirmed_stays_however_small_it_is(sign, size):
    assert given_up_slowly(sign * 0.5 * size, sign * 0.1 * size, sign * 0.4 * size) == pytest.approx(sign * 0.4 * size)
    assert given_up_slowly(sign * 0.5 * size, sign * 0.1 * size, -sign * 0.4 * size) == pytest.approx(sign * 0.1 * size)


@pytest.mark.parametrize(
    ("left", "lately", "time"), [(0.8, 0.2, RISE_TIME), (0.2, 0.8, FALL_TIME), (-0.3, 0.2, FALL_TIME)]
)
def test_the_confirmed_push_rises_and_falls_in_its_times(left, lately, time):
    for sign in (1.0, -1.0):
        change = lately_change(sign * left, sign * lately, 0.01)
        assert change == pytest.approx(sign * (left - lately) * 0.01 / time)


def test_an_observer_is_told_the_noise_of_a_sample_at_its_interval(monkeypatch):
    """White noise of a sensor that is read four times as often is twice as large in each sample."""
    seen = []
    held = OBSERVERS["hybrid"]._replace(start=lambda *given: seen.append(given[2]) or (None, None))
    monkeypatch.setitem(OBSERVERS, "hybrid", held)
    mission = load_mission("iris", {"sensors.noise_interval": 0.004, "estimator.wrench": "hybrid"})
    vehicle = Vehicle.from_settings(mission.vehicle)
    wrench_push.start_wrench_push(mission.estimator, mission.sensors, vehicle, 0.001, 0.01, None)
    (noise,) = seen
    numbers = dict(zip(("accelerometer", "gyroscope"), noise[:2], strict=True))
    for name, value in numbers.items():
        assert value == pytest.approx(2.0 * getattr(mission.sensors, name).noise)
    assert math.isfinite(sum(np.ravel(np.array(noise[2], float))))
