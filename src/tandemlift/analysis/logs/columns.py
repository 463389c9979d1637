"""From the columns of a table to a stream by a way of a map, and back: offsets, powers, units, signs, angles and axes.

Readers use one direction. Corrections of a map undo what it did to a stream and do it again by the corrected map.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tandemlift.analysis.logs.log import (
    MOTION,
    Stream,
    conjugate,
    quaternion_product,
    rotated,
    rotation_vectors,
    stream_channel,
)
from tandemlift.analysis.logs.maps import ROTATION_VECTOR, Way, factor_of
from tandemlift.core.types import Array


def stream_of(name: str, way: Way, columns: Stream) -> Stream:
    """A stream in our units and axes, at the times of its sampling.

    Args:
        name: of the stream.
        way: to it, in a map.
        columns: the numbers as they are in the table, with the stamps [s].
    """
    time, values = columns
    offset, factor = _numbers(way, values.shape[1])
    values = values + offset if np.any(offset != 0.0) else values
    values = np.sign(values) * np.abs(values) ** way.power if way.power != 1.0 else values
    values = values * factor if np.any(factor != 1.0) else values
    values = quaternions_of(values, way.angles) if way.angles else values
    if stream_channel(name).width > 1:
        values = _z_up(values) if way.up == "y" else values
        values = _turned(name, values, turned_by(way.turn)) if any(way.turn) else values
    return Stream(time - way.delay if way.delay else time, values)


def columns_of(name: str, way: Way, stream: Stream) -> Stream:
    """The numbers in the table, and their stamps [s], of which `stream_of` makes a stream.

    Angles come without whole turns.
    """
    time, values = stream
    if stream_channel(name).width > 1:
        values = _turned(name, values, conjugate(turned_by(way.turn))) if any(way.turn) else values
        values = _z_up(values, back=True) if way.up == "y" else values
    values = angles_of(values, way.angles) if way.angles else values
    offset, factor = _numbers(way, values.shape[1])
    values = values / factor
    values = np.sign(values) * np.abs(values) ** (1.0 / way.power) if way.power != 1.0 else values
    return Stream(time + way.delay, values - offset)


def _numbers(way: Way, width: int) -> tuple[Array, Array]:
    """(Offsets, factors) (width,) of the columns; of several topics those of one are repeated."""
    offset, scale = (np.resize(np.array(number, dtype=float), width) for number in (way.offset, way.scale))
    return offset, scale * factor_of(way.unit)


def _z_up(values: Array, *, back: bool = False) -> Array:
    """Vectors, or quaternions, in axes with y up in ours: x stays, y becomes z, and z −y."""
    values, sign = values.copy(), -1.0 if back else 1.0
    for axis in range(values.shape[1] % 3, values.shape[1], 3):  # of a quaternion, after its real part
        y, z = values[:, axis + 1].copy(), values[:, axis + 2].copy()
        values[:, axis + 1], values[:, axis + 2] = -sign * z, sign * y
    return values


def turned_by(degrees: Sequence[float]) -> Array:
    """The quaternion of a rotation vector [deg]."""
    return quaternions_of(np.radians([degrees]), ROTATION_VECTOR)[0]


def _turned(name: str, values: Array, q: Array) -> Array:
    """Vectors of a sensor whose axes are turned by q from the body's, or attitudes of such axes, for the body's."""
    if name == MOTION[2]:
        return quaternion_product(values, np.tile(conjugate(q), (len(values), 1)))
    parts = values.reshape(-1, 3)
    return rotated(np.tile(q, (len(parts), 1)), parts).reshape(values.shape)


def quaternions_of(angles: Array, kind: str) -> Array:
    """Quaternions w, x, y, z (n, 4) of angles (n, 3) [rad]; `kind`: as `Way.angles`."""
    if kind == ROTATION_VECTOR:
        size = np.linalg.norm(angles, axis=1, keepdims=True)
        return np.hstack([np.cos(0.5 * size), 0.5 * np.sinc(size / (2.0 * np.pi)) * angles])
    turns = []
    for angle, letter in zip(angles.T, kind.lower(), strict=True):
        turn = np.zeros((len(angle), 4))
        turn[:, 0], turn[:, 1 + "xyz".index(letter)] = np.cos(0.5 * angle), np.sin(0.5 * angle)
        turns.append(turn)
    a, b, c = turns if kind.isupper() else turns[::-1]
    return quaternion_product(quaternion_product(a, b), c)


def angles_of(q: Array, kind: str) -> Array:
    """Angles (n, 3) [rad] without whole turns of quaternions w, x, y, z (n, 4); `kind`: as `Way.angles`.

    Source: Bernardes and Viollet, Quaternion to Euler angles conversion, PLOS ONE 17 (2022).
    """
    if kind == ROTATION_VECTOR:
        return rotation_vectors(q)
    i, j, k = ("xyz".index(letter) for letter in (kind if kind.islower() else kind[::-1].lower()))
    is_proper, k = i == k, 3 - i - j
    sign = (i - j) * (j - k) * (k - i) / 2
    w, x, y, z = q[:, 0], q[:, 1 + i], q[:, 1 + j], q[:, 1 + k] * sign
    a, b, c, d = (w, x, y, z) if is_proper else (w - y, x + z, y + w, z - x)
    middle = 2.0 * np.arctan2(np.hypot(c, d), np.hypot(a, b))
    half_sum, half_difference = np.arctan2(b, a), np.arctan2(d, c)
    first, last = half_sum - half_difference, half_sum + half_difference
    angles = (first, middle, last) if is_proper else (first, middle - 0.5 * np.pi, sign * last)
    return np.unwrap(np.column_stack(angles if kind.islower() else angles[::-1]), axis=0)
