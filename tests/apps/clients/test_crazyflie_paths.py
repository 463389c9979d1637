"""Paths of the high-level commander: uploaded ones where they are asked for, and turned as a hand would turn them."""

import math
import struct

import numpy as np
import pytest
from scipy.interpolate import BPoly, PPoly

from tandemlift.apps.clients.crazyflie.high_level import (
    MEMORY,
    HighLevelCommander,
    Moment,
    Piece,
    Plan,
    piece_between,
)
from tandemlift.apps.clients.setpoints import FullStateSetpoint, QuadrotorState, Stop

PLACE, YAW = (3.0, -2.0, 1.5), 0.5 * math.pi
NO_COMMAND, NO_ENTRY, BUSY = 8, 2, 16  # errno.h: ENOEXEC, ENOENT, EBUSY


def standing(time=0.0, yaw=YAW, place=PLACE):
    """A quadrotor at rest, turned to the left."""
    q = (math.cos(0.5 * yaw), 0.0, 0.0, math.sin(0.5 * yaw))
    return QuadrotorState(time, place, (0.0, 0.0, 0.0), q, (0.0, 0.0, 0.0), (0.0, 0.0, 9.81), (0.0,) * 4)


def uploaded(*pieces):
    """A commander with trajectory 3: rows of x, y, z and yaw with eight coefficients, and a duration."""
    commander = HighLevelCommander()
    data = b"".join(struct.pack("<33f", *np.ravel(rows), duration) for rows, duration in pieces)
    commander.memory[: len(data)] = data
    assert commander.command(struct.pack("<BBBBIB", 6, 3, 1, 0, 0, len(pieces)), None) == 0
    return commander


def follow(commander, *, moved=False, turned=False, backwards=False, number=3, scale=1.0, state=None):
    data = struct.pack("<BB???Bf", 13, 0, moved, turned, backwards, number, scale)
    return commander.command(data, state or standing())


def rows_of(**along):
    found = np.zeros((4, 8))
    for row, name in zip(found, ("x", "y", "z", "yaw"), strict=True):
        row[: len(along.get(name, ()))] = along.get(name, ())
    return found


AHEAD = rows_of(x=[0.0, 0.25], z=[1.0, 0.0, 0.125], yaw=[0.25, 0.5])  # exact in single precision


def test_a_trajectory_ahead_turned_for_a_quadrotor_that_looks_left_goes_left():
    """By its yaw less that of the trajectory's begin, about the vertical: the path's own heading is kept."""
    commander = uploaded((AHEAD, 2.0))
    assert follow(commander, turned=True) == 0
    turn = YAW - 0.25
    for t in (0.0, 0.5, 2.0):
        now = commander.plan.at(t)
        assert now.place == pytest.approx(
            (0.25 * t * math.cos(turn), 0.25 * t * math.sin(turn), 1.0 + 0.125 * t * t, YAW + 0.5 * t)
        )
    assert commander.plan.at(0.5).rate[:2] == pytest.approx((0.25 * math.cos(turn), 0.25 * math.sin(turn)))


@pytest.mark.parametrize("turned", [False, True])
def test_a_moved_trajectory_begins_where_the_quadrotor_is_and_keeps_its_shape(turned):
    commander = uploaded((AHEAD, 2.0), (rows_of(x=[0.5], y=[0.0, 0.5], z=[1.5], yaw=[1.25]), 1.0))
    assert follow(commander, moved=True, turned=turned) == 0
    turn = YAW - 0.25 if turned else 0.0
    assert commander.plan.at(0.0).place[:3] == pytest.approx(PLACE)
    c, s = math.cos(turn), math.sin(turn)
    for t, (x, y, z) in ((1.0, (0.25, 0.0, 0.125)), (3.0, (0.5, 0.5, 0.5))):
        where = PLACE[0] + c * x - s * y, PLACE[1] + s * x + c * y, PLACE[2] + z
        assert commander.plan.at(t).place[:3] == pytest.approx(where)
    assert commander.plan.at(3.0).place[3] == pytest.approx(1.25 + turn)


def test_a_slower_trajectory_passes_the_same_places_later():
    plain, slow = uploaded((AHEAD, 2.0)), uploaded((AHEAD, 2.0))
    assert follow(plain) == follow(slow, scale=2.0) == 0
    assert slow.plan.duration == 2.0 * plain.plan.duration == 4.0
    for t in (0.0, 0.7, 2.0):
        one, other = plain.plan.at(t), slow.plan.at(2.0 * t)
        assert other.place == pytest.approx(one.place)
        assert other.rate == pytest.approx(np.divide(one.rate, 2.0))
        assert other.acceleration == pytest.approx(np.divide(one.acceleration, 4.0))


def test_a_path_begins_with_the_motion_of_now_and_ends_at_rest_without_jerk():
    """The Hermite interpolant of SciPy with these ends; the jerk at the begin is 0, too."""
    start = Moment((1.0, -2.0, 0.5, 0.2), (0.3, 0.1, -0.2, 0.0), (0.4, -0.5, 0.6, 0.0))
    goal, duration = (2.0, 1.0, 1.5, -0.7), 2.5
    piece = piece_between(start, goal, duration)
    for i in range(4):
        begin = [start.place[i], start.rate[i], start.acceleration[i], 0.0]
        ends = BPoly.from_derivatives([0.0, duration], [begin, [goal[i], 0.0, 0.0, 0.0]])
        for t in (0.0, 0.9, 2.5):
            now = piece.at(t)
            for found, order in ((now.place, 0), (now.rate, 1), (now.acceleration, 2)):
                assert found[i] == pytest.approx(float(ends(t, order)), abs=1e-9)


def test_a_polynomial_and_its_derivatives_are_those_of_scipy_and_stay_at_its_ends():
    rows = np.random.default_rng(4).normal(size=(4, 8))
    piece, theirs = Piece(rows, 1.5), PPoly(rows.T[::-1, None, :], [0.0, 1.5])
    for t, within in ((-1.0, 0.0), (0.4, 0.4), (1.5, 1.5), (9.0, 1.5)):
        now = piece.at(t)
        assert now.place == pytest.approx(theirs(within))
        assert now.rate == pytest.approx(theirs(within, 1))
        assert now.acceleration == pytest.approx(theirs(within, 2))


def test_a_plan_goes_through_its_pieces_and_rests_at_its_end():
    first, second = Piece(rows_of(x=[0.0, 1.0]), 2.0), Piece(rows_of(x=[2.0, 0.0, 1.0]), 1.0)
    plan = Plan((first, second), 10.0)
    assert plan.duration == 3.0
    assert plan.at(11.0).place[0] == 1.0
    assert plan.at(12.5).place[0] == pytest.approx(2.25)
    assert plan.at(13.0).rate[0] == pytest.approx(2.0)
    rest = plan.at(14.0)
    assert (rest.place[0], rest.rate[0], rest.acceleration[0]) == (pytest.approx(3.0), 0.0, 0.0)


def test_a_turn_is_the_short_way_round():
    commander = HighLevelCommander()
    data = struct.pack("<BBBBfffff", 12, 0, 0, 0, *PLACE, -0.75 * math.pi, 2.0)
    assert commander.command(data, standing(yaw=0.75 * math.pi)) == 0
    assert commander.plan.at(2.0).place == pytest.approx((*PLACE, 1.25 * math.pi))


def test_a_relative_step_adds_to_the_path_of_now_and_an_absolute_one_does_not():
    commander = HighLevelCommander()
    assert commander.command(struct.pack("<BBBBfffff", 12, 0, 1, 0, 1.0, 2.0, 0.5, 0.25, 2.0), standing()) == 0
    assert commander.plan.at(2.0).place == pytest.approx((4.0, 0.0, 2.0, YAW + 0.25))
    assert commander.command(struct.pack("<BBBBfffff", 12, 0, 1, 0, 1.0, 0.0, 0.0, 0.0, 2.0), standing(9.0)) == 0
    assert commander.plan.begin == 9.0
    assert commander.plan.at(11.0).place[:3] == pytest.approx((5.0, 0.0, 2.0))
    assert commander.command(struct.pack("<BBBBfffff", 12, 0, 0, 0, 1.0, 2.0, 0.5, 0.25, 2.0), standing(20.0)) == 0
    assert commander.plan.at(22.0).place == pytest.approx((1.0, 2.0, 0.5, 0.25))


@pytest.mark.parametrize("keeps", [False, True])
def test_a_take_off_keeps_its_yaw_only_if_it_shall_and_its_place_always(keeps):
    commander = HighLevelCommander()
    assert commander.command(struct.pack("<BBff?f", 7, 0, 2.0, 0.5, keeps, 2.0), standing()) == 0
    assert commander.plan.at(2.0).place == pytest.approx((*PLACE[:2], 2.0, YAW if keeps else 0.5))
    assert not commander.plan.lands


def test_a_landing_stops_the_rotors_at_its_end_and_not_before():
    commander = HighLevelCommander()
    assert commander.command(struct.pack("<BBff?f", 8, 0, 0.0, 0.0, True, 2.0), standing(1.0)) == 0
    setpoint = commander.setpoint(2.9)
    assert isinstance(setpoint, FullStateSetpoint)
    place, rate, acceleration = commander.plan.at(2.9)
    assert (setpoint.position, setpoint.velocity) == (place[:3], rate[:3])
    assert (setpoint.acceleration, setpoint.yaw) == (acceleration[:3], place[3])
    assert not commander.is_finished(2.9)
    assert commander.is_finished(3.0)
    assert commander.setpoint(3.0) == Stop()
    assert commander.setpoint(3.1) is None


def test_a_take_off_goes_on_at_its_end():
    commander = HighLevelCommander()
    assert commander.command(struct.pack("<BBff?f", 7, 0, 2.0, 0.5, True, 2.0), standing()) == 0
    assert commander.setpoint(9.0).position == pytest.approx((*PLACE[:2], 2.0))
    commander.stop()
    assert commander.setpoint(9.0) is None
    assert not commander.is_finished(9.0)


def test_a_command_for_another_group_changes_nothing():
    commander, up = HighLevelCommander(), struct.Struct("<BBff?f")
    assert commander.command(b"\x00\x06", standing()) == 0  # it belongs to groups 2 and 4
    assert commander.command(up.pack(7, 1, 2.0, 0.0, True, 2.0), standing()) == 0
    assert commander.plan is None
    assert commander.command(up.pack(7, 5, 2.0, 0.0, True, 2.0), standing()) == 0
    assert commander.plan.at(9.0).place[2] == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("duration", "error"), [(0.049, NO_COMMAND), (0.051, 0), (3599.0, 0), (3601.0, NO_COMMAND), (math.nan, NO_COMMAND)]
)
def test_pieces_are_of_a_length_that_can_be_flown(duration, error):
    go = struct.pack("<BBBBfffff", 12, 0, 0, 0, 1.0, 2.0, 0.5, 0.25, duration)
    assert HighLevelCommander().command(go, standing()) == error
    assert follow(uploaded((AHEAD, duration))) == error


def test_what_is_not_there_or_no_number_is_refused():
    commander = uploaded((AHEAD, 2.0))
    assert follow(commander, number=4) == NO_ENTRY
    assert [follow(commander, scale=scale) for scale in (0.0, -1.0, math.nan, math.inf)] == [NO_COMMAND] * 4
    assert follow(commander, backwards=True) == NO_COMMAND
    assert commander.command(struct.pack("<BB???Bf", 13, 0, False, False, False, 3, 1.0), None) == BUSY
    for place in range(4):
        goal = [1.0, 1.0, 1.0, 0.0]
        goal[place] = math.inf
        assert commander.command(struct.pack("<BBBBfffff", 12, 0, 0, 0, *goal, 2.0), standing()) == NO_COMMAND
    assert commander.plan is None


@pytest.mark.parametrize(
    ("location", "form", "offset", "count", "error"),
    [
        (1, 0, MEMORY - 132, 1, 0),
        (1, 0, MEMORY - 131, 1, NO_COMMAND),
        (1, 0, 0, 31, 0),
        (1, 0, 0, 32, NO_COMMAND),
        (1, 0, 0, 0, NO_COMMAND),
        (0, 0, 0, 1, NO_COMMAND),
        (1, 1, 0, 1, NO_COMMAND),
    ],
)
def test_a_trajectory_lies_within_the_memory(location, form, offset, count, error):
    """Pieces of 132 bytes, 33 numbers, in 4,096."""
    data = struct.pack("<BBBBIB", 6, 3, location, form, offset, count)
    assert HighLevelCommander().command(data, None) == error
