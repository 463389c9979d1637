"""What thrust, tilt and ground allow the guidance by hand, and when the vehicle counts as unable to follow."""

import numpy as np
import pytest
from guided import hand_guidance

import tandemlift as tl
from tandemlift.core.phases import REASONS
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Absent, Vec3, each, vec3
from tandemlift.parts.guidance.above_ground import GroundClearance, above_ground
from tandemlift.parts.guidance.available import AvailableForce, available_acceleration, needed_force, usable_thrust
from tandemlift.parts.guidance.compliance import compliance_step
from tandemlift.parts.guidance.following import (
    AT_REST,
    Following,
    FollowingLimits,
    more_urgent,
    must_land,
    update_following,
)
from tandemlift.parts.guidance.requests import ReferenceVelocity
from tandemlift.parts.rotors.rotor_faults import rotor_faults

H = 1e-3
NOT_LED = Absent()
WEIGHT = Vec3(0.0, 0.0, 30.0)
LIMITS = FollowingLimits(10.0, 0.3, 0.25, 0.5, 1.0, 5.0)
WELL = Following(WEIGHT, 40.0, ZERO, 0.0, 1.0)
BAD = {  # beyond one limit, and by as little
    "thrust": WELL._replace(max_thrust=29.99),
    "tilt": WELL._replace(needed=Vec3(6.01, 8.01, 30.0)),
    "heading": WELL._replace(heading_error=-0.301),
    "position": WELL._replace(error=Vec3(0.0, 0.16, 0.2)),
}
NUMBERS = {reason.key: float(i) for i, reason in enumerate(REASONS, start=1)}


def told(what, seconds, memory=AT_REST):
    """The number of the reason at every step of `what(t)`, and the memory after them."""
    said = []
    for i in range(round(seconds / H)):
        memory = update_following(LIMITS, memory, what(i * H), i * H, H)
        said.append(memory.reason)
    return np.array(said), memory


def test_a_vehicle_at_its_reference_can_follow():
    said, memory = told(lambda t: WELL._replace(needed=Vec3(5.99, 7.99, 30.0), error=Vec3(0.15, 0.19, 0.0)), 2.0)
    assert not said.any()
    assert (memory.lasted, memory.most_urgent, must_land(LIMITS, memory)) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("reason", list(BAD))
def test_each_limit_gives_its_reason_once_it_has_lasted_and_until_it_has_been_over_for_longer(reason):
    said, memory = told(lambda t: BAD[reason] if t < 2.0 else WELL, 4.0)
    assert not said[:499].any()
    assert set(said[501:2990]) == {NUMBERS[reason]}
    assert not said[3010:].any()
    assert memory.first == pytest.approx(0.5, abs=2 * H)
    assert memory.lasted == pytest.approx(2.5, abs=3 * H)
    assert memory.most_urgent == NUMBERS[reason]


@pytest.mark.parametrize("reason", list(BAD))
def test_shorter_than_its_time_none_counts_and_on_the_ground_never(reason):
    assert not told(lambda t: BAD[reason] if t % 0.6 < 0.49 else WELL, 3.0)[0].any()
    assert not told(lambda t: BAD[reason]._replace(active=0.0), 3.0)[0].any()


def test_a_reason_only_gives_way_to_one_of_higher_priority():
    said, _ = told(lambda t: BAD["position"] if t < 1.0 else BAD["thrust"] if t < 2.0 else BAD["position"], 4.0)
    assert list(dict.fromkeys(said)) == [0.0, NUMBERS["position"], NUMBERS["thrust"]]
    assert more_urgent(0.0, 0.0) == 0.0
    assert (more_urgent(2.0, 0.0), more_urgent(0.0, 3.0), more_urgent(3.0, 1.0)) == (2.0, 3.0, 1.0)


def test_only_a_heading_that_is_lost_for_long_leads_to_a_landing():
    for reason, what in BAD.items():
        _, memory = told(lambda t, what=what: what, 5.1)
        assert must_land(LIMITS, memory) == float(reason == "heading")
    assert must_land(LIMITS, told(lambda t: BAD["heading"], 4.9)[1]) == 0.0


def available(known):
    """Eight rotors that may use 50 N, on a vehicle of 3 kg that may tilt by 0.5 rad."""
    return AvailableForce(3.0, 50.0, np.tan(0.5), each(8)(*[7.0] * 8), known)


def test_the_thrust_that_may_be_used_is_that_of_the_rotors_that_are_known_to_work():
    assert usable_thrust(available(Absent()), 9.0) == 50.0
    lost = rotor_faults(8, [(1, 2, 5.0, 0.0), (2, 4, 6.0, 0.5)])
    assert usable_thrust(available(lost), 4.0) == pytest.approx(50.0)
    assert usable_thrust(available(lost), 5.5) == pytest.approx(50.0 * 7.0 / 8.0)
    assert usable_thrust(available(lost), 9.0) == pytest.approx(50.0 * 6.5 / 8.0)


def test_forces_are_those_of_statics():
    k = available(Absent())
    assert needed_force(k, Vec3(1.0, -2.0, -5.0)) == Vec3(-1.0, 2.0, 3.0 * GRAVITY + 5.0)
    weight = 3.0 * GRAVITY
    assert available_acceleration(k, ZERO, 100.0) == pytest.approx(np.tan(0.5) * GRAVITY)
    assert available_acceleration(k, ZERO, 31.0) == pytest.approx(np.sqrt(31.0**2 - weight**2) / 3.0)
    assert available_acceleration(k, Vec3(0.0, 0.0, -2.0), 31.0) == 0.0


def lowest(clearance, push, start=1.0, seconds=8.0, lead=NOT_LED):
    """The height of the reference above the ground at every step under a push F(t) [N], or at a caller's velocity."""
    changes = {"pilot.guidance": "interactive", "admittance.gate": "soft"}
    mission = tl.load_mission("one-push", changes)
    g, m = hand_guidance(mission)
    m, heights = m.compliance, []
    for i in range(round(seconds / H)):
        k = above_ground(clearance, g.compliance, m.position.z + start)
        m = compliance_step(k, m, vec3((0.0, 0.0, push(i * H))), 1.0, 0.0, 10.0, Absent(), H, lead, Absent())
        heights.append(m.position.z + start)
    return np.array(heights)


@pytest.mark.thorough
def test_a_push_moves_the_reference_down_to_the_ground_only_where_there_is_no_clearance():
    heights = lowest(GroundClearance(0.1), lambda t: -50.0, seconds=5.0)
    assert heights.min() > 0.05  # the jerk is limited, so it brakes a little late
    assert 0.05 < heights[-1] < 0.13
    assert lowest(Absent(), lambda t: -50.0, seconds=2.0).min() < 0.0


def test_a_push_upwards_takes_no_limit_from_a_reference_that_still_moves_down():
    thrown = lowest(GroundClearance(0.1), lambda t: -50.0 if t < 0.8 else 1.2, seconds=4.0)
    assert 0.05 < thrown.min() < 0.2
    led = ReferenceVelocity(Vec3(0.0, 0.0, -0.8), 1.0)
    against = lowest(GroundClearance(0.1), lambda t: 5.0, seconds=4.0, lead=led)
    assert 0.05 < against.min() < 0.2


@pytest.mark.thorough
def test_from_there_a_push_upwards_lifts_it_as_ever():
    up = lowest(GroundClearance(0.1), lambda t: -5.0 if t < 4.0 else 2.0)
    assert up.min() > 0.05
    free = lowest(Absent(), lambda t: 0.0 if t < 4.0 else 2.0, start=0.1)
    assert up[-1] - up[4000] == pytest.approx(free[-1] - free[4000], rel=0.05)
