"""A page's own flight does what a session of the server does: the same bits, the same answers, the same refusals."""

import json
import re

import numpy as np
import pytest
from own_flight import OwnFlight
from sessions import fly

import tandemlift as tl
from tandemlift.apps.live.page_modules import MISSIONS, packed_flight, page_mission
from tandemlift.apps.live.session.page_messages import read_message
from tandemlift.apps.live.session.parameters import BY_KEY
from tandemlift.apps.live.session.session import Session

GRAB = {"type": "grab", "point": [0.1, 0.4, 0.0], "target": [0.3, 0.2, 1.2], "at": "point"}
MOVES = (  # messages, and for how long the flight goes on after each [s]
    (GRAB, 0.25),
    ({"type": "move", "target": [0.5, 0.1, 1.3]}, 0.1),
    ({"type": "set", "key": "admittance.mass", "value": 2.5}, 0.2),
    ({"type": "set", "key": "admittance.mass", "value": [0.7, 3.0, 1.1]}, 0.111),
    ({"type": "set", "key": "wind.velocity", "value": [3.0, -2.0, 0.0]}, 0.3),
    ({"type": "set", "key": "person.stiffness", "value": 9.0}, 0.6),
    ({"type": "release"}, 0.1),
    ({"type": "restore", "key": "admittance.mass"}, 0.05),
    ({**GRAB, "at": "centre", "target": [0.0, 0.0, 0.8]}, 0.2),
    ({"type": "force", "force": [1.5, 0.0, -0.5], "point": [0.0, 0.2, 0.0]}, 0.3),
    ({"type": "force", "force": [1.0, 0.5, 0.0], "point": [0.0, 0.9, 0.0], "frequency": 3.5}, 0.4),
    ({"type": "force", "force": [0.0, 2.0, 0.0], "point": [0.0, 0.9, 0.0], "frequency": 3.5}, 0.3),
    ({"type": "force", "force": [0.0, 2.0, -1.0], "point": [0.0, 0.0, 0.0], "duration": 0.05}, 0.3),
    ({"type": "restore"}, 0.7),
    ({"type": "force", "force": [0.0, 0.0, 0.0], "point": [0.0, 0.0, 0.0]}, 0.1),
    ({"type": "kill", "rotor": 2}, 0.5),
    ({"type": "reset"}, 0.2),
    (GRAB, 0.3),
)
REFUSED = (
    {"type": "grab", "point": [0.0, 9.0, 0.0], "target": [0.0, 0.0, 1.0], "at": "point"},
    {"type": "grab", "point": [0.0, 1.5e4, 0.0], "target": [0.0, 0.0, 1.0], "at": "point"},
    {"type": "move", "target": [0.0, -20000, 0.5]},
    {"type": "force", "force": [0.0, 2000.5, 0.0], "point": [0.0, 0.0, 0.0]},
    {"type": "force", "force": [1.0, 0.0, 0.0], "point": [3.0, 0.25, -1e-7]},
    {"type": "force", "force": [1.0, 0.0, 0.0], "point": [0.0, 0.0, 0.0], "frequency": 11.5},
    {"type": "force", "force": [1.0, 0.0, 0.0], "point": [0.0, 0.0, 0.0], "duration": -0.5},
    {"type": "set", "key": "mission.step", "value": 0.1},
    {"type": "set", "key": "person.stiffness", "value": True},
    {"type": "set", "key": "person.stiffness", "value": "much"},
    {"type": "set", "key": "person.stiffness", "value": [4.0, 5.0]},
    {"type": "set", "key": "person.stiffness", "value": 1e13},
    {"type": "speed", "factor": 3},
    {"type": "speed", "factor": 0.05},
    {"type": "kill", "rotor": 300},
    {"type": "kill", "rotor": 77},
    {"type": "save", "name": "../mine"},
    {"type": "save", "name": ""},
    {"type": "save", "name": "x" * 80},
)

ABSENT = (  # what only a guided mission, or one whose rotors may fail, has
    {"type": "ask", "what": "lift"},
    {"type": "enable", "on": False},
    {"type": "kill", "rotor": 1},
)


def wrong_values(scene):
    """Settings out of bounds or of other shapes, and a setting of each parameter that a mission does not have."""
    present = {one["key"] for one in scene["parameters"]}
    for key, parameter in BY_KEY.items():
        if key not in present:
            yield {"type": "set", "key": key, "value": parameter.high}
            continue
        short = [parameter.high] if parameter.low < 0.0 else []  # what may be negative has a direction
        for value in (parameter.low - 1.0, parameter.high * 1.5, *short, [parameter.high] * 2, [parameter.high] * 7):
            yield {"type": "set", "key": key, "value": value}


def as_a_browser_sends(value):
    """Numbers without a fraction as whole ones: JSON of a browser knows no other."""
    if isinstance(value, dict):
        return {key: as_a_browser_sends(one) for key, one in value.items()}
    if isinstance(value, list):
        return [as_a_browser_sends(one) for one in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


def answers_of(session, message):
    """What a session answers to a message, refusals among it; without the scene."""
    try:
        answers = session.apply(read_message(json.dumps(as_a_browser_sends({**message, "seq": 1}))))
    except tl.InputError as error:
        return plain(str(error))
    return plain(worded([one for one in answers if one["type"] != "scene"], message))


def worded(answers, message):
    """Answers; the reason alone if the message is refused."""
    refused = answers and answers[0]["type"] == "refused" and message["type"] != "restore"
    return answers[0]["reason"] if refused else answers


NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def plain(said):
    """What was said, with numbers in its texts as Python and JavaScript write them alike."""
    if isinstance(said, dict):
        return {key: plain(one) for key, one in said.items()}
    if isinstance(said, list):
        return [plain(one) for one in said]
    if not isinstance(said, str):
        return said
    return NUMBER.sub(lambda match: f"{float(match[0]):g}", said.replace(", ", ","))


def said_by(flight, message):
    """The same of a page's own flight."""
    kind, rest = message["type"], {name: value for name, value in message.items() if name != "type"}
    return plain(worded([one for one in flight.say(kind, **rest) if one["type"] != "scene"], message))


def frames_flown(session, seconds, times):
    """Fly a session; its frame after each step, and its status at the given times [s], by the time in them."""
    frames, statuses = {}, {}
    for _ in range(round(seconds / session.flight.dt)):
        fly(session, session.flight.dt)
        frame = session.frame()
        frames[frame[:4]] = frame
        if round(session.flight.step * session.flight.dt, 3) in times:  # a status takes long
            status = session.status()
            statuses[status["recorded_s"]] = untimed(status)
    return frames, statuses


CLOCKED = {"findings", "factor", "behind_ms", "viewers", "holder", "last_grab", "type"}  # by clock and server


def untimed(status):
    """What a status says of the flight itself; its score is of sums, which are formed in another order."""
    score = {name: round(x, 9) if isinstance(x, float) else x for name, x in (status.get("score") or {}).items()}
    return {name: plain(value) for name, value in status.items() if name not in CLOCKED} | {"score": score}


def check_same(session, flight, message, seconds):
    """Send a message to both and let both fly on; they answer and show the same."""
    assert said_by(flight, message) == answers_of(session, message), message
    flight.fly(seconds)
    told = [one for one in flight.said if one["type"] == "status"]
    frames, statuses = frames_flown(session, seconds, {status["recorded_s"] for status in told})
    shown = [bytes.fromhex(one["values"]) for one in flight.said if one["type"] == "frame"]
    assert shown
    for frame in shown:
        assert frame == frames.get(frame[:4]), (message, np.frombuffer(frame, "<f4")[0])
    for status in told:
        assert untimed(status) == statuses[status["recorded_s"]], message


@pytest.mark.thorough
def test_it_flies_and_answers_as_a_session_to_the_last_bit(session, flight, tmp_path):
    for message, seconds in MOVES:
        check_same(session, flight, message, seconds)
    last = flight.saved(tmp_path / "page")
    np.testing.assert_array_equal(last.view(np.int64), session.flight.sample.view(np.int64))


@pytest.mark.thorough
def test_every_refusal_is_that_of_a_session(session, flight):
    for message in [*REFUSED, *ABSENT, *wrong_values(session.scene)]:
        refused = answers_of(session, message)
        assert isinstance(refused, str), message
        assert said_by(flight, message) == refused


@pytest.mark.thorough
def test_requests_are_refused_for_the_same_reasons_from_the_ground_to_the_air_and_back(by_hand):
    session, flight = by_hand
    lift, land = ({"type": "ask", "what": what} for what in ("lift", "land"))
    seen = set()
    for message, seconds in (
        (land, 0.3),
        (lift, 1.0),
        (GRAB, 1.0),
        ({"type": "release"}, 2.0),
        (lift, 0.3),
        ({"type": "force", "force": [0.2, 0.0, 0.0], "point": [0.0, 0.0, 0.0]}, 0.6),
        ({"type": "force", "force": [0.0, 0.0, 0.0], "point": [0.0, 0.0, 0.0]}, 0.1),
        ({"type": "enable", "on": False}, 0.6),
        (land, 0.6),
        (lift, 0.3),
        ({"type": "ask", "what": "stop"}, 0.6),
        (lift, 0.3),
    ):
        check_same(session, flight, message, seconds)
        seen |= {text for one in flight.said if one["type"] == "status" for text in one["refusals"].values()}
    told = " ".join(seen)
    for part in (
        "on the ground already",
        "in the air already",
        "below the threshold (0.",
        "Let it follow again.",
        "final",
    ):
        assert part in told, part


@pytest.mark.thorough
def test_a_crash_ends_both_with_the_same_words_at_the_same_place_until_both_begin_again(by_hand):
    session, flight = by_hand
    check_same(session, flight, {"type": "ask", "what": "lift"}, 3.0)
    strong_push = {"type": "force", "force": [4.0, 0.0, 0.0], "point": [0.0, 0.0, 0.0]}
    check_same(session, flight, strong_push, 1.5)
    status = flight.status()
    assert status["phase"] == "crashed"
    assert "tilt [deg] = 6.8" in status["ending"]["text"]
    assert status["ending"]["place"] == session.status()["ending"]["place"]
    check_same(session, flight, {"type": "ask", "what": "lift"}, 0.3)
    assert "crashed" in flight.status()["refusals"]["push"]
    for one in (session.status(), flight.status()):
        assert one["refusals"]["lift"].endswith("Begin the flight again.")
    flight.say("reset")
    flight.fly(0.5)
    assert flight.status()["ending"] is None
    assert flight.status()["phase"] == "idle"


@pytest.mark.thorough
def test_a_fall_says_in_both_what_was_hit_and_how_hard_in_three_digits(by_hand):
    session, flight = by_hand
    for what, seconds in (("lift", 3.0), ("stop", 1.5)):
        check_same(session, flight, {"type": "ask", "what": what}, seconds)
    assert re.search(r"hit the floor: \d+(\.\d+)? of 7 N s$", flight.status()["ending"]["text"])


def test_what_only_a_server_has_is_refused_with_a_reason(flight):
    for message in ({"type": "tare"}, {"type": "set", "key": "controller.name", "value": "pd"}):
        assert "only a flight of `tandemlift live` has it" in said_by(flight, message)


@pytest.mark.targets
@pytest.mark.parametrize("name", MISSIONS[1:])
def test_other_missions_fly_and_refuse_as_a_session_too(name, tmp_path):
    session, flight = Session(page_mission(name), out=tmp_path), OwnFlight(packed_flight(name))
    session.prepare()
    lift = {"type": "ask", "what": "lift"}
    for message in [GRAB, lift, *REFUSED, *wrong_values(session.scene)]:
        assert said_by(flight, message) == answers_of(session, message)
    check_same(session, flight, lift, 14.0)
    for message, seconds in MOVES:
        check_same(session, flight, message, seconds)
    last = flight.saved(tmp_path / "page")
    np.testing.assert_array_equal(last.view(np.int64), session.flight.sample.view(np.int64))
    flight.close()
    session.stop()
