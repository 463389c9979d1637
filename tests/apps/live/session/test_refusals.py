"""A session says why a lift, a landing or a push has no effect, to who asked and in its status."""

import pytest
from sessions import fly, say, seen, up

import tandemlift as tl
from tandemlift.apps.live.session.session import Session


def refused(answers):
    return [one["reason"] for one in answers if one["type"] == "refused"]


def test_in_the_air_a_lift_is_refused_and_a_landing_is_not(session):
    up(session)
    assert refused(say(session, "ask", what="lift")) == [session.status()["refusals"]["lift"]]
    assert "in the air already" in session.status()["refusals"]["lift"]
    assert session.status()["refusals"]["land"] == ""
    assert say(session, "ask", what="land") == []
    fly(session, 0.3)
    assert "landing, which cannot be cancelled" in session.status()["refusals"]["push"]


def test_a_disabled_pilot_says_that_it_does_not_follow(session):
    up(session)
    say(session, "enable", on=False)
    fly(session, 0.1)
    assert session.status()["refusals"]["push"].endswith("Let it follow again.")


def test_after_a_stop_everything_is_refused_until_the_flight_begins_again(session):
    up(session)
    assert say(session, "ask", what="stop") == []
    fly(session, 0.1)
    assert all("Begin the flight again." in text for text in session.status()["refusals"].values())
    assert refused(say(session, "ask", what="lift"))
    say(session, "reset")
    fly(session, 0.1)
    assert "final" not in session.status()["refusals"]["lift"]


def test_a_flight_at_its_end_refuses_everything(session, monkeypatch):
    monkeypatch.setattr(type(session.flight), "over", property(lambda flight: True))
    assert set(session.status()["refusals"].values()) >= {
        "Lift is refused: the flight is over. Begin the flight again."
    }


def test_before_the_first_step_nothing_is_said_to_be_refused(tmp_path):
    one = Session(tl.load_mission("hover"), out=tmp_path)
    assert set(one.status()["refusals"].values()) == {""}


@pytest.mark.thorough
def test_zigzag_pulled_against_a_wall_names_what_touches_it_and_then_why_it_does_not_lift(tmp_path):
    one = Session(tl.load_mission("zigzag"), out=tmp_path)
    one.prepare()
    fly(one, 8.0)
    (x, y, z) = map(float, seen(one)["position"])
    say(one, "grab", point=(0.0, 0.0, 0.0), target=(x, y + 3.0, z), at="point")
    told, phases, marked = set(), set(), set()
    for _ in range(120):
        fly(one, 0.05)
        status, frame = one.status(), seen(one)
        phases.add(status["phase"])
        assert "disagree" not in status["alarm"]
        if status["phase"] == "contact":
            told.add(status["refusals"]["push"])
        if frame["contact_part"]:
            marked.add(float(frame["contact_part"][0]))
            assert frame["contact_normal"] @ [0.0, -1.0, 0.0] > 0.7  # the wall is to the left
            assert frame["contact_point"][1] > y
    assert "contact" in phases
    assert marked
    assert any("touches a wall. Pull it away from the wall" in text for text in told)
    say(one, "release")
    say(one, "ask", what="land")
    fly(one, 12.0)
    assert one.status()["phase"] == "idle"
    refused_now = refused(say(one, "ask", what="lift"))
    fly(one, 1.0)
    assert one.status()["phase"] == "lift" or refused_now == [one.status()["refusals"]["lift"]]
    one.stop()
