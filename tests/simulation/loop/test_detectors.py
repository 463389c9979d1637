"""Detectors step by step, on motion that is given."""

from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each
from tandemlift.parts.guidance.guidance import ThrustFraction
from tandemlift.parts.rotors.allocation import mixer_from
from tandemlift.simulation.loop.detectors import ASLEEP, FindingLimits, counted, detect, thrust_needed
from tandemlift.simulation.loop.excess import NO_EXCESS
from tandemlift.simulation.loop.oscillation import OscillationLimits, Swings
from tandemlift.simulation.loop.push_detectors import (
    ECHO_TIME,
    NO_RESPONSE,
    UNMOVED,
    PushLimits,
    push_step,
    unpushed_step,
)

DT = 0.01
LIMITS = PushLimits(
    threshold=Vec3(0.3, 0.3, 0.3),
    least=0.03**2,
    inverse_damping=Vec3(0.5, 0.5, 0.0),
    speed=Vec3(1.0, 1.0, 1.0),
    time=2.0,
    response=0.2,
)
FORCE = 1.0  # N, which should come to half a metre per second


def watched(story, seconds, limits=LIMITS):
    """The memory after each step of `story(t)`: push along x [N], speed along x [m/s], and whether it is watched."""
    memory, seen = NO_RESPONSE, []
    for k in range(round(seconds / DT)):
        force, speed, active = story(k * DT)
        sample = SimpleNamespace(velocity=Vec3(speed, 0.0, 0.0), position=ZERO)
        memory = push_step(limits, memory, Vec3(force, 0.0, 0.0), sample, active, k * DT, DT)
        seen.append(memory)
    return seen


def test_a_push_that_moves_nothing_is_unanswered_once_its_time_is_over():
    seen = watched(lambda t: (FORCE, 0.0, 1.0), 3.0)
    assert seen[-1].unanswered.start == pytest.approx(2.0, abs=DT)
    assert seen[-1].unanswered.steps == pytest.approx(100, abs=1)
    assert seen[-1].unanswered.worst == pytest.approx(FORCE)
    assert seen[-1].expected == pytest.approx(FORCE * 0.5 * 3.0)
    assert not watched(lambda t: (FORCE, 0.0, 0.0), 3.0)[-1].unanswered.steps
    assert not watched(lambda t: (0.02, 0.0, 1.0), 3.0)[-1].unanswered.steps


@pytest.mark.parametrize(("speed", "steps"), [(0.5, 0), (0.11, 0), (0.09, 100), (-0.5, 100)])
def test_a_push_is_answered_by_the_work_that_it_does_at_a_fraction_of_the_speed_it_should_have(speed, steps):
    assert watched(lambda t: (FORCE, speed, 1.0), 3.0)[-1].unanswered.steps == pytest.approx(steps, abs=1)


def test_the_speed_that_is_asked_for_is_bounded_and_an_axis_with_a_spring_owes_nothing():
    assert watched(lambda t: (10.0, 0.0, 1.0), 3.0)[-1].expected == pytest.approx(10.0 * 1.0 * 3.0)
    sprung = LIMITS._replace(inverse_damping=Vec3(0.0, 0.5, 0.5))
    last = watched(lambda t: (FORCE, 0.4, 1.0), 3.0, sprung)[-1]
    assert (last.expected, last.done, last.unanswered.steps) == (0.0, 0.0, 0.0)


def test_each_push_is_judged_by_itself():
    """The first is answered for 10 s, as well as can be; the second, after a pause, moves nothing."""

    def story(t):
        return (FORCE, 0.5, 1.0) if t < 10.0 else (0.0, 0.5, 1.0) if t < 11.0 else (FORCE, 0.0, 1.0)

    seen = watched(story, 15.0)
    assert not seen[round(12.9 / DT)].unanswered.steps  # the time of the second begins anew, too
    assert seen[-1].unanswered.start == pytest.approx(13.0, abs=2 * DT)
    assert seen[-1].since == pytest.approx(11.0, abs=2 * DT)
    assert (seen[-1].expected, seen[-1].done) == (pytest.approx(0.5 * 4.0, rel=0.01), 0.0)
    assert seen[round(10.5 / DT)].unanswered.now == 0.0


def test_a_push_that_was_unanswered_leaves_nothing_to_the_next():
    def story(t):
        return (FORCE, 0.0, 1.0) if t < 1.9 else (0.0, 0.0, 1.0) if t < 3.0 else (FORCE, 0.12, 1.0)

    assert not watched(story, 8.0)[-1].unanswered.steps


def test_a_rotor_that_cannot_be_used_is_not_at_its_limit():
    for usable in (0.5, 1.0, 7.0):
        assert [counted(at_limit, usable) for at_limit in (0.0, 1.0)] == [0.0, 1.0]
    assert counted(1.0, 0.0) == 0.0


def test_the_thrust_that_the_reference_needs_is_that_of_newton():
    needed = 3.0 * np.linalg.norm([1.0, -2.0, 0.5 + GRAVITY])
    assert thrust_needed(NO_EXCESS, 3.0, Vec3(1.0, -2.0, 0.5)) == pytest.approx(needed**2)


def unpushed(story, seconds):
    """The memory after each step of `story(t)`: 1 while pushed, 1 while a push is followed, and the reference [m]."""
    memory, seen = UNMOVED, []
    for k in range(round(seconds / DT)):
        pushed, followed, x = story(k * DT)
        memory = unpushed_step(0.5, memory, (pushed, followed), Vec3(x, 0.0, 0.0), ZERO, k * DT, DT)
        seen.append(memory)
    return seen


def test_a_reference_that_moves_without_any_push_is_found_by_its_way_from_where_that_began():
    last = unpushed(lambda t: (0.0, float(t >= 1.0), 3.0 + t), 4.0)[-1]
    assert last.origin.x == pytest.approx(4.0, abs=2 * DT)
    assert last.excess.start == pytest.approx(1.5, abs=2 * DT)
    assert last.excess.worst == pytest.approx(3.0, abs=2 * DT)
    assert not unpushed(lambda t: (0.0, 0.0, 3.0 + t), 4.0)[-1].excess.steps  # nothing is followed: a lift, say


def test_what_filters_pass_on_shortly_after_a_push_counts_for_the_push_and_what_comes_later_does_not():
    def story(t):
        return float(1.0 <= t < 2.0), float(1.0 <= t < 2.4 or t >= 5.0), t

    seen = unpushed(story, 7.0)
    assert seen[-1].last == pytest.approx(2.0, abs=2 * DT)
    assert not seen[round(5.4 / DT)].excess.steps
    assert seen[-1].excess.start == pytest.approx(5.5, abs=2 * DT)
    assert not unpushed(lambda t: (1.0, 1.0, t), 4.0)[-1].excess.steps
    late = unpushed(lambda t: (float(t < 2.0), 1.0, t), 4.0)[-1]  # followed for longer than filters explain
    assert late.origin.x == pytest.approx(2.0 + ECHO_TIME, abs=3 * DT)
    assert late.excess.worst == pytest.approx(1.5, abs=3 * DT)


# All detectors together, on a vehicle whose motion and reference are given

CALM = {
    "position": ZERO, "velocity": ZERO, "rates": ZERO, "euler": ZERO, "attitude": Quat(1.0, 0.0, 0.0, 0.0),
    "reference_position": ZERO, "reference_velocity": ZERO, "reference_acceleration": ZERO, "reference_euler": ZERO,
    "push_force": ZERO,
}  # fmt: skip
OSCILLATION = OscillationLimits(Swings(0.3, 0.3, 0.3, 0.15), shortest=0.02, longest=2.0, halves=4.0)
FOUND = FindingLimits(
    settled=1.0, distance=0.1**2, sinking=0.05, heading=0.2, upright=np.cos(0.25), mass=3.0, thrust=40.0**2,
    rate=0.3**2, push=LIMITS, unpushed=1.0, oscillation=OSCILLATION, shake=1.0,
)  # fmt: skip
STILL = SimpleNamespace(position=ZERO)


def detected(sample, seconds=3.0, running=1.0):
    """The memory of all detectors after a flight whose samples are given, as a function of time."""
    memory = ASLEEP._replace(saturation=Absent())
    effect = mixer_from(np.ones((4, 4)))
    pilot = SimpleNamespace(detection=Absent(), allocation=effect)
    guidance = SimpleNamespace(flying=1.0, running=ThrustFraction(running), force=ZERO, admittance=STILL)
    decision = SimpleNamespace(guidance=guidance, thrusts=each(4)(1.0, 1.0, 1.0, 1.0))
    output = SimpleNamespace(decision=decision, estimates=Absent())
    for k in range(round(seconds / DT)):
        state = SimpleNamespace(detectors=memory, memory=SimpleNamespace(detection=Absent()))
        model = SimpleNamespace(finding_limits=FOUND, flight_state=state, pilot=pilot, rotors=Absent())
        memory = detect(model, output, SimpleNamespace(**{**CALM, **sample(k * DT)}), k * DT, DT)
    return memory


def test_nothing_is_watched_of_a_vehicle_whose_rotors_stand_still():
    far = {"position": Vec3(0.08, 0.0, -0.08)}
    assert detected(lambda t: far).distance.steps == pytest.approx(200.0, abs=1)  # once settled
    assert detected(lambda t: far).sinking.worst == pytest.approx(0.08)
    assert detected(lambda t: {"position": Vec3(0.08, 0.0, 0.08)}).sinking.steps == 0.0
    assert detected(lambda t: far, running=0.0).distance.steps == 0.0


def test_a_heading_is_compared_with_that_of_the_reference():
    same = {"euler": Vec3(0.1, 0.0, 1.0), "reference_euler": Vec3(0.0, 0.1, 1.1)}
    assert detected(lambda t: same).heading.steps == 0.0
    across = {"euler": Vec3(0.0, 0.0, -3.1), "reference_euler": Vec3(0.0, 0.0, 3.1)}  # 0.08 rad apart
    assert detected(lambda t: across).heading.steps == 0.0


@pytest.mark.parametrize("signal", Swings._fields)
def test_an_oscillation_is_found_in_the_signal_that_swings(signal):
    def swinging(t):
        x = np.sin(2.0 * np.pi * 2.0 * t)
        rates = Vec3(*[float(x) if signal == name else 0.0 for name in ("roll", "pitch", "yaw")])
        return {"rates": rates, "velocity": Vec3(0.0, 0.0, float(x) if signal == "vertical" else 0.0)}

    swings = detected(swinging, 4.0).oscillation.swings
    assert {name for name, found in swings._asdict().items() if found.halves > 0.0} == {signal}
