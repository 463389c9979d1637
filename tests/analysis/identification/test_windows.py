"""Windows of a log against closed forms: times, commands, spikes, what flies."""

from functools import partial

import flight_windows
import numpy as np
import pytest
from flight_windows import cut, iris

from tandemlift.analysis.identification.windows import (
    _clear,
    _in_flight,
    _speeds,
    windows_of,
)
from tandemlift.analysis.logs.grid import without_spikes
from tandemlift.analysis.logs.log import COMMANDS, IMU, MOTION, SPEED_COMMANDS, Log, Stream
from tandemlift.core.errors import InputError
from tandemlift.core.types import GRAVITY

RNG = np.random.default_rng(11)
sampled = partial(flight_windows.sampled, rng=RNG)


# windows


def test_windows_begin_when_their_steps_do():
    assert cut().times() == pytest.approx([5.2, 5.4, 5.6])


def test_chosen_windows_are_numbered_anew_and_keep_their_samples():
    s = sampled(3)
    few = cut(samples={MOTION[0]: s, IMU[1]: s.only(s.window == 0)}).chosen(np.array([False, True, True]))
    assert few.first.tolist() == [200, 300]
    assert list(few.samples) == [MOTION[0]]  # the other has none there
    own = few.samples[MOTION[0]]
    assert np.array_equal(own.values, s.values[s.window > 0])
    assert np.bincount(own.window).tolist() == [20, 20]


def test_a_command_in_steps_is_its_mean_over_each_step_of_the_grid_whatever_its_delay():
    time = 4.0 + np.cumsum(RNG.uniform(0.001, 0.006, 900))
    speeds = RNG.uniform(300.0, 900.0, (900, 8))
    w = cut(commands=Stream(time, speeds), count=200)
    for delay in (0.0, 0.0137):
        mean, slope = w.commands_at(delay)
        fine = 5.0 + (np.arange(200 * 400) + 0.5) * 0.002 / 400.0 - delay
        held = speeds[np.searchsorted(time, fine, side="right") - 1]
        assert mean == pytest.approx(held.reshape(200, 400, 8).mean(axis=1), abs=5.0)
        later, _ = w.commands_at(delay + 1e-7)
        near = np.abs((later - mean) / 1e-7 - slope) < 1e-3 * (1.0 + np.abs(slope))
        assert near.mean() > 0.99  # of commands that change within a difference the slope jumps


def test_a_command_that_begins_with_a_step_of_the_grid_acts_in_it():
    """Times are sums: what begins up to a nanosecond after a step begins with it."""
    time = np.array([4.0, 5.0 + 4e-10, 5.002 + 4e-10, 9.0])
    speeds = np.repeat([[0.0], [1.0], [3.0], [3.0]], 8, axis=1)
    mean, slope = cut(commands=Stream(time, speeds), count=3).commands_at(0.0)
    assert mean[:2, 0] == pytest.approx([1.0, 3.0], abs=1e-5)
    assert slope[:, 0] == pytest.approx([-1000.0, 0.0, 0.0])


@pytest.mark.parametrize("share", [0.0, 0.005, 0.02])
def test_commands_above_the_largest_speed_are_refused_if_there_are_more_than_one_in_a_hundred(share):
    vehicle = iris().vehicle
    most = np.repeat([q.max_speed for q in vehicle.quadrotors], 4)
    values = RNG.uniform(0.3, 0.9, (1000, 8)) * most
    values[: round(1000 * share), 5] = 1.3 * most[5]
    log = Log({SPEED_COMMANDS: Stream(np.arange(1000) * 0.01, values)}, "log")
    if share > 0.01:
        with pytest.raises(InputError, match=r"column 5 is above vehicle.quadrotors.1.max_speed .* in 2% of its"):
            _speeds(log, vehicle)
    else:
        assert _speeds(log, vehicle).values == pytest.approx(np.minimum(values, most))


def test_commanded_thrusts_are_squares_of_speeds_times_the_constants():
    vehicle, speeds = iris().vehicle, RNG.uniform(300.0, 700.0, (50, 8))
    constants = np.repeat([q.thrust_constant for q in vehicle.quadrotors], 4)
    log = Log({COMMANDS: Stream(np.arange(50) * 0.01, constants * speeds**2)}, "log")
    assert _speeds(log, vehicle).values == pytest.approx(speeds)


def test_a_spike_is_left_out_with_what_it_spoils_and_a_still_column_has_none():
    values = np.column_stack([RNG.normal(size=200), np.full(200, 2.0)])
    values[77, 0] += 80.0
    values[120, 1] += 1e-9  # a column that hardly ever changes cannot say what is usual
    kept = without_spikes(Stream(np.arange(200.0), values))
    gone = set(range(200)) - set(kept.time.astype(int))
    assert 77 in gone
    assert gone <= {76, 77, 78}


def hovering(seconds, step=0.001):
    """A log of a hover at 3 m from the start, with noise of all sensors and commands that move."""
    vehicle, t = iris().vehicle, np.arange(0.0, seconds, step)
    mass = vehicle.payload.mass + sum(q.mass for q in vehicle.quadrotors)
    constants = np.repeat([q.thrust_constant for q in vehicle.quadrotors], 4)
    # speeds change by 1e-4 only: these sensors see no motion, and 1 % would turn the vehicle by more than they hide
    speed = np.sqrt(mass * GRAVITY / (8.0 * constants)) * (1.0 + 1e-4 * np.sin(np.outer(t, 1.0 + np.arange(8.0))))

    def noisy(width, mean=0.0):
        return Stream(t, mean + 0.01 * RNG.normal(size=(len(t), width)))

    q = noisy(4, [1.0, 0.0, 0.0, 0.0])
    q.values[:] /= np.linalg.norm(q.values, axis=1, keepdims=True)
    streams = {IMU[0]: noisy(3, [0.0, 0.0, GRAVITY]), IMU[1]: noisy(3), MOTION[0]: noisy(3, [0.0, 0.0, 3.0])}
    return Log(streams | {MOTION[1]: noisy(3), MOTION[2]: q, SPEED_COMMANDS: Stream(t, speed)}, "log")


@pytest.mark.parametrize("extra", [0.0, 0.005, 0.012, 0.018, 0.022, 0.035])
def test_behind_the_last_window_there_is_a_block_for_its_end_and_one_for_a_late_clock(extra):
    w = windows_of(hovering(9.4 + extra), iris())
    assert len(w.first) >= 8
    assert w.first[-1] + w.length + 2 * w.block < w.count


def test_samples_that_a_table_drew_between_others_are_left_out_and_smooth_ones_are_not():
    log = hovering(9.4)
    time, speeds = log[SPEED_COMMANDS]
    own = Stream(time[::9], speeds[::9] + RNG.normal(size=(len(time[::9]), 8)))
    drawn = np.array([np.interp(time, own.time, column) for column in own.values.T]).T
    w = windows_of(Log({**log, SPEED_COMMANDS: Stream(time, drawn)}, "log"), iris())
    assert w.commands.time[: len(own.time)] == pytest.approx(own.time)
    assert len(w.commands.time) < len(own.time) + 9  # held behind the last one
    assert any("rotor_speed_commands (89%) lie on straight lines" in note for note in w.notes)
    smooth = windows_of(log, iris())
    assert len(smooth.commands.time) == len(time)
    assert not any("straight lines" in note for note in smooth.notes)


def test_a_window_flies_where_rotors_carry_the_weight_clear_of_where_it_rested():
    mission = iris()
    vehicle, clear = mission.vehicle, _clear(mission.vehicle)
    assert clear == pytest.approx(6.0 * max(q.rotor_radius for q in vehicle.quadrotors))
    mass = vehicle.payload.mass + sum(q.mass for q in vehicle.quadrotors)
    constants = np.repeat([q.thrust_constant for q in vehicle.quadrotors], 4)
    hover, t = np.sqrt(mass * GRAVITY / (8.0 * constants)), np.arange(4.0, 9.0, 0.01)
    on = np.clip((t - 4.5) / 0.1, 0.0, 1.0)
    height = 0.3 + np.where(t < 5.35, 0.9, 1.1) * clear * on
    log = Log({"measured_position": Stream(t, np.column_stack([0.0 * t, 0.0 * t, height]))}, "log")
    w = cut(commands=Stream(t, on[:, None] * hover))
    flies, rested = _in_flight(w, log, vehicle)
    assert rested == pytest.approx(0.3, abs=1e-6)
    assert flies.tolist() == [False, True, True]  # the first is too near the floor until 5.35 s
    low = cut(commands=Stream(t, 0.6 * on[:, None] * hover))  # a third of the weight
    assert not _in_flight(low, log, vehicle)[0].any()
