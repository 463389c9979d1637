"""Resets of an estimate are found with time and size, spikes and motion are none, and windows leave them out."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.analysis.identification.windows import windows_of
from tandemlift.analysis.logs.log import IMU, MOTION, Log, Stream, log_of
from tandemlift.analysis.logs.resets import Reset, resets, with_resets
from tandemlift.missions import load_mission
from tandemlift.simulation.fly import fly

FINE = {"mission.duration": 20.0, "mission.log_interval": 0.001}


@pytest.fixture(scope="module")
def flown():
    """A flight of `iris` with its noise, and a push."""
    push = {"force": [3.0, 1.0, 0.0], "time": 9.0, "sigma": 0.2}
    log = log_of(fly(load_mission("iris", FINE | {"pushes": [push]})))
    return log.aligned([*log], -log.begin)


def with_step(log, name, at, step):
    """The log with a step of a stream: a number that is added, or a turn about the world's z [rad]."""
    time, values = log[name]
    values, later = values.copy(), time >= at
    if name == MOTION[2]:
        turned = Rotation.from_rotvec([0.0, 0.0, step]) * Rotation.from_quat(values[later], scalar_first=True)
        values[later] = turned.as_quat(scalar_first=True)
    else:
        values[later] += step
    return Log({**log, name: Stream(time, values)}, log.source)


def test_a_flight_with_noise_and_pushes_has_no_reset(flown):
    assert resets(flown) == []


@pytest.mark.parametrize(
    ("name", "step", "size"),
    [
        (MOTION[0], np.array([0.3, -0.4, 0.0]), 0.5),
        (MOTION[1], np.array([0.0, 0.0, 0.6]), 0.6),
        (MOTION[2], 0.35, 0.35),
        (MOTION[2], 6.0, 2.0 * np.pi - 6.0),  # the shorter way round
    ],
)
@pytest.mark.parametrize("at", [4.0, 12.3])
def test_a_step_of_position_velocity_or_heading_is_found_with_its_time_and_size(flown, name, step, size, at):
    (found,) = resets(with_step(flown, name, at, step))
    assert (found.name, found.time) == (name, pytest.approx(at, abs=0.006))
    assert found.size == pytest.approx(size, rel=0.1)


def test_a_sample_that_is_off_alone_is_a_spike(flown):
    time, values = flown[MOTION[0]]
    values = values.copy()
    values[700] += [0.0, 1.0, 0.0]
    assert resets(Log({**flown, MOTION[0]: Stream(time, values)})) == []


def test_windows_leave_a_reset_out_and_the_notes_tell_of_it_once(flown):
    mission = load_mission("iris", FINE)
    at = 12.34
    log = with_resets(with_step(flown, MOTION[2], at, 0.35), [Reset(MOTION[2], at, np.nan)])
    assert log.breaks == (pytest.approx(at, abs=0.006),)
    (note,) = log.notes
    assert note.startswith("the estimate was reset: measured_attitude at 12.34 s by 20.")
    whole, cut = (windows_of(of, mission).times() for of in (flown, log))
    inside = (whole <= at) & (whole + 1.0 >= at)
    assert inside.sum() == 1
    assert np.array_equal(cut, whole[~inside])
    assert log.aligned(MOTION, 0.5).breaks[0] == pytest.approx(log.breaks[0] + 0.5)
    assert log.aligned(IMU, 0.5).breaks == log.breaks
