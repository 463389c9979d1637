"""Two flights under one hand, in the worker: each flies, bit for bit, as it would alone with its own settings."""

import numpy as np
import pytest
from own_flight import OwnFlight, check_done, check_flies_again

from tandemlift.apps.live.page_modules import packed_mission, page_mission

pytestmark = pytest.mark.thorough

BEFORE = (
    ("force", {"force": (0.0, 1.2, 0.0), "point": (0.0, 0.0, 0.0)}, 0.6),
    ("set", {"key": "person.stiffness", "value": 8.0}, 0.3),
    ("force", {"force": (0.0, 0.0, 0.0), "point": (0.0, 0.0, 0.0)}, 0.4),
)
AFTER = (
    ("grab", {"point": (0.1, 0.4, 0.0), "target": (0.4, 0.3, 1.2), "at": "point"}, 0.7),
    ("move", {"target": (0.5, -0.4, 1.3)}, 0.8),
    ("release", {}, 0.5),
    ("force", {"force": (1.5, 0.0, 0.0), "point": (0.0, 0.0, 0.0)}, 0.9),
)
DAMPING = ("set", {"key": "admittance.damping", "value": 9.0}, 0.0)
MASS = ("set", {"key": "admittance.mass", "value": 3.0}, 0.0)


@pytest.fixture
def opened():
    """Opens flights, and closes them."""
    flights = []

    def one(packed):
        flights.append(OwnFlight(packed))
        return flights[-1]

    yield one
    for flight in flights:
        flight.close()


def alone(flight, *moves, folder):
    """The last sample of a flight that nothing goes along with."""
    check_done(flight, moves)
    return flight.saved(folder)


def both(flight, folder):
    """The last samples of a flight and of its ghost, each saved by itself; after it they have changed places."""
    own = flight.saved(folder / "own")
    flight.say("compare", what="swap")
    return own, flight.saved(folder / "ghost")


def check_same_bits(a, b):
    np.testing.assert_array_equal(a.view(np.int64), b.view(np.int64))


def test_flight_and_ghost_end_as_each_would_alone_under_the_same_hand(opened, hover, tmp_path):
    flight = opened(hover)
    check_done(flight, BEFORE)
    (scene,) = flight.say("compare", what="keep")
    assert scene["ghost"]["mission"] == "hover"
    assert scene["ghost"]["parameters"] == scene["parameters"]
    check_done(flight, (DAMPING, MASS, *AFTER))
    own, ghost = both(flight, tmp_path)
    check_same_bits(own, alone(opened(hover), *BEFORE, DAMPING, MASS, *AFTER, folder=tmp_path / "a"))
    check_same_bits(ghost, alone(opened(hover), *BEFORE, *AFTER, folder=tmp_path / "b"))
    assert np.abs(own - ghost).max() > 0.01
    check_flies_again(tmp_path / "own" / "recorded.toml", own)
    check_flies_again(tmp_path / "ghost" / "recorded.toml", ghost)


def test_a_frame_has_the_ghost_at_the_same_time_and_where_it_will_be_saved(opened, hover, tmp_path):
    flight = opened(hover)
    check_done(flight, BEFORE)
    flight.say("compare", what="keep")
    check_done(flight, (DAMPING, *AFTER))
    now, ghost = flight.seen(), flight.seen(1)
    assert now["time"] == ghost["time"]
    assert np.abs(now["position"] - ghost["position"]).max() > 0.01
    flight.say("compare", what="swap")
    flight.fly(0.02)
    for seen, before in ((flight.seen(), ghost), (flight.seen(1), now)):
        np.testing.assert_allclose(seen["position"], before["position"], atol=0.02)
    flight.say("compare", what="end")
    flight.fly(0.1)
    with pytest.raises(IndexError):
        flight.seen(1)


def test_both_are_rewound_to_one_moment_and_go_on_from_it(opened, hover, tmp_path):
    flight = opened(hover)
    check_done(flight, BEFORE)
    flight.say("compare", what="keep")
    check_done(flight, (DAMPING, *AFTER[:1]))
    before = flight.seen(), flight.seen(1)
    check_done(flight, AFTER[1:])
    (scene,) = flight.say("rewind", time=float(before[0]["time"][0]))
    assert "ghost" in scene
    flight.fly(0.1)
    for now, then in zip((flight.seen(), flight.seen(1)), before, strict=True):
        np.testing.assert_array_equal(now["time"], then["time"])
        np.testing.assert_array_equal(now["position"], then["position"])
    flight.say("pause", on=False)
    check_done(flight, AFTER)
    assert flight.seen()["time"] == flight.seen(1)["time"] > before[0]["time"]
    for name, last in zip(("own", "ghost"), both(flight, tmp_path), strict=True):
        check_flies_again(tmp_path / name / "recorded.toml", last)


def test_both_begin_again_each_with_its_settings(opened, hover, tmp_path):
    flight = opened(hover)
    check_done(flight, BEFORE)
    flight.say("compare", what="keep")
    check_done(flight, (DAMPING, *AFTER[:2]))
    flight.say("reset")
    check_done(flight, AFTER)
    own, ghost = both(flight, tmp_path)
    damped = opened(hover)
    check_done(damped, (*BEFORE[1:2], DAMPING))
    damped.say("reset")
    check_same_bits(own, alone(damped, *AFTER, folder=tmp_path / "a"))
    stiff = opened(hover)
    check_done(stiff, BEFORE[1:2])
    stiff.say("reset")
    check_same_bits(ghost, alone(stiff, *AFTER, folder=tmp_path / "b"))


@pytest.fixture(scope="module")
def by_pid():
    """The same mission by another controller."""
    return packed_mission(page_mission("hover", {"mission.name": "pid"}, "pid"), "by PID")


def test_another_controller_of_the_page_flies_along_from_the_start(opened, hover, by_pid, tmp_path):
    flight = opened(hover)
    check_done(flight, BEFORE)
    (scene,) = flight.along(by_pid)
    assert (scene["mission"], scene["ghost"]["mission"]) == ("hover", "pid")
    check_done(flight, AFTER)
    own, ghost = both(flight, tmp_path)
    stiff = opened(hover)
    check_done(stiff, BEFORE)
    stiff.say("reset")
    check_same_bits(own, alone(stiff, *AFTER, folder=tmp_path / "a"))
    check_same_bits(ghost, alone(opened(by_pid), *AFTER, folder=tmp_path / "b"))
    assert np.abs(own - ghost).max() > 0.001


def test_a_mission_of_another_vehicle_is_refused_with_a_reason(opened, hover):
    heavy = page_mission("hover", {"mission.name": "heavy", "vehicle.payload.mass": 0.7})
    flight = opened(hover)
    (refused,) = flight.along(packed_mission(heavy, ""))
    assert (refused["what"], refused["reason"]) == ("compare", "heavy: has another vehicle than hover")


def test_a_ghost_that_has_ended_is_told_and_the_flight_goes_on(opened, packed_by_hand, tmp_path):
    flight = opened(packed_by_hand)
    check_done(flight, (("ask", {"what": "lift"}, 4.0),))
    flight.say("set", key="person.max_force", value=20.0)
    flight.fly(1.0)
    flight.say("compare", what="keep")
    flight.say("set", key="person.max_force", value=0.5)
    flight.fly(1.0)
    assert flight.status()["ghost"] == ""
    flight.say("force", force=[20, 0, 20], point=[0, 1, 0])
    flight.fly(3.0)
    assert "crashed at" in flight.status()["ghost"]
    assert flight.status()["phase"] != "crashed"
    time = flight.seen()["time"][0]
    assert flight.seen(1)["time"][0] < time - 0.5
