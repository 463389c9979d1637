"""The life of a session: prepared, flown in a thread of its own, over, reset, saved."""

import threading

import numpy as np
import pytest
from patience import COMPILING, PATIENCE, until
from sessions import fly, say, seen, unprepared

import tandemlift as tl
from tandemlift.apps.live.session.frames import read_frames
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.apps.live.session.page_messages import PAGE_MESSAGES, CompareMessage, PingMessage, TurnMessage
from tandemlift.apps.live.session.session import Session
from tandemlift.compiler.machine_code import code
from tandemlift.core.caching import LastUsed
from tandemlift.missions import changed


def test_a_flight_that_is_over_says_so_and_changes_no_more(session):
    session.flight._p.steps = session.flight.step + 10
    fly(session, 0.01)
    session._fly(5)
    assert session.status()["phase"] == "over"
    with pytest.raises(tl.InputError, match="the flight is over; reset it first"):
        say(session, "set", key="admittance.mass", value=5.0)


def test_a_session_handles_every_message_of_a_page_that_the_server_does_not_answer_itself():
    handled = set(Session.__dict__["_handle"].dispatcher.registry)
    assert set(PAGE_MESSAGES.values()) - handled == {
        PingMessage,
        TurnMessage,
        CompareMessage,
    }  # the last: by TwoFlights


def test_an_error_in_flight_is_told(session, monkeypatch):
    def fail():
        raise RuntimeError("of a controller")

    session.flight.advance = fail
    session.start()
    until(lambda: session.status()["phase"] == "failed")
    say(session, "reset")
    until(lambda: session.status()["recorded_s"] > 0.1)
    assert session.status()["phase"] != "failed"


def test_what_was_flown_is_saved_under_its_name_and_flies_again_and_a_session_of_it_by_hand(session, tmp_path):
    fly(session, 2.0)
    answer = say(session, "save", name="mine")
    assert answer == [{"type": "done", "what": "save", "detail": str(tmp_path / "mine")}]
    recorded = tl.load_mission(tmp_path / "mine" / "recorded.toml")
    flown = tl.Flight.load(tmp_path / "mine" / "flight.npz")
    np.testing.assert_array_equal(tl.fly(recorded)["position"], flown["position"])
    by_hand = interactive_mission(changed(recorded, "requests", [{"time": 20.0, "action": "land"}]))
    assert (by_hand.person.model, by_hand.person.recording, by_hand.changes) == ("virtual-hand", None, ())
    assert by_hand.requests == ()


def test_before_it_is_compiled_the_vehicle_is_seen_where_it_will_begin(tmp_path):
    one = unprepared(tmp_path, **{"initial.position": [1.0, 2.0, 0.0]})
    assert one.status()["phase"] == "preparing"
    before, controls = seen(one), one.scene["parameters"]
    one.prepare()
    assert one.status()["phase"] != "preparing"
    for field in ("position", "attitude", "velocity"):
        np.testing.assert_array_equal(before[field], seen(one)[field], err_msg=field)
    assert one.scene["parameters"] == controls
    one.stop()


def test_before_it_is_compiled_nothing_is_heeded_and_a_hand_that_goes_does_no_harm(tmp_path):
    one = unprepared(tmp_path)
    one.release()
    for kind, what in {"reset": {}, "pause": {"on": True}, "save": {"name": "mine"}}.items():
        with pytest.raises(tl.InputError, match="the flight is still being prepared"):
            say(one, kind, **what)
    one.stop()


def test_a_flight_that_cannot_be_compiled_says_why_and_is_not_flown(tmp_path, monkeypatch, caplog):
    def fail(*_):
        raise tl.InputError("law.py:3 branches on data")

    monkeypatch.setattr("tandemlift.apps.live.session.session.RecordedFlight", fail)
    one = unprepared(tmp_path)
    one.start()
    until(lambda: one.status()["phase"] == "failed")
    assert one.status()["preparing"]["failure"] == "law.py:3 branches on data"
    with pytest.raises(tl.InputError, match=r"cannot be flown: law\.py:3 branches on data"):
        say(one, "reset")
    assert "law.py:3" in caplog.text
    assert len(one.frame()) > 0
    one.stop()


def test_a_session_that_still_compiles_is_stopped_at_once(tmp_path, monkeypatch):
    compiles, goes_on = threading.Event(), threading.Event()

    def compile_for_long(*_):
        compiles.set()
        goes_on.wait(PATIENCE)
        raise tl.InputError("nobody waits for this")

    monkeypatch.setattr("tandemlift.apps.live.session.session.RecordedFlight", compile_for_long)
    one = unprepared(tmp_path)
    one.start()
    assert compiles.wait(PATIENCE)
    one.stop()  # which does not wait for what is compiled
    goes_on.set()
    one._thread.stop(wait=True)


@pytest.mark.thorough
def test_optimised_code_takes_over_while_it_flies(tmp_path, monkeypatch):
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tandemlift.simulation.plan.LOOP_CODE", LastUsed(8))
    monkeypatch.setattr(code, "optimise_in_process", lambda text, *_: code.machine.compiled(text, code.machine.QUICK))
    one = unprepared(tmp_path)
    one.start()
    until(lambda: one.is_ready and one.flight._stepper.code.is_best, patience=COMPILING)
    then = one.flight.step
    until(lambda: one.flight.step > then + 100)
    assert not one.flight.lost
    one.stop()


def test_the_thread_flies_until_it_is_stopped_and_pauses(session):
    session.start()
    until(lambda: session.status()["recorded_s"] > 0.2)
    say(session, "pause", on=True)
    then, rests = session.status()["recorded_s"], []
    session.flight.rest = lambda: rests.append(None)
    until(lambda: len(rests) > 20)
    assert session.status()["recorded_s"] == then
    say(session, "pause", on=False)
    until(lambda: session.status()["recorded_s"] > then)


def test_a_body_that_waits_is_told_of_a_pause(session):
    class Waiting:
        rests = 0

        def rest(self):
            self.rests += 1

    session.start()
    say(session, "pause", on=True)
    session.flight._stepper.body = body = Waiting()
    until(lambda: body.rests > 3)


def test_a_page_that_joins_gets_the_frames_that_others_saw_in_the_last_seconds(session):
    fields, shown = tuple((name, count) for name, count in session.scene["fields"]), {}
    for _ in range(240):  # 24 s
        fly(session, 0.1)
        if session.flight.step * session.flight.dt > 1.0:
            say(session, "force", force=(0.5, 0.0, 0.0), point=(0.0, 0.0, 0.0))
        frame = seen(session)
        shown[round(float(frame["time"].item()), 3)] = frame
    past = read_frames(fields, b"".join(session.past()))
    time = past["time"].ravel()
    assert np.diff(time) == pytest.approx(0.05, abs=1e-5)  # as the page keeps them
    assert time[-1] - time[0] == pytest.approx(20.0, abs=1e-4)
    assert time[-1] == seen(session)["time"]
    among = [i for i, t in enumerate(time) if round(float(t), 3) in shown]
    assert len(among) > 100
    for name in ("position", "attitude", "push", "reference", "disturbance", "thrusts"):
        np.testing.assert_array_equal(past[name][among], [shown[round(float(time[i]), 3)][name] for i in among])
    assert past["push"][-1] == pytest.approx([0.5, 0.0, 0.0], abs=1e-3)


def test_before_a_flight_is_compiled_there_is_no_past(tmp_path):
    assert unprepared(tmp_path).past() == []
