"""The push that is used: its tare against least squares, what the motion confirms of it, and what is taken from it."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.low_pass import LowPass, LowPassState
from tandemlift.core.vector import ZERO, Quat, Vec3, each, vec3
from tandemlift.parts.estimation.confirmed_part import (
    GUST_TIME,
    RELEARN_TIME,
    Zero,
    compared,
    given_up_slowly,
    square_change,
)
from tandemlift.parts.estimation.navigation import NavigationState, Navigator, innovation
from tandemlift.parts.estimation.push_confirmation import outside_load, rotor_model, start_confirmation, withheld
from tandemlift.parts.estimation.push_estimate import PushEstimate
from tandemlift.parts.estimation.tare import SideForces, TareSums, summed, tare_of
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
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


def test_thresholds_of_zero_withhold_nothing_of_a_push_that_the_motion_confirms():
    mission, no = tl.load_mission("iris"), (0.0, 0.0, 0.0)
    vehicle = Vehicle.from_settings(mission.vehicle)
    k, memory = start_confirmation(mission.estimator, vehicle, DT, threshold=no, moment_threshold=0.0, limited=True)
    for push in (0.0, 1.0):
        one = compared(k.low_pass, memory.force_zero, Vec3(push, 0.0, 0.0), ZERO, k.tolerance, k.ratio, 0.0, DT)
        assert one.withheld == ZERO
    assert compared(k.low_pass, memory.turning_zero, 0.0, 0.0, k.moment_tolerance, 0.0, 0.0, DT).withheld == 0.0


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


STEP = 1e-3
VEHICLE = Vehicle.from_settings(tl.load_mission("iris").vehicle)


def test_rotors_at_their_speed_leave_the_load_that_is_not_theirs():
    """Force and moment about z beside those of the thrusts by the mixer matrix, whatever the thrusts are."""
    rotors, at_rest = rotor_model(VEHICLE, STEP)
    thrusts = np.random.default_rng(4).uniform(1.0, 5.0, VEHICLE.rotor_count)
    constants = np.array([q.thrust_constant for q in VEHICLE.quadrotors for _ in range(4)])
    speeds, commands = type(at_rest)(*np.sqrt(thrusts / constants)), type(at_rest)(*thrusts)
    lift, _, _, yaw = VEHICLE.effect @ thrusts
    force, moment, after = outside_load(rotors, speeds, commands, Vec3(0.3, -0.2, lift + 0.5), yaw + 0.07)
    assert np.array(force) == pytest.approx([0.3, -0.2, 0.5], abs=1e-12)
    assert moment == pytest.approx(0.07, abs=1e-12)
    assert abs(yaw) > 0.05  # so that its sign counts
    assert np.array(after) == pytest.approx(np.array(speeds))


@pytest.mark.parametrize(("applies", "left"), [(1.0, 1.0), (0.0, 0.0)])
def test_what_is_not_confirmed_is_taken_from_force_and_moment_unless_a_contact_explains_it(applies, left):
    frame = Quat(np.cos(0.4), 0.0, 0.0, np.sin(0.4))
    imu = ImuReading(*[None] * len(ImuReading._fields))._replace(frame=frame)
    force, moment = Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3)
    push = PushEstimate(force, moment, force, moment, 0.0, 1.0, 0.0, 1.0, 1.0, force)
    rest = withheld(push, imu, Vec3(0.5, -0.4, 0.3), 0.08, applies, 1.0)
    less = left * np.array(rotation_from_quaternion(frame)) @ [0.5, -0.4, 0.3]
    for found in (rest.force, rest.measured, rest.usable):
        assert np.array(found) == pytest.approx(np.array(force) - less)
    for found in (rest.moment, rest.measured_moment):
        assert found == pytest.approx((0.1, 0.2, 0.3 - left * 0.08))
    assert np.array(rest.withheld) == pytest.approx(less)
    assert rest.refuted == left
    for doubtful in (push._replace(trusted=0.0), push._replace(armed=0.0)):
        unused = withheld(doubtful, imu, ZERO, 0.0, applies, 0.0)
        assert (unused.usable, unused.force) == (ZERO, force)


PAIR = each(2)
NONE = TareSums(0.0, ZERO, ZERO, ZERO, 0.0, 0.0, SideForces(PAIR(0.0, 0.0), PAIR(0.0, 0.0)))
RNG = np.random.default_rng(0)
COUNT, MASS = 50, 1.3
SPECIFIC = [0.1, -0.2, 9.8] + 0.05 * RNG.normal(size=(COUNT, 3))
FORCE = MASS * SPECIFIC + [0.3, 0.2, 0.0] + 0.1 * RNG.normal(size=(COUNT, 3))
MOMENT, SIDES = RNG.normal(size=(COUNT, 3)), RNG.normal(size=(COUNT, 2, 2))


def tared(identify=1.0, armed=1.0, first=0, until=COUNT):
    """The tare over samples; those before the first count before it has begun, those from `until` on are not taken."""
    sums = NONE
    for k, (f, a, moment, (x, y)) in enumerate(zip(FORCE, SPECIFIC, MOMENT, SIDES, strict=True)):
        begun, taken = float(k >= first), float(first <= k < until)
        sides = SideForces(PAIR(*x.tolist()), PAIR(*y.tolist()))
        sums = summed(sums, begun, taken, vec3(f), vec3(a), vec3(moment), sides)
    return tare_of(2.0, identify, sums, armed)


@pytest.mark.parametrize(("first", "until"), [(0, COUNT), (10, COUNT), (10, 40)])
def test_it_is_the_least_squares_mass_and_the_mean_of_what_is_left(first, until):
    part = slice(first, until)
    (mass,), *_ = np.linalg.lstsq(SPECIFIC[part].reshape(-1, 1), FORCE[part].ravel(), rcond=None)
    found = tared(first=first, until=until)
    assert found.mass == pytest.approx(mass)
    assert found.force == pytest.approx((mass * SPECIFIC[part] - FORCE[part]).mean(axis=0))
    assert found.moment == pytest.approx(MOMENT[part].mean(axis=0))
    assert np.array(found.sides) == pytest.approx(SIDES[part].mean(axis=0))


def test_without_identification_the_mass_is_the_nominal_one_and_before_its_end_there_is_no_bias():
    found = tared(identify=0.0)
    assert found.mass == 2.0
    assert found.force == pytest.approx((2.0 * SPECIFIC - FORCE).mean(axis=0))
    early = tared(armed=0.0)
    assert (early.mass, early.force, early.moment) == (2.0, ZERO, ZERO)
    assert not np.array(early.sides).any()


def test_a_tare_that_begins_anew_forgets_the_one_before():
    sums = NONE
    for begun in (1.0, 0.0, 1.0):
        sums = summed(sums, begun, begun, vec3(FORCE[0]), vec3(SPECIFIC[0]), vec3(MOMENT[0]), NONE.sides)
    assert (sums.count, sums.force) == (1.0, pytest.approx(FORCE[0]))
