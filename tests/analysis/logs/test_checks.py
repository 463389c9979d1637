"""Dead and saturated channels and quaternions of no unit length are refused by name; sound logs are not."""

from dataclasses import replace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.logs.checks import check_log
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Stream, log_of

POSITION, VELOCITY, ATTITUDE = MOTION
FORCE, RATES = IMU


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
        ({ATTITUDE: lambda q: 2.0 * q}, "its norm is 2: must be a unit quaternion"),
        ({RATES: lambda v: v * [1.0, 0.0, 1.0]}, "stream measured_rates: column 1 is constant"),
        ({JOINTS[0]: lambda v: v * [1, 1, 1, 1, 0, 1]}, "stream measured_joint_force: column 4 is constant"),
        ({RATES: lambda v: np.clip(v, -0.02, 0.03)}, r"column 0 is saturated: .* % of its samples are -0.02"),
    ],
)
def test_a_flaw_of_a_stream_alone_is_refused(log, changes, message):
    with pytest.raises(tl.InputError, match=message):
        check_log(with_values(log.between(12.5, 24.0), **changes))


def test_stamps_in_milliseconds_are_refused_before_anything_is_computed(log):
    begin = log.begin
    slow = log.mapped(lambda _, stream: Stream(1e3 * (stream.time - begin), stream.values))
    with pytest.raises(tl.InputError, match=r'samples at 0\.2 Hz, .* expected; \[measured_\w+\] time_unit = "ms"'):
        tl.shadow(slow, "iris")
