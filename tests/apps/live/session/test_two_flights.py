"""A ghost under the same hand: each flight is bit-identical to one that flies alone with its settings."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from patience import PATIENCE
from sessions import GUIDED

import tandemlift as tl
from tandemlift.apps.live.page_modules import page_mission
from tandemlift.apps.live.session.page_messages import (
    CompareMessage,
    ForceMessage,
    ResetMessage,
    RewindMessage,
    SetMessage,
)
from tandemlift.apps.live.session.two_flights import TwoFlights
from tandemlift.simulation.recorded_flight import RecordedFlight

DAMPING = "admittance.damping"
HOVERS = 2500  # steps, after which it does


@pytest.fixture(scope="module")
def flown():
    one = TwoFlights(page_mission("hover", GUIDED | {"phases.lift_start": 0.0, "phases.lift_duration": 1.0}))
    one.prepare()
    yield one
    one.stop()


@pytest.fixture
def session(flown):
    """A flight that begins anew."""
    flown.apply(ResetMessage(seq=1))
    return flown


def push(session, force, steps):
    session.apply(ForceMessage(seq=1, point=(0.0, 0.0, 0.0), force=force))
    session._fly(steps)


def alone(flight):
    """The last sample of a flight by itself, with the same hand and changes."""
    again = RecordedFlight(flight.start)
    again.repeat(flight, flight.step)
    return again.sample


@pytest.fixture
def frames_while_flown_again(session, monkeypatch):
    """How many frames a page got while flights were flown again."""
    frames, flown_again = [], session._flown_again
    with ThreadPoolExecutor(1) as a_page:

        def watched(past, steps):
            frames.append(a_page.submit(session.frame).result(PATIENCE))
            return flown_again(past, steps)

        monkeypatch.setattr(session, "_flown_again", watched)
        yield frames


@pytest.mark.thorough
def test_a_ghost_keeps_its_settings_and_feels_the_same_hand(session, frames_while_flown_again):
    assert "ghost" not in session.scene
    session._fly(HOVERS)
    push(session, (0.0, 1.0, 0.0), 500)
    session.apply(CompareMessage(seq=2, what="keep"))
    session.apply(SetMessage(seq=3, key=DAMPING, value=(12.0, 12.0, 12.0)))
    push(session, (1.0, 0.0, 0.0), 1500)
    own, ghost = session._flight, session._ghost
    assert own.step == ghost.step
    assert not np.array_equal(own.sample, ghost.sample)
    for one in (own, ghost):
        np.testing.assert_array_equal(alone(one), one.sample)
    assert len(session.frame()) == 2 * len(session._frames.frame(session._values()))
    seen = session.scene
    value = {p["key"]: p["value"] for p in seen["parameters"]}[DAMPING]
    kept = {p["key"]: p["value"] for p in seen["ghost"]["parameters"]}[DAMPING]
    assert value == pytest.approx([12.0] * 3) != kept
    assert session.status()["ghost"] == ""
    session.apply(CompareMessage(seq=4, what="swap"))
    assert (session._flight, session._ghost) == (ghost, own)
    session._fly(100)
    assert own.step == ghost.step
    session.apply(RewindMessage(seq=5, time=(HOVERS + 800) * own.dt))
    assert session._flight.step == session._ghost.step == HOVERS + 801
    assert len(frames_while_flown_again) == 3  # to keep the ghost, and for both flights from here
    session.apply(ResetMessage(seq=6))
    session._fly(100)
    assert session._flight.step == session._ghost.step == 101
    assert session._ghost.now.admittance.damping[0] == pytest.approx(12.0)
    session.apply(CompareMessage(seq=7, what="end"))
    assert "ghost" not in session.scene


@pytest.mark.thorough
def test_settings_that_are_changed_during_a_pause_are_those_of_the_ghost(session):
    session._fly(200)
    session.apply(SetMessage(seq=1, key=DAMPING, value=(9.0, 9.0, 9.0)))
    session.apply(CompareMessage(seq=2, what="keep"))
    session._fly(500)
    np.testing.assert_array_equal(session._ghost.sample, session._flight.sample)


@pytest.mark.thorough
def test_a_flight_in_gazebo_has_no_ghost(session, monkeypatch):
    monkeypatch.setattr(session, "_engine", "gazebo")
    with pytest.raises(tl.InputError, match="compare: others may push the body in gazebo"):
        session.apply(CompareMessage(seq=1, what="keep"))
