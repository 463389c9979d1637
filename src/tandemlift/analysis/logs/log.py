"""The log of a vehicle: streams of measured numbers, each with a clock of its own.

A stream has the name, the unit and the frame of the channel of a flight (`flight.channels`) that it measures.
Commands come as thrusts, `rotor_commands`, or as speeds, `rotor_speed_commands`: the thrust map of the mission's
rotors, thrust = k Ω², leads from one to the other.

A stamp is the time at which the sensor sampled, or at which the command was given. Time 0 is the start of the mission.
docs/how-to/log-a-vehicle.md is the contract for users.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, unknown
from tandemlift.core.types import Array
from tandemlift.flight.channels import FLOWN, OTHER, STAMP, Channel, channel_of, stamp_of
from tandemlift.flight.record import Flight

COMMANDS, SPEED_COMMANDS, FLOWN_COMMANDS = "rotor_commands", "rotor_speed_commands", FLOWN
IMU = ("measured_specific_force", "measured_rates")
JOINTS = ("measured_joint_force", "measured_joint_torque")
MOTION = ("measured_position", "measured_velocity", "measured_attitude")
PUSH = ("push_force", "push_moment_at_origin")
BEFORE = {"push_moment": PUSH[1]}  # names of version 1.0, and those in their place
STREAMS = (*IMU, *JOINTS, *MOTION, COMMANDS, SPEED_COMMANDS, *PUSH)
"""The streams that readers know; a log may have others, by names of channels."""

LARGEST_OFFSET = 0.1  # s, of stamps
SOON = 1e-6  # s: a stamp that much later than a time still counts as it
PER = {"": 1, "quadrotor": 1, "rotor": 4}  # the number of columns of a stream is a multiple of its width times this


def stream_channel(name: str) -> Channel:
    """Unit, frame, meaning and width of the stream of that name.

    Raises:
        InputError: there is no such stream.
    """
    channel = channel_of(name)
    if channel == OTHER:
        raise unknown("stream", name, STREAMS)
    return channel


class Stream(NamedTuple):
    """Samples on one clock: their times (n,) [s], strictly increasing, and values (n, width)."""

    time: Array
    values: Array

    def at(self, times: Array) -> Array:
        """The last sample at some times [s]; before the first one, that one."""
        return self.values[np.maximum(np.searchsorted(self.time, times + SOON, side="right") - 1, 0)]


def conjugate(q: Array) -> Array:
    """The conjugates of quaternions (…, 4)."""
    return q * [1.0, -1.0, -1.0, -1.0]


def quaternion_product(a: Array, b: Array) -> Array:
    """The products of quaternions (…, 4)."""
    aw, av, bw, bv = a[..., :1], a[..., 1:], b[..., :1], b[..., 1:]
    w = aw * bw - np.sum(av * bv, axis=-1, keepdims=True)
    return np.concatenate([w, aw * bv + bw * av + np.cross(av, bv)], axis=-1)


def rotation_vectors(q: Array) -> Array:
    """The rotation vectors (…, 3) [rad] of quaternions (…, 4) of any length, the shorter way round."""
    size = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(size, np.abs(q[..., :1])) * np.where(q[..., :1] < 0.0, -1.0, 1.0)
    return np.asarray(q[..., 1:] * (angle / np.maximum(size, 1e-300)))


def turns(a: Array, b: Array) -> Array:
    """The rotation vectors (…, 3) [rad] from attitudes a (…, 4) to b, axes of the body."""
    return rotation_vectors(quaternion_product(conjugate(a), b))


def swept(turning: Array, rates: Array, r: Array) -> Array:
    """The acceleration at a place r (3) [m] of a rigid body over that of its origin: α × r + ω × (ω × r)."""
    return np.cross(turning, r) + np.cross(rates, np.cross(rates, r))


def rotated(q: Array, v: Array) -> Array:
    """Vectors (n, 3) turned by quaternions w, x, y, z (n, 4) of about unit length."""
    w, r = q[:, :1], q[:, 1:]
    return np.asarray(v + 2.0 * np.cross(r, np.cross(r, v) + w * v) / np.sum(q * q, axis=1)[:, None])


@dataclass(frozen=True, eq=False)
class Log(Mapping[str, Stream]):
    """The streams of a log by name, as arrays of float64.

    Attributes:
        streams: by name; at least one.
        source: file or flight that it came from, for messages.
        notes: what was found and changed since it was read, a line each.
        stamp_offset: how far [s] stamps of readings may be off from those of commands; None if nobody said it.
        breaks: the times [s] at which the estimate of the motion was reset: no window goes over one.
        ways: of each stream that a map led to, its table in that map, as far as it was given.

    Raises:
        InputError: a stream is unknown or empty, has another width, a number that is not finite, or a stamp that is not
            after the one before it. The message names stream and row.
    """

    streams: Mapping[str, Stream]
    source: str = "log"
    notes: tuple[str, ...] = ()
    stamp_offset: float | None = None
    breaks: tuple[float, ...] = ()
    ways: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        off = 0.0 if self.stamp_offset is None else self.stamp_offset
        if not isinstance(off, int | float) or not 0.0 <= off <= LARGEST_OFFSET:
            raise InputError(f"{self.source}: stamp_offset = {off!r}: must be a number from 0 to {LARGEST_OFFSET:g} s")
        if not self.streams:
            raise InputError(f"{self.source}: has no stream; known are {', '.join(STREAMS)}")
        streams = {BEFORE.get(name, name): self._checked(name, *stream) for name, stream in self.streams.items()}
        old = [f"{name} of a log is now called {new}" for name, new in BEFORE.items() if name in self.streams]
        object.__setattr__(self, "notes", (*self.notes, *old))
        object.__setattr__(self, "streams", streams)

    def _checked(self, name: str, time: Any, values: Any) -> Stream:
        place, channel = f"{self.source}: stream {name}", stream_channel(name)
        time, values = np.asarray(time, dtype=float), np.asarray(values, dtype=float)  # a log may be large: no copy
        values = values[:, None] if values.ndim == 1 else values
        if time.ndim != 1 or values.ndim != 2 or len(time) != len(values) or not len(time):
            raise InputError(f"{place}: times {time.shape}, values {values.shape}: must be (n,) and (n, width), n ≥ 1")
        width, per = channel.width, PER[channel.per]
        if values.shape[1] % (width * per) or (not channel.per and values.shape[1] != width):
            every = f" for each {channel.per}" if channel.per else ""
            raise InputError(f"{place}: has {values.shape[1]} columns: must have {width}{every}")
        wrong = np.flatnonzero(~(np.isfinite(values).all(axis=1) & np.isfinite(time)))
        if len(wrong):
            row = int(wrong[0])
            raise InputError(f"{place}: row {row} is {values[row]} at {time[row]} s: must be finite numbers")
        back = np.flatnonzero(np.diff(time) <= 0.0)
        if len(back):
            row = int(back[0]) + 1
            raise InputError(
                f"{place}: row {row} is at {time[row]:.9g} s, the row before at {time[row - 1]:.9g} s: "
                "times must increase"
            )
        return Stream(time, values)

    def __getitem__(self, name: str) -> Stream:
        name = BEFORE.get(name, name)
        if name not in self.streams:
            raise KeyError(f"{self.source} has no stream {name!r}; it has {', '.join(self.streams)}")
        return self.streams[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.streams)

    def __len__(self) -> int:
        return len(self.streams)

    def __repr__(self) -> str:
        rates = ", ".join(f"{name} {self.rate(name):.4g} Hz" for name in self)
        return f"<Log {self.source}: {self.duration:.6g} s, {rates}>"

    @property
    def commands(self) -> str:
        """The name of the stream of commands: of speeds, if it has these."""
        return SPEED_COMMANDS if SPEED_COMMANDS in self.streams else COMMANDS

    def require(self, *names: str) -> None:
        """Refuse a log without these streams.

        Raises:
            InputError: one is missing; the message names it.
        """
        for name in names:
            if name not in self.streams:
                meaning = stream_channel(name).meaning
                raise InputError(f"{self.source}: has no {name} ({meaning}); it has {', '.join(self.streams)}")

    @property
    def begin(self) -> float:
        """The time [s] from which on all streams have samples."""
        return max(float(time[0]) for time, _ in self.streams.values())

    @property
    def end(self) -> float:
        """The time [s] until which all streams have samples."""
        return min(float(time[-1]) for time, _ in self.streams.values())

    @property
    def duration(self) -> float:
        """The length [s] of the span in which all streams have samples; 0 if there is none."""
        return max(self.end - self.begin, 0.0)

    def rate(self, name: str) -> float:
        """Samples of a stream per second: one over the median time between two; 0 for a single sample."""
        time = self[name].time
        return float(1.0 / np.median(np.diff(time))) if len(time) > 1 else 0.0

    def mapped(self, change: Callable[[str, Stream], Stream]) -> Log:
        """The log with every stream changed."""
        return replace(self, streams={name: change(name, stream) for name, stream in self.streams.items()})

    def between(self, begin: float, end: float) -> Log:
        """The samples from one time [s] to another, both included; the clock stays.

        Raises:
            InputError: a stream has no sample there.
        """

        def part(name: str, stream: Stream) -> Stream:
            inside = (stream.time >= begin) & (stream.time <= end)
            if not inside.any():
                raise InputError(f"{self.source}: stream {name} has no sample from {begin:g} to {end:g} s")
            return Stream(stream.time[inside], stream.values[inside])

        return self.mapped(part)

    def aligned(self, names: Collection[str], offset: float, drift: float = 0.0, about: float = 0.0) -> Log:
        """The log with other stamps of some streams: t + offset + drift · (t − about) [s] for each stamp t."""

        def moved(name: str, stream: Stream) -> Stream:
            time = stream.time
            return Stream(time + offset + drift * (time - about), stream.values) if name in names else stream

        own = self.breaks if MOTION[0] not in names else [t + offset + drift * (t - about) for t in self.breaks]
        return replace(self.mapped(moved), breaks=tuple(own))


def unknown_offset(log: Log, interval: float) -> tuple[float, tuple[str, ...]]:
    """(How far stamps of readings may be off from those of commands [s], and a sentence about it if nobody said it).

    A logger that stamps a sample when it arrives, or with its cycle, is off by about an interval of the samples. Data
    do not tell this from a delay of the commands.
    """
    if log.stamp_offset is not None:
        return log.stamp_offset, ()
    off = f"off from their sampling by an interval of the imu, {1e3 * interval:.3g} ms: the interval of actuators.delay"
    known = "has it in it. If they are exact, say stamp_offset = 0 in the map"
    return interval, (f"{log.source}: Stamps of readings may be {off} {known}.",)


def sample_stamps(log: Log, flight: Flight) -> dict[str, Array]:
    """The stamps (T,) [s] of the log's samples that a shadow's sensors read, by the channel of the stamps."""
    names = {stamp: name for stamp, (name, *_) in STAMP.items() if stamp in flight and name in log}
    return {stamp: Stream(log[name].time, log[name].time).at(flight[stamp]) for stamp, name in names.items()}


def log_of(flight: Flight) -> Log:
    """The log that a vehicle would have written in a flight with sensors.

    Readings have their stamps in the flight, as `imu_stamp`, and not the times at which the pilot has them. The first
    reading is the one with which the pilot starts, stamped one interval before the first sample. Thrusts that ideal
    rotors produce are their commands.

    Raises:
        InputError: the flight has no sensors.
    """
    if MOTION[0] not in flight:
        raise InputError(f'flight {flight.name}: has no readings: fly it with sensors.model = "simulated"')
    streams = {}
    for name in (n for n in flight if n.startswith("measured_")):
        stamps = flight[stamp_of(name)]
        rows = np.isfinite(stamps) & (np.diff(stamps, prepend=np.nan) != 0.0)
        streams[name] = Stream(stamps[rows], flight[name][rows])
    commands = flight[COMMANDS if COMMANDS in flight else "rotor_thrusts"]
    rotors = [q for q in flight.vehicle.quadrotors for _ in range(4)]
    k, most = np.array([q.thrust_constant for q in rotors]), np.array([q.thrust_limit for q in rotors])
    streams[COMMANDS] = Stream(flight.time, commands)
    streams[SPEED_COMMANDS] = Stream(flight.time, np.sqrt(np.clip(commands, 0.0, most) / k))
    force, moment = flight["push_force"], flight["push_moment"]
    streams[PUSH[0]] = Stream(flight.time, force)
    in_body = rotated(conjugate(flight["attitude"]), force)
    streams[PUSH[1]] = Stream(flight.time, moment + np.cross(flight.vehicle.center_of_mass, in_body))
    return Log(streams, flight.name, stamp_offset=0.0)
