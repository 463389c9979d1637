"""Streams of columns and columns of streams are each other's inverse, and corrections know every key of a map."""

from dataclasses import replace
from typing import ClassVar

import numpy as np
import pytest
from mistaken_maps import pasted
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.logs.columns import angles_of, columns_of, quaternions_of, stream_of, turned_by
from tandemlift.analysis.logs.corrections import MapCorrection, corrected, in_words
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, SPEED_COMMANDS, Log, Stream
from tandemlift.analysis.logs.maps import Way

N = 400
TIME = np.arange(N) * 0.005
RNG = np.random.default_rng(54)
WAVES = np.sin(TIME[:, None] * [3.0, 4.1, 2.3] + np.array([0.1, 0.7, 1.9])) * [0.4, 0.3, 1.2]
ATTITUDE = MOTION[2]


def same_turn(a, b):
    return np.abs(np.sum(a * b, axis=1)) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("kind", ["xyz", "ZYX", "zxz", "YXY", "rotation vector"])
def test_angles_are_those_of_scipy_there_and_back(kind):
    turns = Rotation.from_rotvec(WAVES) if kind == "rotation vector" else Rotation.from_euler(kind, WAVES)
    q = turns.as_quat(scalar_first=True)
    assert same_turn(quaternions_of(WAVES, kind), q)
    expected = turns.as_rotvec() if kind == "rotation vector" else turns.as_euler(kind)
    assert np.cos(angles_of(q, kind) - expected) == pytest.approx(1.0, abs=1e-9)
    way = Way(columns=("a", "b", "c"), angles=kind, unit="deg", offset=(1.0, 0.0, -2.0), scale=(1.0, -1.0, 1.0))
    columns = columns_of(ATTITUDE, way, Stream(TIME, q))
    assert same_turn(stream_of(ATTITUDE, way, columns).values, q)


def test_an_up_y_and_a_turn_are_turns_of_world_and_body_of_scipy():
    """Attitudes of tracked axes, which are turned from the body's and have y up, in a world with y up."""
    y_up = Rotation.from_euler("x", -90.0, degrees=True)  # our axes in those with y up
    turn = (10.0, -30.0, 40.0)
    true = Rotation.from_rotvec(WAVES)
    written = y_up * true * Rotation.from_rotvec(turn, degrees=True) * y_up.inv()
    way = Way(columns=("a", "b", "c", "d"), up="y", turn=turn)
    found = stream_of(ATTITUDE, way, Stream(TIME, written.as_quat(scalar_first=True)))
    assert same_turn(found.values, true.as_quat(scalar_first=True))
    sensor = Rotation.from_rotvec(turn, degrees=True)  # whose axes are turned: its readings are R' v
    read = y_up.apply(sensor.inv().apply(WAVES))
    way = Way(columns=("a", "b", "c"), up="y", turn=turn)
    assert stream_of(IMU[1], way, Stream(TIME, read)).values == pytest.approx(WAVES)
    assert turned_by(turn) == pytest.approx(sensor.as_quat(scalar_first=True))


@pytest.mark.parametrize(
    ("name", "width", "keys"),
    [
        (
            IMU[0],
            3,
            {"unit": "g", "scale": (1.0, -1.0, -2.0), "offset": 0.3, "turn": (0.0, 20.0, -70.0), "delay": 0.02},
        ),
        (JOINTS[0], 6, {"unit": "lbf", "scale": (1.0, -1.0, 1.0), "offset": (1.0, 2.0, 3.0), "up": "y"}),
        (ATTITUDE, 4, {"up": "y", "turn": (0.0, 0.0, 90.0), "scale": (1.0, 1.0, -1.0, -1.0)}),
        (SPEED_COMMANDS, 8, {"unit": "rpm", "power": 0.5, "up": "y", "scale": 2.0, "offset": -1000.0}),
    ],
)
def test_columns_come_back_from_the_stream_that_was_made_of_them(name, width, keys):
    way = Way(columns=tuple(map(str, range(width))), **keys)
    columns = Stream(TIME, RNG.normal(size=(N, width)))
    back = columns_of(name, way, stream_of(name, way, columns))
    assert back.time == pytest.approx(columns.time)
    assert back.values == pytest.approx(columns.values)


def test_a_whole_map_with_y_up_leaves_the_columns_of_rotors_where_they_are():
    values = RNG.uniform(100.0, 200.0, (N, 8))
    way = Way(columns=tuple(map(str, range(8))), up="y")
    assert np.array_equal(stream_of(SPEED_COMMANDS, way, Stream(TIME, values)).values, values)


class TestCorrectionsOfMaps:
    """What is corrected in memory is what a reader makes of the file by the pasted map."""

    ATTITUDES: ClassVar = {
        "unit": ({"angles": "xyz"}, MapCorrection(ATTITUDE, unit="deg")),
        "order": ({"angles": "ZYX", "unit": "deg"}, MapCorrection(ATTITUDE, (2, 1, 0), angles="ZYX")),
        "convention": ({"angles": "ZYX", "unit": "deg"}, MapCorrection(ATTITUDE, angles="xyz")),
        "signs": ({"angles": "xyz", "unit": "deg"}, MapCorrection(ATTITUDE, signs=(1.0, -1.0, 1.0))),
        "up": ({"angles": "xyz", "unit": "deg"}, MapCorrection(ATTITUDE, up="y", turn=(-90.0, 0.0, 0.0))),
        "back": (
            {"angles": "xyz", "unit": "deg"},
            MapCorrection(ATTITUDE, signs=(-1.0, -1.0, -1.0), angles="XYZ"),
        ),
    }

    @staticmethod
    def both(path, columns, map_, one):
        """(The log corrected in memory, and read by the pasted map)."""
        heads = ["t", *(f"c{i}" for i in range(columns.shape[1]))]
        rows = [",".join(map(repr, row)) for row in np.column_stack([TIME, columns]).tolist()]
        path.write_text("\n".join([",".join(heads), *rows]))
        log = tl.read_log(path, map_)
        return corrected(log, [one]), tl.read_log(path, pasted(map_, in_words([one], log)))

    @pytest.mark.parametrize("what", ATTITUDES)
    def test_an_attitude_in_angles(self, what, tmp_path):
        keys, one = self.ATTITUDES[what]
        angles = WAVES if what == "unit" else np.degrees(WAVES)
        way = {"columns": ["c0", "c1", "c2"], "time": "t", **keys}
        found, read = self.both(tmp_path / "log.csv", angles, {ATTITUDE: way}, one)
        assert same_turn(found[ATTITUDE].values, read[ATTITUDE].values)

    def test_speeds_with_offset_and_power(self, tmp_path):
        pulses = RNG.uniform(1100.0, 1900.0, (N, 8))
        way = {"columns": [f"c{i}" for i in range(8)], "time": "t", "offset": -1000.0, "scale": 400.0}
        one = MapCorrection(SPEED_COMMANDS, (4, 5, 6, 7, 0, 1, 2, 3), power=0.5)
        found, read = self.both(tmp_path / "log.csv", pulses, {SPEED_COMMANDS: way}, one)
        assert found[SPEED_COMMANDS].values == pytest.approx(read[SPEED_COMMANDS].values)
        assert found[SPEED_COMMANDS].values == pytest.approx(400.0 * np.sqrt(np.roll(pulses, 4, axis=1) - 1000.0))

    def test_a_late_motion_moves_the_resets_of_its_estimate(self):
        log = Log({MOTION[0]: Stream(TIME, WAVES)}, breaks=(1.0,))
        assert corrected(log, [MapCorrection(MOTION[0], delay=0.25)]).breaks == (0.75,)

    def test_signs_of_one_of_several_topics_are_factors_of_all_their_columns(self):
        own = {"columns": ["x", "y", "z"], "topic": ["a", "b"], "scale": [1.0, 1.0, -1.0]}
        one = MapCorrection(JOINTS[0], signs=(1.0, 1.0, 1.0, -1.0, -1.0, 1.0))
        assert one.way(own, 6) == {"scale": [1.0, 1.0, -1.0, -1.0, -1.0, -1.0]}
        assert MapCorrection(JOINTS[0], signs=(-1.0, 1.0, 1.0) * 2).way(own, 6) == {"scale": [-1.0, 1.0, -1.0]}
        log = Log({JOINTS[0]: Stream(TIME, np.ones((N, 6)) * [1, 1, -1, 1, 1, -1])}, ways={JOINTS[0]: own})
        assert corrected(log, [one])[JOINTS[0]].values[0].tolist() == [1.0, 1.0, -1.0, -1.0, -1.0, -1.0]

    def test_an_order_that_topics_cannot_say_is_no_correction(self):
        own = {"columns": ["x", "y", "z"], "topic": ["a", "b"]}
        assert MapCorrection(JOINTS[0], (3, 4, 5, 0, 1, 2)).can_be_said(own, 6)
        assert MapCorrection(JOINTS[0], (1, 0, 2, 4, 3, 5)).can_be_said(own, 6)
        assert not MapCorrection(JOINTS[0], (1, 0, 2, 3, 4, 5)).can_be_said(own, 6)
        assert MapCorrection(JOINTS[0], (1, 0, 2, 3, 4, 5)).can_be_said({}, 6)


def test_a_reset_of_the_estimate_is_no_turn_of_the_attitude():
    """A heading that jumps by 0.6 rad, once, in a log whose rates are those of its attitude."""
    from tandemlift.analysis.logs.grid import Grid

    time = np.arange(4000) * 0.005
    yaw = 0.3 * np.sin(1.3 * time) + 0.6 * (time > 9.0)
    q = np.column_stack([np.cos(yaw / 2), 0.0 * yaw, 0.0 * yaw, np.sin(yaw / 2)])
    rates = np.column_stack([0.0 * yaw, 0.0 * yaw, 0.39 * np.cos(1.3 * time)])
    log = Log({ATTITUDE: Stream(time, q), IMU[1]: Stream(time, rates)}, breaks=(9.0,))
    for one, most in ((log, 0.06), (replace(log, breaks=()), np.inf)):
        grid = Grid(one)
        off = np.abs(grid.turn(grid.attitudes) - grid.mean(IMU[1])).max()
        assert off < most if most < 1.0 else off > 20.0
    grid = Grid(log)
    away = np.abs(grid.edges[:-1] - 9.0)
    assert not grid.there(2, ATTITUDE)[away < 0.03].any()
    assert grid.there(2, ATTITUDE)[(away > 0.1) & (away < 5.0)].all()
