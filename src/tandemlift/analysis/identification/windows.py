"""A log as windows of flight on one grid of time: commands, samples in blocks, and what was left out.

The body diverges in open loop, so each window has a start of its own. The grid has the steps of the accelerometer's
clock, at most 2 ms. A sample between two steps is predicted by a straight line between their predictions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.logs import log as logs
from tandemlift.analysis.logs.causes import StreamTest, check_streams
from tandemlift.analysis.logs.clocks import GAP
from tandemlift.analysis.logs.grid import without_spikes
from tandemlift.analysis.logs.log import COMMANDS, IMU, JOINTS, MOTION, PUSH, SPEED_COMMANDS, Log, Stream
from tandemlift.core.errors import InputError
from tandemlift.core.types import GRAVITY, Array
from tandemlift.engines.driven_vehicle import effect_floor
from tandemlift.missions import Mission, VehicleTable

Places = NDArray[np.intp]
Truths = NDArray[np.bool_]

LONGEST_STEP = 0.002  # s
BLOCK = 0.010  # s, over which samples are averaged for derivatives
LENGTH = 1.0  # s of a window
LONGEST_DELAY = 0.1  # s that a command may be late
SETTLING = 0.3  # s from the first command until the rotors' speeds are known
HELD = 0.75  # of the samples of a stream: if fewer are new, a table holds each of them for several rows
STRAIGHT = 1e-3  # of the change between its neighbours: a sample so near their straight line was drawn there
BEYOND = 0.01  # of the commanded speeds, that may be above the largest
CLEAR = 6.0  # radii of a rotor above where it stood: no contact, and a ground effect that its theory gives
FEWEST = 8  # windows
BEGINNING = 0.2  # of a window: its start must be known from there


class Samples(NamedTuple):
    """The samples of a stream in windows: window, step in it, fraction of a step beyond, values (n, width)."""

    window: Places
    step: Places
    beyond: Array
    values: Array

    def only(self, kept: Truths, windows: Truths | None = None) -> Samples:
        """Some of them, by a truth for each; windows are numbered anew, as far as each is there."""
        number = self.window if windows is None else (np.cumsum(windows) - 1)[self.window]
        return Samples(number[kept], self.step[kept], self.beyond[kept], self.values[kept])


@dataclass(frozen=True)
class FlightWindows:
    """The windows of one log.

    Attributes:
        source: of the log.
        step: of the grid [s].
        begin: of the grid [s].
        count: steps of the whole grid.
        first: step at which each window begins (W,).
        length: steps of a window, a whole number of blocks.
        block: steps of a block.
        commands: times (n,) [s] and commanded speeds (n, rotors) [rad/s].
        pushes: force [N] and moment [N m] of a logged push amid every step of the grid (count, 6), as `DrivenInputs`.
        samples: by stream.
        floor: the height z [m], in the log, of a floor with ground effect; None without.
        notes: what was found and changed, in sentences.
        stamp_offset: how far [s] stamps of commands and of readings may be off from each other.
        tests: of the streams against each other.
        place: of the accelerometer, from the payload's origin [m], if the tests found it elsewhere.
    """

    source: str
    step: float
    begin: float
    count: int
    first: Places
    length: int
    block: int
    commands: Stream
    pushes: Array
    samples: dict[str, Samples]
    floor: float | None = None
    notes: tuple[str, ...] = ()
    stamp_offset: float = 0.0
    tests: tuple[StreamTest, ...] = ()
    place: Array | None = None

    def times(self) -> Array:
        """The time [s] at which each window begins."""
        return np.asarray(self.begin + self.first * self.step, dtype=float)

    def commands_at(self, delay: float) -> tuple[Array, Array]:
        """(Mean command in every step of the grid (count, rotors), its derivative by the delay)."""
        time, speeds = self.commands
        integral = np.concatenate([np.zeros((1, speeds.shape[1])), np.cumsum(speeds[:-1] * np.diff(time)[:, None], 0)])
        edges = self.begin + np.arange(self.count + 1) * self.step - delay
        place = np.clip(np.searchsorted(time, edges + 1e-9, side="right") - 1, 0, len(time) - 1)
        held = speeds[place]
        total = integral[place] + held * (edges - time[place])[:, None]
        return np.diff(total, axis=0) / self.step, -np.diff(held, axis=0) / self.step

    def beginnings(self) -> FlightWindows:
        """The first part of every window."""
        length = max(4, round(BEGINNING * self.length / self.block)) * self.block
        return replace(self, length=length, samples={n: s.only(s.step < length) for n, s in self.samples.items()})

    def chosen(self, windows: Truths) -> FlightWindows:
        """Some of the windows, by a truth for each, with the streams that have samples there."""
        kept = {name: windows[s.window] for name, s in self.samples.items()}
        samples = {name: self.samples[name].only(own, windows) for name, own in kept.items() if own.any()}
        return replace(self, first=self.first[windows], samples=samples)


def windows_of(log: Log, mission: Mission, length: float = LENGTH) -> FlightWindows:
    """Cut a log into windows in flight.

    Args:
        log: with IMU, motion measurement and commands.
        mission: of about such a vehicle.
        length: of a window [s].

    Raises:
        InputError: a stream is missing, has another number of rotors or joints, or no flight is left.
    """
    check_columns(log, mission.vehicle, mission.mission.name)
    log.require(*IMU, MOTION[0], MOTION[2])
    _check_commands(log)
    streams = check_streams(log, mission.vehicle)
    log, notes = _without_held(log)
    commands = _speeds(log, mission.vehicle)
    imu = log["measured_specific_force"].time
    interval = float(np.median(np.diff(imu))) if len(imu) > 1 else LONGEST_STEP
    step = interval / np.ceil(interval / LONGEST_STEP - 1e-9)
    begin = max(float(commands.time[0]), float(imu[0]))
    begin = float(imu[np.searchsorted(imu, begin - 1e-9)])
    ends = _ends(log, commands)
    count = int((min(ends[name] for name in ends if name not in (*JOINTS, *PUSH)) - begin) / step)
    block = max(1, round(BLOCK / step))
    steps = round(length / (step * block)) * block
    lead = int(np.ceil((SETTLING + LONGEST_DELAY) / step))
    firsts = np.arange(lead, count - steps - 2 * block, steps)
    if len(firsts) < FEWEST:
        raise InputError(
            f"{log.source}: commands and sensors overlap for {max(count, 0) * step:.3g} s; {FEWEST} windows "
            f"of {length:g} s are needed, after {SETTLING + LONGEST_DELAY:g} s for delay and lag of the rotors"
        )
    offset, said = logs.unknown_offset(log, interval)
    notes += _early_ends(ends, log.source, length) + said
    cut = FlightWindows(log.source, step, begin, count, firsts, steps, block, commands, np.zeros((count, 6)), {})
    amid = begin + (np.arange(count) + 0.5) * step
    for name, place in zip(PUSH, (slice(0, 3), slice(3, 6)), strict=True):
        if name in log:
            cut.pushes[:, place] = _between(amid, log[name])
    samples = {name: _samples(cut, log[name]) for name in (*IMU, *MOTION, *JOINTS) if name in log}
    cut = replace(cut, samples=samples)
    flies, rested = _in_flight(cut, log, mission.vehicle)
    usable = flies & _have_starts(cut) & _commanded(cut) & _unbroken(cut, log.breaks)
    if usable.sum() < FEWEST:
        raise InputError(
            f"{log.source}: flies clear of the floor, with motion and rates measured and no gap in the commands, in "
            f"{usable.sum()} windows; {FEWEST} are needed"
        )
    lowest = float(log[MOTION[0]].values[:, 2].min())
    cut = replace(cut.chosen(usable), floor=_floor(mission, rested, lowest), notes=notes)
    return replace(cut, stamp_offset=offset, tests=streams.table, place=streams.place)


def _without_held(log: Log) -> tuple[Log, tuple[str, ...]]:
    """(A log without the samples that a table has made up between those that were taken, what was left out).

    A table of one clock repeats the sample before, or draws straight lines, where a stream has none.
    """
    streams, notes = dict(log), list[str]()
    for words, names, taken in (
        ("repeat the one before", (*IMU, *MOTION, *JOINTS), _new),
        ("lie on straight lines between others", (*IMU, *MOTION, *JOINTS, COMMANDS, SPEED_COMMANDS), _bends),
    ):
        made_up = list[str]()
        for name in (n for n in names if n in streams):
            time, values = streams[name]
            own = taken(time, values)
            if own.mean() < HELD:
                streams[name] = Stream(time[own], values[own])
                made_up.append(f"{name} ({1.0 - own.mean():.0%})")
        said = f"Samples of {', '.join(made_up)} {words} and are left out: leave such cells of a table empty."
        notes += [f"{log.source}: {said}"] * bool(made_up)
    return replace(log, streams=streams), tuple(notes)


def _new(_: Array, values: Array) -> Truths:
    """Which samples differ from the one before."""
    return np.insert(np.any(np.diff(values, axis=0) != 0.0, axis=1), 0, True)


def _bends(time: Array, values: Array) -> Truths:
    """Which samples are not on the straight line between their neighbours, and not equal to both.

    All of them, if those on lines are not far nearer to them than the others: a smooth motion has no bends.
    """
    every = np.ones(len(time), bool)
    if len(time) < 3:
        return every
    part = ((time[1:-1] - time[:-2]) / (time[2:] - time[:-2]))[:, None]
    off = np.abs(values[1:-1] - values[:-2] - part * (values[2:] - values[:-2]))
    step = np.abs(values[2:] - values[:-2])
    straight = np.all(off <= STRAIGHT * step, axis=1) & np.any(step > 0.0, axis=1)
    size = np.sum(off / np.maximum(np.ptp(values, axis=0), 1e-300), axis=1)
    if straight.all() or not straight.any() or np.median(size[straight]) > STRAIGHT * np.median(size[~straight]):
        return every
    return np.concatenate([[True], ~straight, [True]])


def _ends(log: Log, commands: Stream) -> dict[str, float]:
    """The last time [s] of each stream that is used, by name."""
    ends = {name: float(log[name].time[-1]) for name in (*IMU, *MOTION, *JOINTS, *PUSH) if name in log}
    return ends | {"commands": float(commands.time[-1])}


def _early_ends(ends: Mapping[str, float], source: str, length: float) -> tuple[str, ...]:
    """A sentence about the streams that end a window or more before the last one."""
    last = max(ends.values())
    early = [f"{name} at {end:.4g} s" for name, end in ends.items() if end < last - length]
    said = "later windows do without joints and force gauge; those without another stream are left out"
    return (f"{source}: The log ends at {last:.4g} s, but {', '.join(early)}: {said}.",) * bool(early)


def _between(times: Array, stream: Stream) -> Array:
    """A stream at some times (n, width), by straight lines; 0 before it begins and after it ends."""
    return np.array([np.interp(times, stream.time, v, left=0.0, right=0.0) for v in stream.values.T]).T


def _check_commands(log: Log) -> None:
    """Refuse a log without commands, or with those of a rotor that never change."""
    if SPEED_COMMANDS not in log and COMMANDS not in log:
        raise InputError(f"{log.source}: has neither {SPEED_COMMANDS} nor {COMMANDS}; it has {', '.join(log)}")
    values = log[name := log.commands].values
    if len(values) > 1 and np.ptp(values, axis=0).min() == 0.0:
        rotor = int(np.argmin(np.ptp(values, axis=0)))
        raise InputError(f"{log.source}: {name}: column {rotor} is constant, {values[0, rotor]:g}: a dead channel")


def _speeds(log: Log, vehicle: VehicleTable) -> Stream:
    """The commanded speeds [rad/s]; of thrusts, by the vehicle's thrust constants."""
    rotors = [q for q in vehicle.quadrotors for _ in range(4)]
    time, values = log[name := log.commands]
    most = np.array([q.max_speed for q in rotors])
    if name == COMMANDS:
        values = np.sqrt(np.maximum(values, 0.0) / [q.thrust_constant for q in rotors])
    elif (beyond := np.mean(values > most * (1.0 + 1e-6), axis=0)).max() > BEYOND:
        rotor = int(np.argmax(beyond))
        i, largest = rotor // 4, values[:, rotor // 4 * 4 :][:, :4].max()
        raise InputError(
            f"{log.source}: {name}: column {rotor} is above vehicle.quadrotors.{i}.max_speed = {most[rotor]:g} rad/s "
            f"in {beyond[rotor]:.0%} of its samples; those of quadrotor {i} reach {largest:.5g} rad/s: set max_speed"
        )
    return Stream(time, np.clip(values, 0.0, most))


def check_columns(log: Log, vehicle: VehicleTable, name_of_mission: str) -> None:
    """Refuse a log with another number of rotors or joints than a mission's vehicle has."""
    count = len(vehicle.quadrotors)
    for name, each in ((JOINTS[0], 3), (JOINTS[1], 3), (COMMANDS, 4), (SPEED_COMMANDS, 4)):
        if name in log and (columns := log[name].values.shape[1]) != each * count:
            must = f"{each} for each of the {count} quadrotors of mission {name_of_mission}"
            raise InputError(
                f"{log.source}: stream {name} has {columns} columns: must be {must}; not this vehicle's log?"
            )


def _samples(cut: FlightWindows, stream: Stream) -> Samples:
    """The samples of a stream that are in windows."""
    stream = without_spikes(stream)
    exact = (stream.time - cut.begin) / cut.step
    step = np.floor(exact + 1e-3).astype(np.intp)
    beyond = np.where(np.abs(exact - step) < 2e-3, 0.0, exact - step)
    window = np.searchsorted(cut.first, step, side="right") - 1
    local = step - cut.first[np.maximum(window, 0)]
    inside = (window >= 0) & (local < cut.length)
    return Samples(window[inside], local[inside], beyond[inside], stream.values[inside])


def _have_starts(cut: FlightWindows) -> Truths:
    """Whether each window begins with two samples or more of every stream that tells its start: no gap is there."""
    samples = cut.beginnings().samples
    own = (samples[name].window for name in (*MOTION, IMU[1]) if name in samples)
    return np.all([np.bincount(window, minlength=len(cut.first)) > 1 for window in own], axis=0)


def _commanded(cut: FlightWindows) -> Truths:
    """Whether the commands have no gap in each window, and none in the time before it in which the rotors settle."""
    time, begin = cut.commands.time, cut.times()
    gap = np.flatnonzero(np.diff(time) > GAP * np.median(np.diff(time)))
    next_gap = np.searchsorted(time[gap + 1], begin - (SETTLING + LONGEST_DELAY), side="right")
    return np.asarray(np.append(time[gap], np.inf)[next_gap] >= begin + cut.length * cut.step)


def _unbroken(cut: FlightWindows, breaks: tuple[float, ...]) -> Truths:
    """Whether the estimate of the motion was not reset in each window."""
    begin, times = cut.times()[:, None], np.array(breaks)
    return ~np.any((times > begin - cut.step) & (times <= begin + cut.length * cut.step), axis=1)


def _in_flight(cut: FlightWindows, log: Log, vehicle: VehicleTable) -> tuple[Truths, float | None]:
    """(Whether each window flies: its rotors carry most of the weight, and it is clear of the floor; z at rest)."""
    quadrotors = vehicle.quadrotors
    mass = vehicle.payload.mass + sum(q.mass for q in quadrotors)
    constants = np.array([q.thrust_constant for q in quadrotors for _ in range(4)])
    time, position = log["measured_position"]
    thrust = np.array([np.interp(time, cut.commands.time, column) for column in cut.commands.values.T]).T ** 2
    resting = thrust @ constants < 0.5 * mass * GRAVITY
    rested = float(position[resting, 2].min()) if resting.any() else None
    flies = ~resting & (position[:, 2] > (-np.inf if rested is None else rested + _clear(vehicle)))
    grid = cut.begin + (cut.first[:, None] + np.arange(0, cut.length, cut.block)) * cut.step
    return np.interp(grid, time, flies.astype(float)).min(axis=1) > 0.5, rested


def _clear(vehicle: VehicleTable) -> float:
    return CLEAR * max(q.rotor_radius for q in vehicle.quadrotors)


def _floor(mission: Mission, rested: float | None, lowest: float) -> float | None:
    """The height z [m] of a log's floor with ground effect: below where the vehicle rested, to 0.1 m.

    Without a rest it is that of the mission, if the log's lowest z is clear of it, as a log's z may have any origin.
    That is as near as `CLEAR` needs, and logs of one place share their machine code.
    """
    ground = effect_floor(mission)
    if ground is None:
        return None
    floor, rests = ground
    if rested is None:
        return floor if lowest > rests + _clear(mission.vehicle) else None
    return floor + round(rested - rests, 1)
