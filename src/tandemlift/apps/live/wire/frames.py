"""Frames: what changes from moment to moment, as float32 numbers in little endian, one field after another.

SI units and world axes unless a field says otherwise. Whole numbers, such as `seq`, are exact up to 2²⁴.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

RATE = 60  # frames a second, at most
ECHO = 0.003  # s, within which the flight has followed a move
FRESH = 0.012  # s after an echo, in which a page needs no other frame


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
    table, at = np.frombuffer(data, dtype="<f4").reshape(-1, width_of(layout)), 0
    found = {}
    for name, columns in layout:
        found[name] = table[:, at : at + columns]
        at += columns
    return found
