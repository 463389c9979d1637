"""Flights that once ended badly without a word: each flies well now, or is told of after.

A row says how a flight ends, and the findings that it must have. A row without findings flies well: it lands, near its
reference all the time. What is warned of before is in `tests/missions/test_warned.py`.
"""

from typing import Any, NamedTuple

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.phases import LIMITED, REASONS

NEAR = 0.12  # m, largest distance from the reference along each axis of a flight that goes well
WATCHED = {"supervision.model": "on"}
TUMBLES = "crashed or landed"  # it bounces over the floor, which may turn it over late or never


def fleet(**changes: Any) -> dict[str, Any]:
    """The quadrotors of mission iris, with a changed value or a factor (a function) for each of some keys."""
    quadrotors = tl.load_mission("iris").model_dump(mode="json", exclude_none=True)["vehicle"]["quadrotors"]
    changed = [{k: c(q[k]) if callable(c) else c for k, c in changes.items()} for q in quadrotors]
    return {"vehicle.quadrotors": [{**q, **c} for q, c in zip(quadrotors, changed, strict=True)]}


def air(x: float, y: float) -> dict[str, Any]:
    return {"wind.model": "air", "wind.velocity": [x, y, 0.0], "wind.turbulence": 7.7}


def slower(factor: float) -> dict[str, Any]:
    return fleet(lag_up=lambda lag: factor * lag, lag_down=lambda lag: factor * lag)


WEAKER = [{"quadrotor": q, "rotor": r, "efficiency": 0.65, "time": 0.0} for q in (1, 2) for r in (1, 2, 3, 4)]
PAPER_GAINS = tl.load_mission("paper").controller.gains.model_dump(mode="json")
PAPER = {
    "controller.gains": PAPER_GAINS,
    "controller.boundary_layer": 0.1,
    "controller.attitude_reference_derivatives": "zero",
}


class Row(NamedTuple):
    """A flight.

    Attributes:
        mission: name of the mission.
        changes: what makes it fly badly.
        outcome: of the flight, or two of which it is one.
        found: kinds of findings that it must have; with None, it flies well.
        reason: why the vehicle cannot follow, "" if it can.
    """

    mission: str
    changes: dict[str, Any]
    outcome: str
    found: set[str] | None
    reason: str = ""


ROWS = {
    "delay of 0.1 s": Row("iris", {"actuators.delay": 0.1}, TUMBLES, {"saturated", "off-track"}),
    "lag of 0.5 s": Row("iris", fleet(lag_up=0.5, lag_down=0.5), TUMBLES, {"saturated", "off-track"}),
    "six times the lag, three times the delay": Row(
        "iris", {**slower(6.0), "actuators.delay": 0.03}, "landed", {"oscillating", "saturated"}
    ),
    "yaw moment of 3 N m": Row(
        "iris",
        {"disturbance.moment": [0.0, 0.0, 3.0]},
        "landed",
        {"saturated", "off-track", "cannot-follow"},
        "heading lost",
    ),
    "wind along x": Row("iris", air(4.0, 0.0), "landed", None),
    "wind along -y": Row("iris", air(0.0, -4.0), "landed", None),
    "25 % heavier": Row("iris", {"plant.mass_scale": 1.25}, "landed", None),
    "rotors 35 % weaker": Row(
        "iris", {"faults": WEAKER}, "landed", {"no-response-to-push", "cannot-follow"}, "no thrust left"
    ),
    "30 N downwards": Row(
        "iris",
        {"disturbance.force": [0.0, 0.0, -30.0]},
        "not-lifted",
        {"saturated", "off-track", "cannot-follow"},
        "no thrust left",
    ),
    "gains of paper on the rotors of iris": Row(
        "iris", PAPER, "landed", {"saturated", "oscillating", "cannot-follow"}, "heading lost"
    ),
    "paper on real rotors": Row("paper", {"actuators.model": "rotors"}, "crashed", set()),
}


@pytest.fixture(scope="module")
def flown():
    """A flight by the name of its row, with supervision or without, each flown once."""
    kept: dict[tuple[str, bool], Any] = {}

    def of(name, watched=False):
        if (name, watched) not in kept:
            row = ROWS[name]
            kept[name, watched] = tl.fly(tl.load_mission(row.mission, row.changes | (WATCHED if watched else {})))
        return kept[name, watched]

    return of


@pytest.mark.thorough
@pytest.mark.parametrize("name", ROWS)
def test_its_outcome_and_its_findings_tell_of_it_after(name, flown):
    row, flight = ROWS[name], flown(name)
    assert flight.outcome in row.outcome.split(" or ")
    assert (flight.ending is not None) == (flight.outcome == "crashed")
    kinds = {finding.kind for finding in flight.findings}
    if row.found is not None:
        assert row.found <= kinds
        return
    assert kinds <= {"oscillating", "response-without-push", "no-response-to-push"}  # in a gust, which it is warned of
    error = np.abs(flight["position"] - flight["reference_position"])
    assert error.max() < NEAR
    assert np.degrees(np.abs(flight["euler"][:, :2])).max() < 17.0


@pytest.mark.parametrize("name", [name for name, row in ROWS.items() if row.reason])
def test_a_vehicle_that_cannot_follow_says_why_from_the_end_of_the_lift_on(name, flown):
    row, flight = ROWS[name], flown(name)
    told = [finding.text for finding in flight.findings if finding.kind == "cannot-follow"]
    assert len(told) == 1
    assert row.reason in told[0]
    reason = flight["limited_reason"]
    assert REASONS[int(reason[reason > 0.0].min()) - 1].text == row.reason
    if row.reason == "no thrust left":
        after = (flight.time > 8.4) & (flight.time < 13.0)
        assert set(flight["phase"][after]) == {LIMITED}
    else:
        assert flight["phase"][-1] == 0.0  # it has landed long before its time
        assert flight.time[flight["phase"] == 3.0][-1] < 60.0


CLEAN_ENDS = ["yaw moment of 3 N m", "rotors 35 % weaker", "30 N downwards", "six times the lag, three times the delay"]


@pytest.mark.thorough
@pytest.mark.parametrize("name", CLEAN_ENDS)
def test_under_supervision_it_lands_in_time_and_says_why(name, flown):
    flight = flown(name, watched=True)
    assert flight.outcome in ("landed", "not-lifted")
    assert flight.time[flight["phase"] > 0.0][-1] < 25.0
    assert "landed-by-fault" in {finding.kind for finding in flight.findings}
    assert flight["rotor_thrusts"][-1].max() < 1e-6
