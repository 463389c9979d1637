"""Frames: what moves, as float32 numbers in little endian, one after another as a scene's `fields` say.

World axes and SI units; the attitude is a unit quaternion w, x, y, z, body to world; points of the body are in body
axes from the centre of mass. Whole numbers, such as `seq`, are exact up to 2²⁴.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

RATE = 60  # frames a second, at most

FIELDS = (
    ("time", 1),  # s
    ("position", 3),  # m, of the centre of mass
    ("attitude", 4),
    ("velocity", 3),  # m/s
    ("reference", 3),  # m
    ("reference_yaw", 1),  # rad
    ("push", 3),  # N, of all hands
    ("push_point", 3),  # m, body axes, where it acts
    ("heard", 3),  # N, the push as the pilot hears it
    ("disturbance", 3),  # N, as the pilot estimates it
    ("wind", 3),  # m/s
    ("phase", 1),  # index into the scene's `phases`
    ("alarm", 1),  # index into its `alarms`
    ("held", 1),  # 1 while a page holds the beam
    ("hand_point", 3),  # m, body axes, where it holds
    ("hand_target", 3),  # m, where it pulls to
    ("seq", 1),  # of the last message of the holder that reached the physics
    ("thrusts", 0),  # N, of every rotor: as many as there are
)

Fields = tuple[tuple[str, int], ...]


def fields_of(rotors: int) -> Fields:
    """Name and number of columns of each field, for a vehicle with so many rotors."""
    return tuple((name, count or rotors) for name, count in FIELDS)


def width_of(fields: Fields) -> int:
    """Numbers in a frame."""
    return sum(count for _, count in fields)


def frames_of(fields: Fields, values: Mapping[str, ArrayLike], count: int = 1) -> NDArray[np.float32]:
    """Frames (count, width) from values by field, each (count, columns) or what spreads to that; others are zero."""
    table, at = np.zeros((count, width_of(fields)), dtype="<f4"), 0
    for name, columns in fields:
        if name in values:
            table[:, at : at + columns] = np.asarray(values[name]).reshape(-1, columns)
        at += columns
    return table


def read_frames(fields: Fields, data: bytes) -> dict[str, NDArray[Any]]:
    """The values (count, columns) of each field in frames that were put one after another."""
    table, at = np.frombuffer(data, dtype="<f4").reshape(-1, width_of(fields)), 0
    found = {}
    for name, columns in fields:
        found[name] = table[:, at : at + columns]
        at += columns
    return found
