"""The guidance by hand where it meets ground and fence: ramps as derivatives of one another, references that stop."""

import numpy as np
import pytest
from guided import hand_guidance
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.low_pass import LowPassState, low_pass_step
from tandemlift.core.phases import GUIDED, IDLE, LAND, LIFT
from tandemlift.core.trajectories import SmoothStep, Trajectory
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, vec3
from tandemlift.parts.guidance.disturbance_observer import DisturbanceEstimate
from tandemlift.parts.guidance.guidance import PilotInput, guide
from tandemlift.parts.guidance.hand_guidance import grounded_at, presses_on_ground, with_lift_and_landing
from tandemlift.parts.guidance.phases import PhaseOutput
from tandemlift.parts.guidance.supervised_reference import fenced, usable_input, with_blind_descent
from tandemlift.parts.mechanics.rigid_body import State

MISSION = tl.load_mission("iris", {"supervision.model": "on"})
GUIDANCE, MEMORY = hand_guidance(MISSION)
SUPERVISION, SEEN = GUIDANCE.supervision, MEMORY.supervision
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
STATE = State(Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3), LEVEL, Vec3(0.3, 0.2, 0.1))
REST = SmoothStep(0.0, 0.0, 0.0)
NAN = float("nan")


def ramp(t, rate):
    """t² and its derivatives, as a ramp."""
    return SmoothStep((rate * t) ** 2, 2.0 * rate * rate * t, 2.0 * rate * rate)


def desired(t):
    """The desired trajectory at time t of a reference that moves, in a lift and a landing at once."""
    phase = PhaseOutput(LAND, 0.0, 1.0, 1.0, 1.0, ramp(t, 0.4), ramp(t, 0.3), -0.05, 1.0)
    moving = Trajectory(Vec3(t, -t, t**3), Vec3(1.0, -1.0, 3.0 * t * t), Vec3(0.0, 0.0, 6.0 * t))
    return with_lift_and_landing(GUIDANCE, moving, phase)


@pytest.mark.parametrize("t", [0.3, 0.8, 1.4])
def test_velocity_and_acceleration_are_the_derivatives_of_what_lift_and_landing_make_of_the_reference(t):
    h = 1e-5
    before, now, after = (desired(t + k * h) for k in (-1, 0, 1))
    assert now.velocity == pytest.approx((np.array(after.position) - np.array(before.position)) / (2 * h), abs=1e-8)
    assert now.acceleration == pytest.approx((np.array(after.velocity) - np.array(before.velocity)) / (2 * h), abs=1e-7)


def test_a_lift_goes_to_its_height_and_a_landing_to_its_end():
    done, still = SmoothStep(1.0, 0.0, 0.0), Trajectory(Vec3(0.0, 0.0, 0.2), ZERO, ZERO)
    up = PhaseOutput(GUIDED, 0.0, 1.0, 1.0, 1.0, done, REST, -0.05, 1.0)
    assert with_lift_and_landing(GUIDANCE, still, up).position.z == pytest.approx(0.2 + GUIDANCE.phasing.height)
    assert with_lift_and_landing(GUIDANCE, still, up._replace(land=done)).position.z == pytest.approx(-0.05)


def test_on_the_ground_the_reference_stays_with_the_vehicle_at_rest_and_in_the_air_it_is_left():
    one, two = Vec3(1.0, -2.0, 0.5), Vec3(0.3, 0.4, -0.6)
    moving = MEMORY.compliance._replace(
        output=LowPassState(one, two), position=two, velocity=one, acceleration=two, jerk=one, anchor=one
    )
    flying = PhaseOutput(GUIDED, 0.0, 1.0, 1.0, 1.0, REST, REST, 0.0, 1.0)
    assert grounded_at(flying, moving, STATE) == moving
    grounded = grounded_at(flying._replace(grounded=1.0), moving, STATE)
    assert (grounded.position, grounded.anchor) == (STATE.position, STATE.position)
    assert grounded.output == LowPassState(ZERO, ZERO)
    assert grounded.velocity == grounded.acceleration == grounded.jerk == ZERO


def test_the_heading_yields_to_the_moment_about_the_vertical_however_the_vehicle_is_tilted():
    mission = tl.load_mission("one-push", {"pilot.guidance": "interactive", "compliance.yaw.model": "compliant"})
    g, m = hand_guidance(mission)
    tilted, moment = Rotation.from_euler("zxy", [0.7, 0.3, -0.2]), [0.5, -0.3, 0.8]
    state = STATE._replace(attitude=Quat(*tilted.as_quat(scalar_first=True).tolist()))
    pilot_input = PilotInput(state, ZERO, vec3(moment), 0.0, Absent())
    none = DisturbanceEstimate(ZERO, ZERO, ZERO, ZERO)
    after = guide(g, m, pilot_input, none, 0.0, 0.0, 1e-3)[1].heading.filtered
    wanted = low_pass_step(g.heading.input_filter, m.heading.filtered, tilted.apply(moment)[2])
    assert after.rate == pytest.approx(wanted.rate)
    assert after.value == pytest.approx(wanted.value)


@pytest.mark.parametrize("yaw", [10.0, -7.0, 3.0])
def test_the_first_heading_is_that_of_the_vehicle_within_half_a_turn(yaw):
    """However many turns the table gives it: the laws wrap differences of headings once."""
    for model in ("held", "compliant"):
        mission = tl.load_mission("iris", {"initial.euler": [0.0, 0.0, yaw], "compliance.yaw.model": model})
        g, m = hand_guidance(mission)
        angle = g.heading.angle if model == "held" else m.heading.angle
        assert angle == pytest.approx(Rotation.from_euler("z", yaw).as_rotvec()[2])


ALONE = GUIDANCE._replace(supervision=Absent())


def stepped(m, pilot_input):
    """The memory after a sample without a disturbance, unsupervised."""
    return guide(ALONE, m, pilot_input, DisturbanceEstimate(ZERO, ZERO, ZERO, ZERO), 0.0, 20.0, 1e-3)[1]


HOVERING = MEMORY._replace(phase=MEMORY.phase._replace(phase=GUIDED, lift_fraction=1.0), supervision=Absent())


def test_a_vehicle_that_has_lost_its_heading_for_too_long_lands():
    for lost, phase in ((0.9, GUIDED), (1.1, LAND)):
        time = lost * GUIDANCE.following.heading_timeout
        m = HOVERING._replace(following=HOVERING.following._replace(heading=time))
        assert stepped(m, PilotInput(STATE, ZERO, ZERO, 0.0, Absent())).phase.phase == phase


def test_everything_is_the_same_above_a_higher_ground():
    """Reference, vehicle and ground are 2 m higher: near the ground a downward push is limited alike."""
    down = GUIDANCE.compliance.band.threshold.z * 20.0
    found = []
    for ground in (0.0, 2.0):
        near = Vec3(0.0, 0.0, ground + 0.12 - GUIDANCE.phasing.height)
        falling = HOVERING.compliance._replace(
            position=near,
            anchor=near,
            velocity=Vec3(0.0, 0.0, -0.2),
            band=HOVERING.compliance.band._replace(active=Vec3(0.0, 0.0, 1.0)),
            output=LowPassState(Vec3(0.0, 0.0, -down), ZERO),
        )
        m = HOVERING._replace(compliance=falling, phase=HOVERING.phase._replace(ground=ground))
        state = STATE._replace(position=Vec3(0.0, 0.0, ground + 0.12))
        found.append(stepped(m, PilotInput(state, Vec3(0.0, 0.0, -down), ZERO, 0.0, Absent())).compliance)
    assert found[1].acceleration == pytest.approx(found[0].acceleration)
    assert found[0].acceleration.z > 0.0  # it brakes, although it is pushed down


def test_feet_press_on_the_ground_below_it_in_a_landing_and_on_a_floor_before_and_after_it():
    m = MEMORY.phase._replace(ground=0.1)
    for phase, floor, below, above in (
        *((LAND, 0.0, 1.0, 0.0), (LAND, 1.0, 1.0, 0.0), (IDLE, 1.0, 1.0, 1.0)),
        *((IDLE, 0.0, 0.0, 0.0), (LIFT, 1.0, 0.0, 0.0)),
    ):
        assert presses_on_ground(m._replace(phase=phase), 0.09, floor) == below
        assert presses_on_ground(m._replace(phase=phase), 0.11, floor) == above


def test_numbers_that_are_none_are_replaced_by_the_last_state_and_by_no_push():
    last, push, moment = SEEN._replace(state=STATE), Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3)
    now = STATE._replace(position=Vec3(5.0, 6.0, 7.0), rates=Vec3(1.0, 1.0, 1.0))
    given = PilotInput(now, push, moment, 0.0, None)
    sound = usable_input(SUPERVISION, last, given, 20.0, 1.0)
    assert (sound.state, sound.push, sound.moment) == (now, push, moment)
    assert (sound.status.rotor_failed, sound.status.thrust, sound.status.state_invalid) == (1.0, 20.0, 0.0)
    for bad in (
        {"position": Vec3(NAN, 0.0, 0.0)},
        {"velocity": Vec3(0.0, float("inf"), 0.0)},
        {"attitude": Quat(1.0, NAN, 0.0, 0.0)},
        {"rates": Vec3(0.0, 0.0, NAN)},
    ):
        found = usable_input(SUPERVISION, last, given._replace(state=now._replace(**bad)), 20.0, 0.0)
        assert (found.state, found.push, found.status.state_invalid) == (STATE, push, 1.0)
    for bad in ({"push": Vec3(0.0, NAN, 0.0)}, {"moment": Vec3(0.0, 0.0, NAN)}):
        found = usable_input(SUPERVISION, last, given._replace(**bad), 20.0, 0.0)
        assert (found.state, found.push, found.moment, found.status.state_invalid) == (now, ZERO, ZERO, 0.0)


@pytest.mark.parametrize("lift", [0.0, 0.7])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_reference_may_move_towards_a_side_of_the_fence_as_fast_as_it_can_brake_before_it(way, lift):
    """The speed towards a side is the braking gain times the distance to it, at most the largest, whatever pulls."""
    f, most = SUPERVISION.fence, np.array(GUIDANCE.compliance.limits.speed)
    side = np.array(f.high if way > 0.0 else f.low)
    place = side - way * np.array([0.1, 0.2, 0.3])
    at = MEMORY.compliance._replace(position=vec3(place - [0.0, 0.0, lift]))
    room = np.minimum(f.braking_gain * np.array([0.1, 0.2, 0.3]), most)
    outside = at._replace(position=vec3(side + way * 0.2 - [0.0, 0.0, lift]))
    for memory, speed in ((at, room), (outside, [0.0] * 3)):
        limits = fenced(SUPERVISION, GUIDANCE.compliance, memory, lift).limits
        towards, back = (limits.speed, limits.speed_back)[:: int(way)]
        assert towards == pytest.approx(speed)
        assert back == pytest.approx(most)  # the other side is far


def test_without_any_known_motion_a_landing_descends_level_and_faster_in_its_second_half():
    target = Trajectory(ZERO, Vec3(0.5, 0.0, 0.0), Vec3(0.2, 0.0, 0.0))
    assert with_blind_descent(SUPERVISION, target, STATE, 0.0, 1.0, 0.3) == target
    falls = [with_blind_descent(SUPERVISION, target, STATE, 1.0, 1.0, x).acceleration for x in (0.2, 0.5, 0.75, 1.0)]
    assert falls[0] == falls[1] == Vec3(0.0, 0.0, -SUPERVISION.blind_descent_acceleration)
    assert falls[3].z - falls[2].z == pytest.approx(falls[2].z - falls[1].z) != 0.0
    assert falls[3].z < falls[2].z < falls[1].z
    held = with_blind_descent(SUPERVISION, target, STATE, 1.0, 0.0, 1.0)
    assert held == Trajectory(STATE.position, STATE.velocity, ZERO)
