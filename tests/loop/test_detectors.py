"""Detectors step by step, on motion that is given."""

from types import SimpleNamespace

import pytest

from tandemlift.algebra.vector import ZERO, Vec3
from tandemlift.loop.detectors import NO_RESPONSE, PushLimits, push_step

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
