"""The virtual hand: what of a mouse's movement reaches the vehicle as a force."""

import math

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.core.vector import ZERO, Absent, Mat3, Quat, Vec3
from tandemlift.parts.mechanics.push import PointPush, PushSamples
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.person.person import person_step
from tandemlift.parts.person.person_table import start_virtual_hand
from tandemlift.parts.person.virtual_hand import HAND_RELEASED

DT = 0.002
PERSON = interactive_mission(tl.load_mission("hover")).person
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
NO_PUSH = PushSamples(*[PointPush(ZERO, Mat3(ZERO, ZERO, ZERO))] * 3)


def pulls(target, body=lambda t: (0.0, 0.0), duration=4.0):
    """The force along x [N] at each step: of a hand whose target is at `target(t)`, on a grip at `body(t)`, its speed.

    The hand takes hold at the first step.
    """
    hand, memory = start_virtual_hand(PERSON, DT)
    forces = []
    for t in np.arange(0.0, duration, DT):
        place, speed = body(t)
        state = State(Vec3(place, 0.0, 0.0), Vec3(speed, 0.0, 0.0), LEVEL, ZERO)
        given = HAND_RELEASED._replace(held=1.0, target=Vec3(target(t), 0.0, 0.0))
        push, memory = person_step(hand._replace(hand=given), memory, NO_PUSH, state, Absent(), t, DT)
        forces.append(push.start.force.x)
    return np.array(forces)


@pytest.mark.parametrize("frequency", [0.3, 1.0, 8.0])
def test_a_shaken_target_pulls_as_the_spring_does_less_what_the_low_pass_takes(frequency):
    size, angular = 0.05, 2.0 * math.pi * frequency
    force = pulls(lambda t: size * math.sin(angular * t), duration=8.0)[round(4.0 / DT) :]
    expected = PERSON.stiffness * size / (1.0 + (angular * PERSON.lag) ** 2)
    assert 0.5 * np.ptp(force) == pytest.approx(expected, rel=0.01)


def test_half_of_the_force_of_a_jump_is_there_within_150_ms_and_the_force_stays_below_the_largest():
    jump, begin = 0.3, 1.0
    force = pulls(lambda t: jump if t >= begin else 0.0, duration=6.0)[round(begin / DT) :]
    full = jump * PERSON.stiffness
    assert force[-1] == pytest.approx(full, rel=1e-3)
    assert DT * np.argmax(force > 0.5 * full) < 0.15
    assert force.max() <= 1.0001 * full < PERSON.max_force


def test_in_a_steady_drag_the_grip_trails_by_the_low_pass_and_the_damper():
    speed, ahead = 0.4, 0.3
    force = pulls(lambda t: ahead + speed * t, lambda t: (speed * t, speed), duration=6.0)[-1]
    spring = PERSON.stiffness * (ahead - speed * 2.0 * PERSON.lag)
    assert force == pytest.approx(spring - PERSON.damping * speed, rel=5e-3)


def test_the_damper_brakes_the_grip_without_delay():
    at_rest = pulls(lambda t: 0.0, duration=1.0)[-1]
    knocked = pulls(lambda t: 0.0, lambda t: (0.0, 0.1 if t > 1.0 - 1.5 * DT else 0.0), duration=1.0)[-1]
    assert knocked - at_rest == pytest.approx(-0.1 * PERSON.damping, rel=1e-3)
