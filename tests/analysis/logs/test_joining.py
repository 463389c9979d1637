"""Several recorders on one rigid body: their clocks by the turn that all have felt, and one log of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.analysis.logs.corrections import MapCorrection, corrected, in_words
from tandemlift.analysis.logs.joining import clock_against, joined
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, SPEED_COMMANDS, Log, Stream
from tandemlift.core.errors import InputError

FORCE, RATES = IMU
OFFSET, DRIFT = 3.217, 40e-6  # s; s/s


def turning(seconds, seed):
    """A body that turns by sines: times, rates (n, 3), quaternions (n, 4) by SciPy's rotations."""
    chance, t = np.random.default_rng(seed), np.arange(0.0, seconds, 0.002)
    f, phase = chance.uniform(0.2, 3.0, (3, 6)), chance.uniform(0.0, 6.0, (3, 6))
    rates = 0.1 * np.sum(np.sin(2.0 * np.pi * f * t[:, None, None] + phase), axis=2)
    steps = Rotation.from_rotvec(0.001 * (rates + np.roll(rates, -1, axis=0)))  # by the trapezoidal rule
    own, q = Rotation.identity(), []
    for step in steps:
        q.append(np.roll(own.as_quat(), 1))
        own = own * step
    return t, rates, np.array(q)


@pytest.fixture(scope="module")
def recorders():
    """A log of each of two autopilots, and one of a tracker; the clock of the others is off and drifts."""
    t, rates, q = turning(30.0, 3)
    chance = np.random.default_rng(5)
    speeds = 600.0 + 50.0 * np.sin(np.outer(t, np.arange(1.0, 9.0)))
    forces = np.sin(np.outer(t, np.arange(1.0, 7.0)))
    clock = (t - OFFSET) / (1.0 + DRIFT)

    def log(time, source, commands, force, noise):
        return Log(
            {
                RATES: Stream(time, rates + noise * chance.normal(size=rates.shape)),
                FORCE: Stream(time, np.tile([0.0, 0.0, 9.81], (len(t), 1))),
                SPEED_COMMANDS: Stream(time, commands),
                JOINTS[0]: Stream(time, force),
            },
            source,
        )

    left = log(t, "left", speeds[:, :4], forces[:, :3], 0.003)
    right = log(clock, "right", speeds[:, 4:], forces[:, 3:], 0.003)
    tracker = Log({MOTION[2]: Stream(clock[::4], q[::4]), MOTION[0]: Stream(clock[::4], rates[::4])}, "tracker")
    return left, right, tracker


@pytest.mark.parametrize("which", [1, 2])
def test_offset_and_drift_of_a_recorder_lie_within_their_intervals(which, recorders):
    clock = clock_against(recorders[0], recorders[which])
    at = OFFSET + DRIFT * clock.about
    assert abs(clock.offset - at) < max(3.0 * clock.offset_sigma, 2e-5)
    assert abs(clock.drift - DRIFT) < max(3.0 * clock.drift_sigma, 2e-6)
    assert clock.offset_sigma < 5e-4


def test_quadrotors_of_two_logs_become_columns_on_one_clock(recorders):
    left, right, tracker = recorders
    one = joined([left, right, tracker])
    assert {*one} == {RATES, FORCE, SPEED_COMMANDS, JOINTS[0], MOTION[0], MOTION[2]}
    time, values = one[SPEED_COMMANDS]
    inside = (time > 5.0) & (time < 25.0)
    true = 600.0 + 50.0 * np.sin(np.outer(time, np.arange(1.0, 9.0)))
    assert values.shape[1] == 8
    assert np.abs(values - true)[inside].max() < 50.0 * 8.0 * 0.0025  # held for a sample at most
    time, values = one[JOINTS[0]]
    inside = (time > 5.0) & (time < 25.0)
    assert np.abs(values - np.sin(np.outer(time, np.arange(1.0, 7.0))))[inside].max() < 3e-3
    assert [note.split(":")[0] for note in one.notes] == ["right", "tracker"]


def test_a_mistake_in_a_joined_log_is_said_in_the_words_of_the_map_of_each(recorders):
    """Both logs are read by one map; quadrotors in another order are logs in another order."""
    way = {"columns": ["m1", "m2", "m3", "m4"], "unit": "rpm"}
    left, right, _ = (replace(log, ways={SPEED_COMMANDS: way, RATES: {"columns": [*"pqr"]}}) for log in recorders)
    one = joined([left, right])
    assert one.ways[RATES] == {"columns": [*"pqr"]}

    def said(order=(), **keys):
        return in_words([MapCorrection(SPEED_COMMANDS, order, **keys)], one)

    assert said(unit="rad/s") == '[rotor_speed_commands] unit = "rad/s"'
    assert said((4, 5, 6, 7, 0, 1, 2, 3)) == '[rotor_speed_commands] topic = ["right", "left"]'
    assert said((1, 0, 2, 3, 5, 4, 6, 7)) == '[rotor_speed_commands] columns = ["m2", "m1", "m3", "m4"]'
    swapped = corrected(one, [MapCorrection(SPEED_COMMANDS, (4, 5, 6, 7, 0, 1, 2, 3))])[SPEED_COMMANDS].values
    assert swapped == pytest.approx(np.roll(one[SPEED_COMMANDS].values, 4, axis=1))
    other = replace(right, ways={SPEED_COMMANDS: way | {"unit": "rad/s"}})
    assert SPEED_COMMANDS not in joined([left, other]).ways


def test_resets_of_the_estimate_are_those_of_the_log_that_gives_the_motion(recorders):
    left, _, tracker = recorders
    one = joined([replace(left, breaks=(4.0,)), replace(tracker, breaks=(10.0,))])
    assert one.breaks == (pytest.approx(OFFSET + (1.0 + DRIFT) * 10.0, abs=1e-3),)


def test_logs_of_two_flights_or_without_a_turn_are_refused(recorders):
    left, right, _ = recorders
    t, rates, _ = turning(30.0, 8)
    other = replace(right, streams={**right.streams, RATES: Stream(t, rates)}, source="another")
    with pytest.raises(InputError, match="another: its turn is not that of left"):
        joined([left, other])
    blind = replace(right, streams={SPEED_COMMANDS: right[SPEED_COMMANDS]}, source="blind")
    with pytest.raises(InputError, match="blind: has neither measured_rates nor measured_attitude"):
        joined([left, blind])
