"""What viewers are told, and what becomes of their messages."""

import contextlib
import itertools
import json
import threading

from live_page import Running, put_page
from patience import PATIENCE, until
from standin import StandIn
from websockets.exceptions import ConnectionClosed

from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.server import PageServer
from tandemlift.apps.live.session.frames import pack_frames, read_frames

MASS = {"type": "set", "key": "admittance.mass", "value": [2.0]}


def test_a_viewer_is_told_the_scene_then_frames_then_the_status(live):
    with live.viewer() as viewer:
        assert viewer.scene == json.loads(json.dumps({"type": "scene", **live.flight.scene}))
        frame = read_frames(live.flight.fields, viewer.frame())
        assert frame["attitude"].tolist() == [[1.0, 0.0, 0.0, 0.0]]
        status = viewer.text("status")
        assert (status["viewers"], status["holder"], status["phase"]) == (1, "none", "guided")


def test_a_page_that_joins_late_is_told_the_past_before_what_is_new(live, monkeypatch):
    past = [pack_frames(live.flight.fields, {"time": t / 20.0 - 100.0}).tobytes() for t in range(400)]
    monkeypatch.setattr(live.flight, "past", lambda: past)
    with live.viewer(), live.viewer() as late:
        assert [late.frame() for _ in past] == past
        assert read_frames(live.flight.fields, late.frame())["time"].item() >= 0.0


def test_time_goes_on_from_frame_to_frame(live):
    times = []
    with live.viewer() as viewer:

        def goes_on():
            times.append(read_frames(live.flight.fields, viewer.frame())["time"].item())
            return len(times) >= 30 and times[-1] > times[0]

        until(goes_on)
    assert all(a <= b for a, b in itertools.pairwise(times))


def test_a_ping_is_echoed(live):
    with live.viewer() as viewer:
        viewer.say(type="ping", t=12.5)
        assert viewer.text("pong") == {"type": "pong", "t": 12.5}


def test_a_change_is_told_to_all_and_a_refusal_to_the_one_who_asked(live):
    with live.viewer() as one, live.viewer() as two:
        one.say(type="set", key="plant.mass_scale", value=2.0)
        refused = one.text("refused")
        assert refused["what"] == "set plant.mass_scale"
        assert "cannot be changed in flight" in refused["reason"]
        one.say(**MASS)
        assert one.text("changed")["value"] == [2.0]
        assert two.text("changed") == {"type": "changed", "key": "admittance.mass", "value": [2.0], "duration": 0.5}


def test_all_that_is_restored_is_told_to_all(live):
    with live.viewer() as one, live.viewer() as two:
        one.say(type="restore")
        for viewer in (one, two):
            assert [viewer.text("changed")["key"] for _ in range(2)] == ["admittance.mass", "admittance.damping"]


def test_an_answer_goes_to_the_one_who_asked(live):
    with live.viewer() as one:
        one.say(type="save", name="mine")
        assert one.text("done")["detail"] == "mine"


def test_a_bad_message_is_refused_with_key_value_and_what_is_allowed(live):
    with live.viewer() as viewer:
        viewer.say(type="speed", factor=3)
        assert viewer.text("refused") == {
            "type": "refused",
            "what": "speed",
            "reason": "speed.factor = 3: must be a number ≥ 0.1 and ≤ 1",
        }


def test_after_a_reset_all_are_told_the_scene_again_and_nobody_holds(live):
    with live.viewer() as one, live.viewer() as two:
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        two.say(type="reset")
        assert one.text("scene")["mission"] == two.text("scene")["mission"] == "hover"
        one.text("status", holder="none")
        until(lambda: not live.flight.held)


def test_an_error_of_the_flight_is_told_and_serving_goes_on(live, monkeypatch, caplog):
    monkeypatch.setattr(live.flight, "_applied", lambda message: 1 / 0)
    with live.viewer() as viewer:
        viewer.grab(0.0, 0.0, 0.0)
        assert "ZeroDivisionError" in viewer.text("refused")["reason"]
        assert viewer.frame()
    assert "grab failed" in caplog.text


def test_the_hand_does_not_wait_for_a_change_that_takes_long(start):
    go = threading.Event()
    flight = StandIn(wait=go)
    server = start(flight)
    with server.viewer() as viewer, server.viewer() as other:
        viewer.say(**MASS)
        viewer.grab(1.0, 0.0, 0.0)
        until(lambda: flight.held)
        other.text("status", holder="other")
        assert [m.type for m in flight.heard] == ["grab"]
        go.set()
        other.text("changed", key="admittance.mass")


def test_changes_that_wait_are_made_in_order_and_not_too_many(start):
    go = threading.Event()
    flight = StandIn(wait=go)
    server = start(flight)
    with server.viewer() as viewer:
        for i in range(20):
            viewer.say(**{**MASS, "value": [float(i)]})
        assert "16 changes are waiting already" in viewer.text("refused")["reason"]
        go.set()
        for i in range(16):
            assert viewer.text("changed")["value"] == [float(i)]


def test_stopping_says_goodbye_and_ends_the_flight(tmp_path, monkeypatch):
    monkeypatch.setattr("tandemlift.apps.live.server.FAREWELL", PATIENCE)
    flight = StandIn()
    server = Running(PageServer(page_files(put_page(tmp_path / "page")), flight, port=0))
    with server.viewer() as viewer:
        server.stop()
        with contextlib.suppress(ConnectionClosed):
            while viewer.frame():
                pass
        assert viewer.connection.close_code == 1001
    steps = flight.steps
    assert not flight._thread.is_alive()
    assert flight.steps == steps
