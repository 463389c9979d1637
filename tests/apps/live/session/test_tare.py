"""A tare of the force sensors in flight, and hands that are refused meanwhile."""

import threading

import pytest
from sessions import fly, say, up

import tandemlift as tl
from tandemlift.apps.live.session.checks import check_in_time
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.apps.live.session.parameters import ParameterControl
from tandemlift.missions import changed, tables_of


def test_hands_are_refused_while_the_sensors_are_tared(session, monkeypatch):
    mission = session.flight.now
    tared = mission.estimator.model_copy(update={"tare_start": 5.0, "tare_duration": 2.0})
    pilot = mission.pilot.model_copy(update={"push": "estimate"})
    assert session.status()["tare_left_s"] == 0.0
    session.flight.now = mission.model_copy(update={"estimator": tared, "pilot": pilot})
    assert session.status()["tare_left_s"] == pytest.approx(7.0 - session.flight.dt)  # one step is flown already
    with pytest.raises(tl.InputError, match="hands off until 7 s"):
        say(session, "grab", point=(0.0, 0.0, 0.0), target=(1.0, 0.0, 0.0), at="point")
    with pytest.raises(tl.InputError, match="hands off until 7 s"):
        say(session, "force", force=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    say(session, "force", force=(0.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    fly(session, 6.0)
    assert session.status()["tare_left_s"] == pytest.approx(1.0 - session.flight.dt)
    fly(session, 1.0)
    assert session.status()["tare_left_s"] == 0.0
    say(session, "grab", point=(0.0, 0.0, 0.0), target=(1.0, 0.0, 0.0), at="point")


@pytest.mark.parametrize(
    ("estimator", "push", "words"),
    [
        ({}, "truth", "uses no sensor that could be tared"),
        ({"tare": "hover"}, "estimate", "tares by itself, in steady hover"),
        ({}, "estimate", "the mission has none (estimator.tare_start)"),
    ],
)
def test_a_mission_without_a_tare_that_can_be_begun_says_so(session, estimator, push, words):
    up(session)
    now = session.flight.now
    told = {
        "estimator": now.estimator.model_copy(update=estimator),
        "pilot": now.pilot.model_copy(update={"push": push}),
    }
    session.flight.now = now.model_copy(update=told)
    with pytest.raises(tl.InputError) as refused:
        say(session, "tare")
    assert words in str(refused.value)


def test_a_tare_wants_hover_and_no_hand_and_begins_in_time(session):
    with pytest.raises(tl.InputError, match="only in the air, hovering; the phase is idle"):
        say(session, "tare")
    at = up(session)
    say(session, "grab", point=(0.0, 0.0, 0.0), target=tuple(map(float, at)), at="point")
    with pytest.raises(tl.InputError, match="hands off first"):
        say(session, "tare")
    with pytest.raises(tl.InputError, match="took too long"):
        check_in_time(session.flight, session.flight.step * session.flight.dt)


class Flown:
    """A flight whose mission tares, as far as the control sees it; making a change ready takes so many steps."""

    def __init__(self, takes):
        self.now, self.dt, self.step, self.takes = tl.load_mission("zigzag"), 0.001, 12_000, takes

    def prepare(self, key, value):
        self.step += self.takes
        return changed(self.now, key, value)

    def change(self, due, key, value):
        self.now = due


def test_a_tare_begins_a_second_after_it_was_asked_for_or_is_asked_for_again():
    control, flight, slow = (
        ParameterControl(tables_of(interactive_mission(tl.load_mission("zigzag"))), threading.RLock()),
        Flown(300),
        Flown(999),
    )
    assert control.tare(flight) == "from 13 s to 15 s"
    assert flight.now.estimator.tare_start == 13.0
    with pytest.raises(tl.InputError, match="took too long to prepare"):
        control.tare(slow)
    assert slow.now.estimator.tare_start == 5.0


def test_hands_are_refused_until_it_has_tared_by_itself_in_steady_hover(session):
    up(session)
    mission = session.flight.now
    estimator = mission.estimator.model_copy(update={"tare": "hover", "tare_duration": 2.0})
    pilot = mission.pilot.model_copy(update={"push": "estimate"})
    session.flight.now = mission.model_copy(update={"estimator": estimator, "pilot": pilot})
    until_tared = 2.0 - session.flight.number("memory", "guidance", "phase", "hover_time")
    assert session.status()["tare_left_s"] == pytest.approx(max(until_tared, 0.0), abs=1e-3)
    if until_tared > 0.0:
        with pytest.raises(tl.InputError, match="hands off until the force sensors are tared, in steady hover"):
            say(session, "force", force=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
        fly(session, until_tared + 0.01)
    say(session, "force", force=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
