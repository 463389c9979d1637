"""A flight that crashes in a session says so: what, when, where, and that it must begin again."""

import math

import pytest
from sessions import GUIDED, fly, say, up

import tandemlift as tl
from tandemlift.apps.live.session.session import Session

SHORT = {"supervision.model": "on", "supervision.limits.tilt_time": 100.0, "supervision.limits.tilt": 0.11}


@pytest.fixture
def tender(tmp_path):
    """A session of a vehicle for which a hard push is a crash."""
    one = Session(tl.load_mission("hover", GUIDED | SHORT | {"crash.tilt": 0.12, "promise.tilt": 0.1}), out=tmp_path)
    one.prepare()
    yield one
    one.stop()


def test_a_crash_is_told_with_quantity_time_and_place_and_ends_when_the_flight_begins_again(tender):
    assert tender.status()["ending"] is None
    start = up(tender)
    say(tender, "force", force=(4.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    fly(tender, 2.0)
    status = tender.status()
    ending = status["ending"]
    assert status["phase"] == "crashed"
    assert ending["text"] == str(tender.flight.ending)
    assert "tilt [deg]" in ending["text"]
    assert 8.0 < ending["time"] < 10.0
    assert math.dist(ending["place"], start) < 0.5
    assert set(status["refusals"].values()) == {
        f"{what}: the flight has crashed or diverged. Begin the flight again."
        for what in ("Lift is refused", "Landing is refused", "The push is not followed")
    }
    assert say(tender, "ask", what="lift")[0]["reason"] == status["refusals"]["lift"]
    say(tender, "reset")
    fly(tender, 0.1)
    assert tender.status()["ending"] is None


def test_a_flight_that_diverges_has_a_place_only_while_that_is_a_number(tender, monkeypatch):
    fly(tender, 0.1)
    stepper = tender.flight._stepper
    stepper.a[0] = math.nan
    fly(tender, 0.01)
    status = tender.status()
    assert status["phase"] == "diverged"
    assert status["ending"]["place"] is None
    assert "must be finite" in status["ending"]["text"]
