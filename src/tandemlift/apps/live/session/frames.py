"""Frames: what changes from moment to moment, as float32 numbers in little endian, one field after another.

SI units and world axes unless a field says otherwise. Whole numbers, such as `seq`, are exact up to 2²⁴. The values of
the fields come from channels by formulas that are written once: over arrays for a whole flight, over numbers for a
session, and traced for a page that flies without a server (`apps.live.page_manifest`).
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tandemlift.core.algebra import Number, absolute, maximum, where
from tandemlift.core.phases import GUIDED, HOLD, IDLE, LAND, LIFT
from tandemlift.core.types import Array, is_value, leaves
from tandemlift.core.vector import Quat, Vec3, cross, dot

RATE = 60  # frames a second, at most
STATUS_EVERY = RATE // 4  # frames, from one status to the next
ECHO = 0.003  # s, within which the flight has followed a move
ECHO_TIME = 0.012  # s after an echo, in which a page needs no other frame


class FrameField(NamedTuple):
    """A field of every frame.

    Attributes:
        name: as the scene has it.
        columns: how many numbers; 0 for one of each rotor.
        meaning: what it is, with unit and axes.
        jumps: whether values between two frames mean nothing, as of a flag.
    """

    name: str
    columns: int
    meaning: str
    jumps: bool = False


FRAME_FIELDS = (
    FrameField("time", 1, "time of the flight, s"),
    FrameField("position", 3, "centre of mass, m"),
    FrameField("attitude", 4, "unit quaternion w, x, y, z, body to world"),
    FrameField("velocity", 3, "of the centre of mass, m/s"),
    FrameField("reference", 3, "reference position, m"),
    FrameField("reference_yaw", 1, "rad"),
    FrameField("push", 3, "true push of all hands, N"),
    FrameField("push_point", 3, "where the push acts, m, body axes"),
    FrameField("push_moment", 3, "moment of the push about the centre of mass, N m, body axes"),
    FrameField("pilot_push", 3, "push that the pilot acts on: filtered, estimated, or the true one, N"),
    FrameField("disturbance", 3, "disturbance force as the pilot estimates it, N"),
    FrameField("wind", 3, "wind velocity, m/s"),
    FrameField("phase", 1, "index into the scene's `phases`", jumps=True),
    FrameField("alarm", 1, "index into the scene's `alarms`", jumps=True),
    FrameField(
        "contact_part", 1, "what touches a wall: number of the quadrotor of a guard, −1 the beam, 0 none", jumps=True
    ),
    FrameField("contact_point", 3, "where it touches, as the pilot estimates it, m", jumps=True),
    FrameField("contact_normal", 3, "unit vector out of that wall", jumps=True),
    FrameField("contact_force", 3, "force of floor and walls on the vehicle, N"),
    FrameField("held", 1, "1 while a page holds the beam, else 0", jumps=True),
    FrameField("hand_point", 3, "where the hand holds, m, body axes"),
    FrameField("hand_target", 3, "where the hand pulls to, m"),
    FrameField("seq", 1, "`seq` of the holder's last message that reached the flight, modulo 2²⁴", jumps=True),
    FrameField("thrusts", 0, "thrust of each rotor, N"),
)
FIELD_NAMES = tuple(field.name for field in FRAME_FIELDS)

FrameLayout = tuple[tuple[str, int], ...]  # name and number of columns of each field


def layout_for(rotors: int) -> FrameLayout:
    """The layout of the frames of a vehicle with so many rotors."""
    return tuple((field.name, field.columns or rotors) for field in FRAME_FIELDS)


def width_of(layout: FrameLayout) -> int:
    """Numbers in a frame."""
    return sum(count for _, count in layout)


def pack_frames(layout: FrameLayout, values: Mapping[str, ArrayLike], count: int = 1) -> NDArray[np.float32]:
    """Frames (count, width) from values by field, each (count, columns) or broadcast to that; others are zero."""
    table, at = np.zeros((count, width_of(layout)), dtype="<f4"), 0
    for name, columns in layout:
        if name in values:
            table[:, at : at + columns] = np.asarray(values[name]).reshape(-1, columns)
        at += columns
    return table


def read_frames(layout: FrameLayout, data: bytes) -> dict[str, NDArray[Any]]:
    """The values (count, columns) of each field in frames that follow one another."""
    columns = [count for _, count in layout]
    table = np.frombuffer(data, dtype="<f4").reshape(-1, sum(columns))
    fields = np.split(table, np.cumsum(columns)[:-1], axis=1)
    return dict(zip([name for name, _ in layout], fields, strict=True))


# values of the fields

AGES = 1e300  # s, the time of a landing that never comes
MIN_PUSH = 1e-9  # N, below which a push has no point of action
CHANNELS = {  # of each field: the channels that it may come from, the best first
    "position": ("position",),
    "attitude": ("attitude",),
    "velocity": ("velocity",),
    "reference": ("reference_position",),
    "push": ("push_force",),
    "push_moment": ("push_moment",),
    "pilot_push": ("push_filtered", "push_estimate", "push_force"),
    "disturbance": ("disturbance_force",),
    "wind": ("wind_velocity",),
    "alarm": ("alarm",),
    "contact_part": ("contact_part",),
    "contact_point": ("contact_point_estimate",),
    "contact_normal": ("contact_normal",),
    "contact_force": ("contact_force",),
    "thrusts": ("rotor_thrusts",),
}
USED = {"reference_euler", "phase"}.union(*CHANNELS.values())

Components = tuple[Any, ...]  # of a channel or of a field: numbers, arrays (T,) or symbols


def channel_columns(layout: object, names: Container[str] | None = USED) -> dict[str, NDArray[np.intp]]:
    """The columns of a sample that hold each channel in `names`, of all if None; `layout`: of the sample."""
    from tandemlift.simulation.results import channels_of  # with all laws, which a replay has no use for

    row = np.arange(leaves(layout), dtype=np.float64)[None, :]
    return {name: at.astype(np.intp).ravel() for name, at in channels_of(layout, row) if names is None or name in names}


def components_of(channel: Array) -> Components:
    """The components of a channel (T,) or (T, n)."""
    return tuple(channel.reshape(len(channel), -1).T)


class PhaseTimes(NamedTuple):
    """The times at which a scheduled flight begins and ends its lift, and begins to land [s]; its phase `before`."""

    lift_start: Number
    lift_end: Number
    land_start: Number
    before: Number


def phase_times(phases: Mapping[str, Any]) -> PhaseTimes:
    """The times of a mission; `phases`: that table of it."""
    start, land = phases["lift_start"], phases.get("land_start")
    if phases["height"] == 0.0:
        end, before = start, GUIDED
    else:
        end, before = start + phases["lift_duration"], IDLE if phases.get("rotors") == "flight" else HOLD
    return PhaseTimes(start, end, AGES if land is None else land, before)


def field_values(channels: Mapping[str, Components], time: Number | Array, phases: PhaseTimes) -> dict[str, Components]:
    """The values of the fields, component by component, 0 where they are not a number.

    Args:
        channels: components of each channel.
        time: [s].
        phases: of a scheduled flight.
    """
    found = {field: next((channels[n] for n in names if n in channels), None) for field, names in CHANNELS.items()}
    values = {field: channel for field, channel in found.items() if channel is not None}
    moment, attitude = Vec3(*channels["push_moment"]), Quat(*values["attitude"])
    values["time"] = (time,)
    values["reference_yaw"] = channels["reference_euler"][2:3]
    values["push_point"] = point_of(Vec3(*values["push"]), moment, attitude)
    values["phase"] = channels["phase"] if "phase" in channels else (_phase_by_clock(time, phases),)
    return {field: tuple(map(_number_or_zero, parts)) for field, parts in values.items()}


def fields_of_samples(layout: object) -> Callable[[Any, Any, PhaseTimes], dict[str, Components]]:
    """The function from a sample laid out like this, its time [s] and the phases to the values of the fields."""
    columns = channel_columns(layout)

    def fields_of(sample: Any, time: Number, phases: PhaseTimes) -> dict[str, Components]:
        numbers = list(_numbers(sample))
        return field_values({name: tuple(numbers[i] for i in at) for name, at in columns.items()}, time, phases)

    return fields_of


def frame_of_samples(layout: object) -> Callable[[Any, Any, PhaseTimes], Components]:
    """The same with all values in one row."""
    fields_of = fields_of_samples(layout)

    def frame(sample: Any, time: Number, phases: PhaseTimes) -> Components:
        return tuple(part for parts in fields_of(sample, time, phases).values() for part in parts)

    return frame


def arrays_of(values: Mapping[str, Components]) -> dict[str, Array]:
    """The values of fields as arrays, their components along the last axis."""
    return {field: np.stack(parts, axis=-1) for field, parts in values.items()}


def point_of(force: Vec3, moment: Vec3, attitude: Quat) -> Vec3:
    """The point of action of a push nearest to the centre of mass [m, body].

    Args:
        force: [N, world].
        moment: about the centre of mass [N m, body].
        attitude: body to world.
    """
    axis = Vec3(-attitude.x, -attitude.y, -attitude.z)
    turned = cross(axis, force) * 2.0
    body = force + turned * attitude.w + cross(axis, turned)
    square = dot(body, body)
    point = cross(body, moment) / maximum(square, MIN_PUSH**2)
    return Vec3(*[where(square > MIN_PUSH**2, along, 0.0) for along in point])


def points_of(forces: Array, moments: Array, attitudes: Array) -> Array:
    """Points of action (T, 3) of pushes; forces (T, 3), moments (T, 3) and attitudes (T, 4) as for `point_of`."""
    return np.stack(point_of(Vec3(*forces.T), Vec3(*moments.T), Quat(*attitudes.T)), axis=1)


def _number_or_zero(x: Number) -> Number:
    return where(absolute(x) >= 0.0, x, 0.0)


def _numbers(value: Any) -> Iterator[Any]:
    """The numbers of a nested value, depth first, as they are."""
    for part in value:
        yield from _numbers(part) if is_value(part) else (part,)


def _phase_by_clock(time: Number | Array, phases: PhaseTimes) -> Number | Array:
    """The phase of a scheduled flight."""
    lifting = where(time >= phases.lift_start, where(time < phases.lift_end, LIFT, GUIDED), phases.before)
    return where(time >= phases.land_start, LAND, lifting)
