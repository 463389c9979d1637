"""A flight that is rewound: it stands where it was to the last bit, is pushed anew, and what is saved flies again."""

import numpy as np
import pytest
from own_flight import check_done, check_flies_again
from sessions import fly, say, seen

import tandemlift as tl

pytestmark = pytest.mark.thorough

GRAB = {"point": (0.1, 0.4, 0.0), "target": (0.3, 0.2, 1.2), "at": "point"}
PAST = (
    ("grab", GRAB, 0.7),
    ("set", {"key": "admittance.mass", "value": 2.5}, 0.2),
    ("move", {"target": (0.5, -0.4, 1.3)}, 0.4),
    ("set", {"key": "person.stiffness", "value": 9.0}, 0.9),
)
FUTURE = (
    ("release", {}, 0.5),
    ("set", {"key": "admittance.mass", "value": 0.8}, 0.4),
    ("restore", {}, 0.3),
)
ANEW = (
    ("force", {"force": (0.0, 1.5, 0.0), "point": (0.0, 0.0, 0.0)}, 0.6),
    ("set", {"key": "admittance.damping", "value": 4.0}, 0.5),
)
OF_THE_HAND = {"held", "hand_point", "hand_target", "seq"}


def do(session, moves):
    for kind, what, seconds in moves:
        say(session, kind, **what)
        fly(session, seconds)


def check_stands_as_before(now, before):
    assert now.keys() == before.keys()
    for name in before.keys() - OF_THE_HAND:
        np.testing.assert_array_equal(now[name], before[name], name)
    assert now["held"] == 0.0


def test_a_session_stands_at_the_chosen_time_as_it_was_and_what_is_saved_is_the_new_flight(session, tmp_path):
    do(session, PAST)
    before, parameters = seen(session), session.scene["parameters"]
    do(session, FUTURE)
    generation = session.generation
    say(session, "rewind", time=float(before["time"][0]))
    check_stands_as_before(seen(session), before)
    assert session.scene["parameters"] == parameters
    assert session.pacer.paused
    assert session.generation > generation  # all pages get the scene, and let go
    do(session, ANEW)
    say(session, "save", name="anew")
    check_flies_again(tmp_path / "anew" / "recorded.toml", session.flight.sample)


def test_a_page_without_a_server_does_the_same(flight, tmp_path):
    check_done(flight, PAST)
    before = flight.seen()
    check_done(flight, FUTURE)
    (scene,) = flight.say("rewind", time=float(before["time"][0]))
    assert [one["value"] for one in scene["parameters"] if one["key"] == "admittance.mass"] == [[2.5, 2.5, 2.5]]
    flight.fly(0.1)
    check_stands_as_before(flight.seen(), before)
    assert flight.status()["paused"]
    flight.say("pause", on=False)
    check_done(flight, ANEW)
    last = flight.saved(tmp_path / "page")
    check_flies_again(tmp_path / "page" / "recorded.toml", last)


def test_a_flight_whose_body_others_may_push_cannot_be_flown_again(session):
    session._engine = "gazebo"
    with pytest.raises(tl.InputError, match="rewind: others may push the body in gazebo"):
        say(session, "rewind", time=0.5)
