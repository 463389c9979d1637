"""What is told of a flight by its last state: its outcome, findings and failure."""

from types import SimpleNamespace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.faults import CHECKS
from tandemlift.core.phases import GUIDED, IDLE, LIFT, REASONS
from tandemlift.core.vector import Vec3
from tandemlift.parts.guidance.supervision import PHASE
from tandemlift.simulation.findings import findings_of
from tandemlift.simulation.outcome import outcome_of
from tandemlift.simulation.parameter_changes import ParameterRamp
from tandemlift.simulation.plan import FlightPlan


def outcome(start, highest, height, end, speed=0.0, **keys):
    """The outcome of mission hover, which lifts at 1 s and lands from 5 to 9 s, from heights [m] above 0."""
    clock = {
        "phases.lift_start": 1.0,
        "phases.lift_duration": 2.0,
        "phases.land_start": 5.0,
        "phases.land_duration": 4.0,
    }
    plan = FlightPlan(tl.load_mission("hover", {**clock, "initial.position": [0.0, 0.0, start], **keys}))
    moved = plan.model.flight_state.state._replace(position=Vec3(0.0, 0.0, height), velocity=Vec3(0.0, speed, 0.0))
    state = plan.model.flight_state._replace(state=moved)
    return outcome_of(plan, state, plan.sample, highest, end)


@pytest.mark.parametrize("start", [0.0, 4.0])
def test_without_a_floor_a_vehicle_has_landed_once_its_landing_is_over_where_it_began_and_at_rest(start):
    up = start + 1.0
    assert outcome(start, up, start, 9.5) == "landed"
    assert outcome(start, up, start, 8.5) == "flying"  # it has not yet had the time
    assert outcome(start, up, up, 9.5) == "flying"
    assert outcome(start, up, start, 9.5, speed=1.0) == "flying"
    assert outcome(start, start + 0.01, start, 9.5) == "not-lifted"
    assert outcome(start, start + 0.01, start, 2.5) == "flying"  # the lift is not over


def findings(mission, **guidance):
    """(kind, quantity) of what a flight is told to have found, by its memory of the guidance."""
    return [(f.kind, f.quantity) for f in whole_findings(mission, **guidance)]


def whole_findings(mission, **guidance):
    """The same with time and text."""
    plan = FlightPlan(mission)
    start = plan.model.flight_state
    memory = start.memory._replace(guidance=start.memory.guidance._replace(**guidance))
    return findings_of(plan, start._replace(memory=memory), 100, "landed")


def test_a_vehicle_that_cannot_follow_is_told_why():
    mission = tl.load_mission("iris")
    following = FlightPlan(mission).model.flight_state.memory.guidance.following
    assert findings(mission) == []
    for number, reason in enumerate(REASONS, 1):
        least = following._replace(most_urgent=float(number), lasted=2.0, first=1.0)
        assert findings(mission, following=least) == [("cannot-follow", reason.text)]


@pytest.mark.parametrize("check", [check for check in CHECKS if check.before == "lift"], ids=lambda check: check.key)
def test_a_refused_lift_is_told_unless_the_vehicle_lifts_later(check):
    mission = tl.load_mission("iris", {"supervision.model": "on"})
    supervision = FlightPlan(mission).model.flight_state.memory.guidance.supervision
    refused, lift, guided = IDLE * PHASE + check.number, LIFT * PHASE, GUIDED * PHASE

    def told(*codes):
        slots = len(supervision.events.code)
        filled = type(supervision.events.code)(*[*map(float, codes), *[0.0] * (slots - len(codes))])
        events = supervision.events._replace(code=filled, count=float(len(codes)))
        return findings(mission, supervision=supervision._replace(events=events))

    assert told(refused) == told(lift, refused) == told(guided, refused, IDLE * PHASE) == [("lift-refused", check.text)]
    assert told(refused, lift) == told(refused, lift, guided) == told(lift) == []
    times = type(supervision.events.time)(*[1.5 + i for i in range(len(supervision.events.time))])
    codes = type(supervision.events.code)(float(lift), float(refused), *[0.0] * (len(times) - 2))
    events = supervision.events._replace(time=times, code=codes, count=2.0)
    (found,) = whole_findings(mission, supervision=supervision._replace(events=events))
    assert found.time == 2.5  # of the refusal, not of the lift before


@pytest.mark.thorough
def test_a_failure_is_told_by_what_ended_the_flight_or_else_by_its_outcome():
    short = {"mission.duration": 4.5, "mission.log_interval": 0.1}
    pressed = {"disturbance.force": [0.0, 0.0, -30.0], "phases.lift_duration": 1.0}
    changes = [{}, pressed, {"disturbance.moment": [60.0, 0.0, 0.0]}]
    well, left, turned = tl.fly_many([tl.load_mission("iris", {**short, **more}) for more in changes], keep="metrics")
    assert (well["outcome"], well["failure"]) == ("flying", "")
    assert left["outcome"] == "not-lifted"
    assert left["failure"].startswith("not-lifted: ")
    assert turned["outcome"] == "crashed"
    assert turned["failure"].startswith("crashed at ")
    assert "tilt [deg]" in turned["failure"]


def test_a_ramp_gives_up_the_numbers_that_a_later_change_takes_over_and_no_other():
    numbers, target = np.zeros(5), np.array([1.0, 2.0, 3.0, 4.0, np.inf])
    ramp = ParameterRamp(numbers.copy(), np.array([0, 2, 3, 4]), target, SimpleNamespace(first=10, steps=4))
    ramp.release(np.array([3, 1]))
    assert ramp.apply(numbers, 10)
    assert numbers.tolist() == [0.25, 0.0, 0.75, 0.0, np.inf]
    assert not ramp.apply(numbers, 13)
    assert numbers.tolist() == [1.0, 0.0, 3.0, 0.0, np.inf]


@pytest.mark.parametrize("first", ["plain", "compiled"])
def test_a_controller_in_plain_python_is_not_exchanged_in_flight(first, by_hand):
    own, other = by_hand["controller"], {"name": "smc"}
    before, after = (own, other) if first == "plain" else (other, own)
    changes = {"controller": before, "changes": [{"time": 0.02, "key": "controller", "value": after}]}
    with pytest.raises(tl.InputError, match="controller 'by-hand' is plain Python"):
        tl.fly(tl.load_mission("iris", {"mission.duration": 0.05, **changes}))
