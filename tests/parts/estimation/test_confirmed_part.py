"""What is learned while nobody pushes, and what is kept of a push: the mean square, the zero, and the recent push."""

import numpy as np
import pytest

from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.estimation.confirmed_part import (
    GUST_TIME,
    RELEARN_TIME,
    Zero,
    compared,
    given_up_slowly,
    square_change,
)
from tandemlift.parts.estimation.navigation import NavigationState, Navigator, innovation
from tandemlift.parts.estimation.push_confirmation import withheld
from tandemlift.parts.estimation.push_estimate import PushEstimate
from tandemlift.parts.mechanics.low_pass import LowPass, LowPassState
from tandemlift.parts.sensors.readings import ImuReading, MotionReading

DT = 0.01
AT_ONCE = LowPass(0.0, 0.0, 0.0, 0.0)


def test_the_mean_square_of_a_load_without_a_push_follows_it_within_its_time_and_a_push_leaves_it():
    square, end = 0.0, 3.0 * GUST_TIME
    for _ in range(round(end / DT)):
        square += square_change(0.0, 0.3, square, 0.2, DT)
    assert square == pytest.approx(0.09 * (1.0 - np.exp(-end / GUST_TIME)), rel=0.01)
    assert square_change(0.5, 0.3, square, 0.2, DT) == 0.0


def learned(push, rest, seconds):
    """The zero after a constant push and load beside it, from nothing known; [(push, withheld)] of each sample."""
    zero, seen = Zero(0.0, 0.0, LowPassState(0.0, 0.0), 0.0, 0.0), []
    for _ in range(round(seconds / DT)):
        found = compared(AT_ONCE, zero, push, rest, 0.2, 0.0, 0.0, DT)
        zero = found.zero
        seen.append(found.withheld)
    return zero, seen


def test_a_joint_that_is_wrong_becomes_the_new_zero_within_seconds():
    """A push of 2 N that the quadrotors contradict: the offset goes to it, but for the tolerance that is left."""
    zero, seen = learned(2.0, -2.0, 6.0 * RELEARN_TIME)
    assert seen[0] == pytest.approx(1.8)
    assert zero.offset == pytest.approx(2.0, abs=0.2)
    assert learned(2.0, -2.0, RELEARN_TIME)[0].offset == pytest.approx(1.8 * (1.0 - np.exp(-1.0)), abs=0.15)


def test_the_mean_square_grows_with_the_load_beside_a_push_of_nothing():
    low_pass, zero = AT_ONCE, Zero(0.0, 0.0, LowPassState(0.0, 0.0), 0.01, 0.0)
    found = compared(low_pass, zero, 0.0, 0.5, 0.2, 0.0, 0.0, DT)
    assert found.zero.square == pytest.approx(0.01 + (min(0.25, 0.09 + 0.04) - 0.01) * DT / GUST_TIME)


@pytest.mark.parametrize(
    ("push", "left", "lately", "kept"),
    [(2.0, 0.2, 1.5, 1.5), (-2.0, -0.2, -1.5, -1.5), (2.0, 0.2, -1.5, 0.2), (1.0, 0.2, 1.5, 1.0), (2.0, 1.9, 1.5, 1.9)],
)
def test_of_a_push_there_stays_what_was_confirmed_lately_in_its_direction(push, left, lately, kept):
    assert given_up_slowly(push, left, lately) == pytest.approx(kept)


@pytest.mark.parametrize(("trusted", "armed"), [(1.0, 0.0), (0.0, 1.0)])
def test_a_push_before_the_tare_or_of_joints_that_disagree_is_not_used(trusted, armed):
    force = Vec3(1.0, 2.0, 3.0)
    push = PushEstimate(*[force] * 4, 0.0, 1.0, 0.0, trusted, armed, force)
    imu = ImuReading(*[None] * len(ImuReading._fields))._replace(frame=Quat(1.0, 0.0, 0.0, 0.0))
    rest = withheld(push, imu, ZERO, 0.0, 1.0, 0.0)
    assert rest.usable == ZERO
    assert rest.force == push.force


def test_a_motion_sample_of_the_past_has_no_innovation_where_the_estimate_passed():
    """A constant acceleration and turning about z: the sample is of `age` before, by the kinematics of each."""
    age, p, v, a, w = 0.08, np.array([1.0, 2.0, 3.0]), np.array([0.5, -0.4, 0.3]), np.array([2.0, 1.0, -3.0]), 0.7
    k = Navigator(**dict.fromkeys(Navigator._fields, 0.0))._replace(centre=ZERO, age=age)
    nothing = dict.fromkeys(NavigationState._fields, ZERO)
    m = NavigationState(
        **nothing
        | {"position": Vec3(*p), "velocity": Vec3(*v), "acceleration": Vec3(*a), "rates": Vec3(0.0, 0.0, w)}
        | {"attitude": Quat(1.0, 0.0, 0.0, 0.0), "started": 1.0}
    )
    turned = Quat(np.cos(0.5 * w * age), 0.0, 0.0, -np.sin(0.5 * w * age))
    then = MotionReading(*[None] * len(MotionReading._fields))._replace(
        position=Vec3(*(p - v * age + 0.5 * a * age**2)), velocity=Vec3(*(v - a * age)), attitude=turned
    )
    off = innovation(k, m, then)
    assert np.concatenate(off) == pytest.approx(np.zeros(9), abs=1e-4)
