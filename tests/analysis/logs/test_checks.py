"""Units, signs and frames that gravity or the motion contradict are refused by name; sound logs are not."""

from dataclasses import replace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.logs.checks import check_log
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Stream, log_of

POSITION, VELOCITY, ATTITUDE = MOTION
FORCE, RATES = IMU
DOWN = np.array([1.0, -1.0, -1.0])  # front, right, down in front, left, up


@pytest.fixture(scope="module")
def log():
    """Lift, tare and two pushes of the first 24 s."""
    return log_of(tl.fly(tl.load_mission("iris", {"mission.duration": 24.0, "mission.log_interval": 0.001})))


def with_values(log, **changes):
    changed = {name: Stream(log[name].time, change(log[name].values)) for name, change in changes.items()}
    return replace(log, streams={**log.streams, **changed})


def test_a_sound_log_passes_also_where_it_hardly_moves(log):
    check_log(log)
    check_log(log.between(9.0, 12.0))
    check_log(log.between(-1.0, 1.0))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({FORCE: lambda v: v / 9.81}, 'median size is 1 m/s².*: must be near 9.81 m/s².*in g: unit = "g"'),
        ({FORCE: lambda v: 1e3 * v}, "it seems to be in mm/s²: scale = 0.001"),
        ({FORCE: lambda v: v - [0.0, 0.0, 9.81]}, "it seems to be without gravity"),
        ({FORCE: lambda v: v * DOWN}, r"reads -9.8.* m/s² along z .*scale = \[1, -1, -1\]"),
        ({FORCE: lambda v: v[:, [2, 0, 1]]}, r"reads \+9.8 m/s² along x in hover: must be \+9.81 along z"),
        ({RATES: np.degrees}, 'stream measured_rates: it is .* times the turn .* in deg/s: unit = "deg/s"'),
        ({RATES: lambda v: v * DOWN}, r"stream measured_rates: .* of front, right, down: scale = \[1, -1, -1\]"),
        ({ATTITUDE: lambda q: q[:, [1, 2, 3, 0]]}, "stream measured_attitude: .* seems to be x, y, z, w: give"),
        ({ATTITUDE: lambda q: 2.0 * q}, "its norm is 2: must be a unit quaternion"),
        ({POSITION: lambda v: v * [1.0, 1.0, -1.0]}, "stream measured_position: .* along z.*of the other sign"),
        ({POSITION: lambda v: 1e3 * v}, "stream measured_position: .*in millimetres: scale = 0.001"),
        ({POSITION: lambda v: v * DOWN, VELOCITY: lambda v: v * DOWN}, "stream measured_velocity: .*the other sign"),
        ({RATES: lambda v: v * [1.0, 0.0, 1.0]}, "stream measured_rates: column 1 is constant"),
        ({JOINTS[0]: lambda v: v * [1, 1, 1, 1, 0, 1]}, "stream measured_joint_force: column 4 is constant"),
        ({RATES: lambda v: np.clip(v, -0.02, 0.03)}, r"column 0 is saturated: .* % of its samples are -0.02"),
    ],
)
def test_a_contradiction_is_refused_with_its_likely_cause(log, changes, message):
    with pytest.raises(tl.InputError, match=message):
        check_log(with_values(log.between(12.5, 24.0), **changes))


def test_stamps_in_milliseconds_are_refused_before_anything_is_computed(log):
    begin = log.begin
    slow = log.mapped(lambda _, stream: Stream(1e3 * (stream.time - begin), stream.values))
    with pytest.raises(tl.InputError, match=r'samples at 0\.2 Hz, .* expected; time_unit = "ms"'):
        tl.shadow(slow, "iris")
