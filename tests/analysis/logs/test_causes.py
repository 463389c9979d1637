"""Logs that physics contradicts are refused with the true cause, and what the message says to write mends them."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mistaken_maps import pasted
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.logs.causes import candidates, check_streams
from tandemlift.analysis.logs.columns import turned_by
from tandemlift.analysis.logs.corrections import MapCorrection, corrected
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, SPEED_COMMANDS, Stream, log_of, quaternion_product
from tandemlift.analysis.logs.stream_tests import VehicleLaws
from tandemlift.core.errors import InputError

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
POSITION, VELOCITY, ATTITUDE = MOTION
FORCE, RATES = IMU
EXCITED = [
    {"axis": axis, "frequency": f, "amplitude": size, "phase": 0.7 * k * k}
    for axis, size in (("thrust", 0.5), ("roll", 0.3), ("pitch", 0.03), ("yaw", 0.06))
    for k, f in enumerate((0.35, 0.6, 1.0, 1.7, 2.9, 4.9, 8.0))
]
FLOWN = {
    "mission.duration": 26.0,
    "mission.log_interval": 0.002,
    "phases.land_start": 90.0,
    "pushes": [],
    "excitation.model": "multisine",
    "excitation.begin": 13.0,
    "excitation.duration": 13.0,
    "excitation.lines": EXCITED,
}


@pytest.fixture(scope="module")
def log():
    """An excited hover of iris, without what only a simulation knows."""
    known = log_of(tl.fly(tl.load_mission("iris", FLOWN))).between(12.0, 25.9)
    return replace(
        known, streams={n: s for n, s in known.items() if not n.startswith("push") and n != "rotor_commands"}
    )


@pytest.fixture(scope="module")
def vehicle():
    return tl.load_mission("iris").vehicle


def with_values(log, **changes):
    changed = {name: Stream(log[name].time, change(log[name].values)) for name, change in changes.items()}
    return replace(log, streams={**log.streams, **changed})


def late(log, by, *names):
    return log.aligned(names, by)


def turned(angle, axis):
    q = turned_by(np.eye(3)[axis] * angle)
    return lambda v: quaternion_product(v, np.tile(q, (len(v), 1)))


def y_up(v):
    return np.column_stack([v[:, 0], v[:, 2], -v[:, 1]])


def y_up_world(v):
    q = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0.0, 0.0])
    return quaternion_product(np.tile(q, (len(v), 1)), v)


def y_up_all(v):
    """As a tracker writes it whose bodies have the world's axes when they are made."""
    return np.column_stack([v[:, 0], y_up(v[:, 1:])])


SWAP = [4, 5, 6, 7, 0, 1, 2, 3]
MISTAKEN = {
    "joints' sign": (
        dict.fromkeys(JOINTS, np.negative),
        r"of the other sign: \[measured_joint_force\] scale = -1 \[measured_joint_torque\] scale = -1$",
    ),
    "joint force in kgf": ({JOINTS[0]: lambda v: v / 9.80665}, r'in kgf: \[measured_joint_force\] unit = "kgf"$'),
    "joint force in lbf": ({JOINTS[0]: lambda v: v / 4.4482216}, r'in lbf: \[measured_joint_force\] unit = "lbf"$'),
    "joint force in mN": ({JOINTS[0]: lambda v: v * 1e3}, r'in mN: \[measured_joint_force\] unit = "mN"$'),
    "joints' axes turned": (
        {
            name: lambda v: (v.reshape(-1, 3) @ Rotation.from_euler("z", 40, degrees=True).as_matrix()).reshape(v.shape)
            for name in JOINTS
        },
        r"of axes that are turned by (39|4[0-2])° about z against the accelerometer's: \[measured_joint_force\] turn",
    ),
    "joints exchanged": (
        {name: lambda v: v[:, [3, 4, 5, 0, 1, 2]] for name in JOINTS},
        r"of quadrotors in the order 1, 0: \[measured_joint_force\] columns = ",
    ),
    "quadrotors exchanged": (
        {SPEED_COMMANDS: lambda v: v[:, SWAP]},
        r'of quadrotors in the order 1, 0: \[rotor_speed_commands\] columns = \["4", "5", "6", "7", "0", "1", .*\]$',
    ),
    "rotors in another order": (
        {SPEED_COMMANDS: lambda v: v[:, [1, 0, 2, 3, 5, 4, 6, 7]]},
        r"of rotors in the order 1, 0, 2, 3: \[rotor_speed_commands\] columns",
    ),
    "speeds in rpm": ({SPEED_COMMANDS: lambda v: v * 30.0 / np.pi}, r'in rpm: \[rotor_speed_commands\] unit = "rpm"$'),
    "parts of the largest speed": (
        {SPEED_COMMANDS: lambda v: v / 1200.0},
        r"hover: .*e-07 of the weight; expected: 0.5 to 2; .*No single change",
    ),
    "squares of speeds": ({SPEED_COMMANDS: np.square}, r"of squares .*\[rotor_speed_commands\] power = 0.5$"),
    "y up": (
        {POSITION: y_up, VELOCITY: y_up, ATTITUDE: y_up_all},
        r'a world with y up: .*\[measured_attitude\] up = "y"$',
    ),
    "y up in the world alone": (
        {POSITION: y_up, VELOCITY: y_up, ATTITUDE: y_up_world},
        r"gravity: \+1.00 g along y of the world.* a world with y up, what is tracked with z up: "
        r'.*\[measured_attitude\] turn = \[-90, 0, 0\], up = "y"$',
    ),
    "tracked body turned by 90 degrees": (
        {ATTITUDE: turned(90.0, 2)},
        r"turned by 90° about z: \[measured_attitude\] turn = \[0, 0, 90\]$",
    ),
    "tracked body turned by 20 degrees": (
        {ATTITUDE: turned(20.0, 1)},
        r"turned by (19|20|21)° about y against the gyroscope's",
    ),
    "quaternion x, y, z, w": (
        {ATTITUDE: lambda v: v[:, [1, 2, 3, 0]]},
        r'x, y, z, w: .*columns = \["3", "0", "1", "2"\]$',
    ),
    "quaternion from world to body": (
        {ATTITUDE: lambda v: v * [1, -1, -1, -1]},
        r"from world to body: \[measured_attitude\] scale = \[1, -1, -1, -1\]$",
    ),
    "gyroscope front, right, down": (
        {RATES: lambda v: v * [1, -1, -1]},
        r"of front, right, down: \[measured_rates\] scale = \[1, -1, -1\]$",
    ),
    "one axis of the gyroscope": (
        {RATES: lambda v: v * [1, -1, 1]},
        r"sign along y: \[measured_rates\] scale = \[1, -1, 1\]$",
    ),
    "gyroscope in degrees": ({RATES: np.degrees}, r'in deg/s: \[measured_rates\] unit = "deg/s"$'),
    "accelerometer in g": ({FORCE: lambda v: v / 9.80665}, r'in g: \[measured_specific_force\] unit = "g"$'),
    "velocity's columns exchanged": (
        {VELOCITY: lambda v: v[:, [1, 0, 2]]},
        r'order y, x, z: \[measured_velocity\] columns = \["1", "0", "2"\]$',
    ),
    "position in millimetres": ({POSITION: lambda v: 1e3 * v}, r'in mm: \[measured_position\] unit = "mm"$'),
}


def test_a_right_log_agrees_with_every_law_that_its_motion_tells(log, vehicle):
    table = check_streams(log, vehicle).table
    assert {one.verdict for one in table} <= {"agrees", "not told"}
    told = [one.test for one in table if one.verdict == "agrees"]
    assert any("turn of the attitude" in test for test in told)
    assert any("sum of the joints' forces" in test for test in told)
    assert any("commanded thrusts, quadrotor 1" in test for test in told)


@pytest.mark.parametrize("mistake", MISTAKEN)
def test_a_mistake_is_named_and_what_the_message_says_to_write_mends_it(mistake, log, vehicle):
    changes, message = MISTAKEN[mistake]
    wrong = with_values(log, **changes)
    with pytest.raises(InputError, match=message) as error:
        check_streams(wrong, vehicle)
    widths = {name: stream.values.shape[1] for name, stream in log.items()}
    given = {name: {"columns": [str(i) for i in range(width)]} for name, width in widths.items()}
    keys = pasted(given, str(error.value))
    if keys is None:
        return  # the message says so
    mended = wrong
    for name, way in keys.items():
        order = tuple(map(int, way.pop("columns")))
        scale = np.broadcast_to(np.array(way.pop("scale", 1.0), dtype=float), (widths[name],))
        one = MapCorrection(name, order, tuple(scale.tolist()), **way)
        mended = corrected(mended, [one]) if way or order != (*range(widths[name]),) or np.any(scale != 1) else mended
    check_streams(mended, vehicle)
    for name in log:
        sign = (
            np.sign(np.sum(log[name].values * mended[name].values, axis=1, keepdims=True)) if name == ATTITUDE else 1.0
        )
        size = float(np.abs(log[name].values).max())
        assert np.abs(mended[name].values * sign - log[name].values).max() < 0.03 * size, name


@pytest.mark.parametrize(
    ("names", "by"), [(MOTION, 0.06), (JOINTS, 0.05), ((ATTITUDE,), -0.05), ((RATES,), 0.05)], ids=str
)
def test_stamps_that_are_late_are_told_to_a_few_milliseconds(names, by, log, vehicle):
    with pytest.raises(InputError, match=rf"stamped .* {'late' if by > 0.0 else 'early'}: ") as error:
        check_streams(late(log, by, *names), vehicle)
    keys = pasted({name: {} for name in log}, str(error.value))
    assert {name for name, way in keys.items() if way} == {*names}
    assert all(way["delay"] == pytest.approx(by, abs=0.004) for way in keys.values() if way)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("samples", [1, 2, 30])
def test_a_log_of_a_few_samples_tells_nothing_and_is_not_refused(samples, log, vehicle):
    short = replace(log, streams={n: Stream(s.time[:samples], s.values[:samples]) for n, s in log.items()})
    assert {one.verdict for one in check_streams(short, vehicle).table} == {"not told"}


def test_stamps_of_another_unit_or_another_clock_are_told_before_all_else(log, vehicle):
    time, values = log[RATES]
    longer = replace(log, streams={**log.streams, RATES: Stream(1e3 * time, values)})
    with pytest.raises(InputError, match=r'stamped in ms: \[measured_rates\] time_unit = "ms"'):
        check_streams(longer, vehicle)
    with pytest.raises(InputError, match=r"measured_position: its stamps are from .* another clock"):
        check_streams(late(log, 500.0, POSITION), vehicle)


def test_an_accelerometer_on_a_quadrotor_is_placed_by_the_motion(log, vehicle):
    r = np.array([0.0, 1.0, 0.075])
    w = log[RATES].values
    smooth = np.apply_along_axis(lambda c: np.convolve(np.pad(c, 15, "edge"), np.full(31, 1 / 31), "valid"), 0, w)
    turning = np.gradient(smooth, log[RATES].time, axis=0)
    moved = with_values(log, **{FORCE: lambda f: f + np.cross(turning, r) + np.cross(smooth, np.cross(smooth, r))})
    found = check_streams(moved, vehicle)
    assert found.place == pytest.approx(r, abs=0.12)
    assert found.table[-1].verdict == "estimated"
    assert check_streams(log, vehicle).place is None


def test_the_laws_of_a_vehicle_are_those_of_the_flight_that_it_made(log, vehicle):
    """Scales are 1, but for rotors' lags; lags are those of rotors and the delay of commands."""
    fits = dict(VehicleLaws(vehicle).fits(log))
    for name in ("turn", "load"):
        told = fits[name].told
        assert told.any()
        assert fits[name].scale[told] == pytest.approx(1.0, abs=0.1)
    for number in (0, 1):
        assert fits[f"thrust {number}"].scale[2] == pytest.approx(0.9, abs=0.1)
        assert fits[f"torque {number}"].lag == pytest.approx(0.01 + 0.016, abs=0.006)


def test_every_cause_has_a_row_of_the_page_of_refused_logs(log, vehicle):
    page = (Path(__file__).parents[3] / "docs" / "how-to" / "my-log-is-refused.md").read_text("utf-8")
    table = page.partition("It seems to be … |")[2].partition("| it says |")[0]
    cells = [line[2:].split(" | ")[0] for line in table.splitlines() if line.startswith("| ")]
    known = [re.compile(".*".join(map(re.escape, cell.split("…")))) for cell in cells]
    maps = [
        {},
        {ATTITUDE: {"columns": [*"abc"], "angles": "xyz", "up": "y", "turn": (9.0, 0.0, 0.0)}, RATES: {"scale": 2.0}},
        {VELOCITY: {"columns": [*"abc"], "frame": "body"}, RATES: {"columns": [*"abc"], "unit": "deg/s"}},
    ]
    said = {
        cause.words
        for ways in maps
        for cause in candidates(late(replace(log, ways=ways), 0.05, *MOTION), VehicleLaws(vehicle), log)
    }
    assert len(said) > 100
    assert [words for words in said if not any(one.match(words) for one in known)] == []
    assert [one.pattern for one in known if not any(map(one.match, said))] == []
