"""Findings that come from the events of a supervised flight, and from a rotor that failed."""

import pytest

import tandemlift as tl

WATCHED = {
    "mission.duration": 12.0,
    "phases.lift_start": 0.5,
    "phases.lift_duration": 2.0,
    "phases.land_start": 7.0,
    "phases.land_duration": 3.0,
    "compliance.max_descent_speed": 0.8,  # m/s: lands in 3 s
    "supervision.model": "on",
    "sensor_faults": [{"sensor": "position", "kind": "bias", "time": 1000.0}],  # none, in the same compiled loop
}
LATE = {"phases.land_start": 1000.0}
FAILING = {"sensor_faults": [{"sensor": "gyroscope", "kind": "frozen", "time": 6.0}]}


@pytest.fixture(scope="module")
def fly():
    return lambda changes: tl.fly(tl.load_mission("iris", {**WATCHED, **changes}))


def kinds(flight):
    return [f.kind for f in flight.findings]


def test_a_landing_that_nobody_asked_for_has_the_fault_as_its_reason(fly):
    found = fly({**LATE, **FAILING}).findings
    assert [f.kind for f in found] == ["landed-by-fault"]
    assert found[0].quantity == "gyroscope frozen"
    assert 6.0 < found[0].time < 6.3


def test_a_landing_that_was_asked_for_is_none(fly):
    flight = fly({})
    assert flight.outcome == "landed"
    assert kinds(flight) == []


def test_a_refused_lift_says_which_check_failed(fly):
    flight = fly({"supervision.checks.thrust_fraction": 0.3})
    assert flight.outcome == "not-lifted"
    (found,) = [f for f in flight.findings if f.kind == "lift-refused"]
    assert found.quantity == "hover not feasible"
    assert found.time == pytest.approx(0.5, abs=0.01)


def test_a_rotor_that_failed_is_the_reason_of_a_landing_without_supervision():
    flight = tl.fly(tl.load_mission("rotor-loss", {"mission.duration": 18.0}))
    assert kinds(flight) == ["landed-by-fault"]
    assert "rotor 1" in flight.findings[0].text
    assert 14.0 < flight.findings[0].time < 14.5


def test_a_part_that_meets_the_floor_is_named_with_its_place_and_force():
    """A vehicle that starts tilted above the floor, its rotors weak: it falls onto a guard."""
    changes = {
        "mission.duration": 1.0,
        "ground.height": -1.5,  # m
        "initial.euler": [0.9, 0.0, 0.0],
        "crash.tilt": 3.2,
        "crash.impulse": 1e6,
        "supervision.model": "none",
        "sensor_faults": [],
    }
    flight = tl.fly(tl.load_mission("iris", {**WATCHED, **changes}))
    touched = [f for f in flight.findings if f.kind == "touched"]
    assert touched
    assert touched[0].quantity.endswith("on floor")
    assert touched[0].place[2] == pytest.approx(-1.5, abs=0.4)
    contact = flight["contact_force"][:, 2]
    assert touched[0].value > 0.0
    assert flight.time[(contact > 0.0).argmax()] == pytest.approx(touched[0].time, abs=0.02)
    assert not any(f.kind == "touched" for f in tl.fly(tl.load_mission("iris", WATCHED)).findings)
