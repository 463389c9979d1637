"""Pushes by messages: where they act, how long, and what is refused."""

import re
import time
from types import SimpleNamespace

import numpy as np
import pytest
from ros_trial import UP, wrench
from scipy.spatial.transform import Rotation

from tandemlift.parts.mechanics.vehicle import Vehicle


def push_after(trial, seconds=0.3):
    """Force [N, world] and moment [N m, body] of the push, once the hand has taken hold."""
    trial.fly(seconds)
    return np.array(trial.channel("push_force")), np.array(trial.channel("push_moment"))


def attitude(trial):
    return Rotation.from_quat(trial.channel("attitude"), scalar_first=True)


@pytest.fixture(scope="module")
def trial(one_trial):
    one_trial.fly(UP)
    return one_trial


@pytest.fixture
def clock(monkeypatch):
    """The time by which words are repeated, which stands still; [s], in a list."""
    now = [1000.0]
    clocks = SimpleNamespace(monotonic=lambda: now[0], time_ns=time.time_ns)
    monkeypatch.setattr("tandemlift.apps.ros.diagnostics.time", clocks)
    return now


@pytest.fixture
def up(trial, clock):
    """In the air, and nobody has pushed for a moment."""
    trial.heed(wrench("world"))
    trial.front.diagnostics._said.clear()
    trial.sent("/diagnostics").clear()
    trial.fly(0.6)
    return trial


@pytest.mark.thorough
@pytest.mark.parametrize("frame", ["world", "base_world", "/base_world", "base_link", "payload", "joint_1", "joint_2"])
def test_a_force_acts_in_its_frame_s_axes_and_at_its_origin(up, frame):
    vehicle = Vehicle.from_settings(up.session.flight.now.vehicle)
    up.heed(wrench("base_world", (0.0, 3.0, 0.0)))  # so that it leans
    up.fly(0.3)
    leaning, force = attitude(up), np.array([1.0, -0.4, 0.2])
    up.heed(wrench(frame, tuple(force)))
    wanted = force if "world" in frame else leaning.apply(force)
    assert np.abs(leaning.as_matrix() - np.eye(3)).max() > 0.01
    assert np.array(up.session.flight.hand.force) == pytest.approx(wanted, abs=1e-12)
    arm = {"payload": -vehicle.center_of_mass}
    for i in (1, 2):
        arm[f"joint_{i}"] = np.array(vehicle.quadrotors[i - 1].joint_position) - vehicle.center_of_mass
    found, moment = push_after(up)
    body = attitude(up).inv().apply(found)
    assert moment == pytest.approx(np.cross(arm.get(frame, np.zeros(3)), body), abs=1e-3)


def test_a_torque_that_a_force_at_a_point_has_moves_that_point(up):
    force, torque = (0.0, 0.0, 1.0), (0.6, -0.2, 0.0)
    up.heed(wrench("base_link", force, torque))
    found, moment = push_after(up)
    assert moment == pytest.approx(np.cross([0.2, 0.6, 0.0], attitude(up).inv().apply(found)), abs=1e-3)


def test_the_push_of_a_recorded_flight_can_be_published_again(up):
    up.heed(wrench("joint_1", (0.8, 0.0, 0.3)))
    grip = np.array(up.session.flight.hand.grip)
    up.fly(0.4)
    recorded = up.sent("/tandemlift/push/true")[-1]
    recorded.header.frame_id = "base_world"
    up.heed(recorded)
    assert np.array(up.session.flight.hand.force) == pytest.approx(up.channel("push_force"), abs=1e-9)
    force, point = (np.array(v) for v in (up.session.flight.hand.force, up.session.flight.hand.grip))
    assert np.cross(point - grip, attitude(up).inv().apply(force)) == pytest.approx(np.zeros(3), abs=1e-9)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (wrench("mars", (1.0, 0.0, 0.0)), "frame_id = 'mars': must be one of world, base_world, base_link, payload"),
        (wrench("", (1.0, 0.0, 0.0)), "frame_id = ''"),
        (wrench("world", (float("nan"), 0.0, 0.0)), "must be finite"),
        (wrench("world", (0.0, float("inf"), 0.0)), "must be finite"),
        (wrench("world", (1.0, 0.0, 0.0), (0.0, float("nan"), 0.0)), "must be finite"),
        (wrench("world", (1e300, 0.0, 0.0)), "at most 1e+06"),
        (wrench("world", (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)), "a torque that no force at a point has"),
        (wrench("world", (1.0, 0.0, 0.0), (0.5, 0.0, 0.0)), "a torque that no force at a point has"),
        (wrench("world", (1.0, 0.0, 0.0), (0.0, 9.0, 0.0)), "a torque that acts 9 m off: at most"),
    ],
)
def test_what_no_hand_can_do_is_refused_with_a_reason_and_nothing_pushes(up, message, words):
    up.heed(wrench("base_world", (1.0, 0.0, 0.0)))
    up.fly(0.1)
    up.heed(message)
    assert not any(up.session.flight.hand.force)
    up.fly(0.1)
    assert any(said.startswith("push refused: ") and words in said for said in up.said())
    assert not up.session.flight.lost


def test_a_push_without_another_message_is_over_after_half_a_second(up):
    up.heed(wrench("base_world", (1.0, 0.0, 0.0)))
    up.fly(0.499)
    assert up.session.flight.hand.force == (1.0, 0.0, 0.0)
    up.fly(0.002)
    assert up.session.flight.hand.force == (0.0, 0.0, 0.0)
    force, _ = push_after(up, 0.8)
    assert np.abs(force).max() < 1e-3
    assert "push over: no message for 0.5 s" in up.said()


def test_a_push_goes_on_while_messages_come_and_ends_by_a_zero(up):
    for _ in range(5):
        up.heed(wrench("base_world", (1.0, 0.0, 0.0)))
        force, _ = push_after(up, 0.48)
        assert force == pytest.approx([1.0, 0.0, 0.0], abs=0.02)
    up.heed(wrench("base_world"))
    assert not any(up.session.flight.hand.force)
    up.fly(1.0)
    assert not any("push over" in said for said in up.said())


def test_a_push_is_cut_to_what_the_hand_has_and_that_is_told(up):
    up.heed(wrench("base_world", (30.0, 40.0, 0.0)))
    assert up.session.flight.hand.force == pytest.approx((2.4, 3.2, 0.0))
    assert "push cut: 50 N is more than person.max_force = 4 N" in up.said()


def test_the_same_words_are_told_once_a_second_at_most(up, clock):
    for times in (1, 2):
        for _ in range(50):
            up.heed(wrench("mars"))
        assert sum("mars" in said for said in up.said()) == times
        clock[0] += 1.0


def test_a_push_that_is_not_followed_is_reported_with_the_reason_and_with_what_to_do(up, clock):
    for _ in range(5):
        up.heed(wrench("world", (0.1, 0.0, 0.0)))  # N, below the threshold
        up.fly(0.2)
    reports = [words for words in up.said() if words.startswith("The push is not followed: ")]
    (report,) = reports
    assert re.fullmatch(r".*: it is below the threshold \(0\.\d+ N, limit 0\.3 N\)\. Push harder\.", report)
    assert report in up.middleware.logged
    up.heed(wrench("world"))
    up.fly(0.2)
    up.sent("/diagnostics").clear()
    clock[0] += 2.0
    for _ in range(5):
        up.heed(wrench("world", (2.0, 0.0, 0.0)))
        up.fly(0.2)
    assert not [words for words in up.said() if "not followed" in words]
