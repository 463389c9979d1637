"""Light: a sun, a sky and the floor's reflection, and the shadow that the vehicle throws.

Colours are linear proportions of light; `coded` turns them into what a file holds.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tandemlift.common.types import Array
from tandemlift.rendering.mesh import linear
from tandemlift.rendering.raster import nearest

SUN = np.array([0.35, -0.42, 0.84]) / np.linalg.norm([0.35, -0.42, 0.84])  # the direction it stands in
SUNLIGHT, SKYLIGHT, FLOORLIGHT = np.array([0.82, 0.78, 0.71]), np.array([0.30, 0.34, 0.40]), np.array([0.2, 0.19, 0.18])
SHINE, GLOSS = 0.16, 30.0  # strength and exponent of the highlight
PENUMBRA = 0.035  # width of a shadow's edge over the height of what throws it
TEXEL = 0.003  # m, at least
FINEST = 500  # texels each way, at most
BIAS = 0.02  # m: what is less far above throws no shadow, or every surface would shade itself
HAZE, ZENITH = linear("#e9edf1"), linear("#a9c4de")


class Shadow:
    """Where the sun does not reach, seen along its rays on the plane of the floor.

    Args:
        corners: of the triangles in its way (F, 3, 3) [m, world axes].
        floor: height of the floor [m].
    """

    def __init__(self, corners: Array, floor: float) -> None:
        places = self._along_sun(corners, floor)
        low, high = places.reshape(-1, 2).min(axis=0) - 0.3, places.reshape(-1, 2).max(axis=0) + 0.3
        self.texel = max(TEXEL, float((high - low).max()) / FINEST)
        columns, rows = np.ceil((high - low) / self.texel).astype(int)
        self.low, self.floor = low, floor
        self.height = np.zeros((rows, columns))
        face, weights = np.zeros((rows, columns), np.int64), np.zeros((rows, columns, 2))
        above = corners[..., 2:] - floor
        nearest(np.concatenate([(places - low) / self.texel, above], axis=-1), self.height, face, weights)
        width = 0.02 + PENUMBRA * float(above.mean())
        self.shade = blurred((self.height > 0.0).astype(float), max(1, round(width / self.texel)))

    def _along_sun(self, points: Array, floor: float) -> Array:
        """Where the sun's rays through points meet the floor (…, 2) [m]."""
        return points[..., :2] - SUN[:2] / SUN[2] * (points[..., 2:] - floor)

    def _texels(self, points: Array) -> tuple[Array, Array, Array]:
        """Row and column of points, and whether they are on the map."""
        column, row = np.moveaxis((self._along_sun(points, self.floor) - self.low) / self.texel - 0.5, -1, 0)
        rows, columns = self.height.shape
        return row, column, (row > 0.0) & (row < rows - 2.0) & (column > 0.0) & (column < columns - 2.0)

    def on_parts(self, points: Array) -> Array:
        """Share of the sun that is kept from points of the vehicle (…, 3)."""
        row, column, known = self._texels(points)
        i, j = np.where(known, row, 1.0).astype(int), np.where(known, column, 1.0).astype(int)
        height = points[..., 2] - self.floor + BIAS
        hidden = sum((self.height[i + a, j + b] > height).astype(float) for a in (0, 1) for b in (0, 1))
        return np.where(known, hidden / 4.0, 0.0)


def blurred(table: Array, width: int) -> Array:
    """A table smoothed by three running means of a width each way, close to a Gaussian."""
    for axis in (0, 1, 0, 1, 0, 1):
        before = [(width // 2 + 1, width - 1 - width // 2) if k == axis else (0, 0) for k in (0, 1)]
        sums = np.pad(table, before).cumsum(axis=axis)
        high = sums.take(range(width, sums.shape[axis]), axis=axis)
        table = (high - sums.take(range(sums.shape[axis] - width), axis=axis)) / width
    return table


def lit(colors: Array, normals: Array, ahead: Array, shade: Array) -> Array:
    """Light (n, 3) that surfaces send to the eye.

    Args:
        colors: of the surfaces (n, 3).
        normals: across them (n, 3); zero for what shines by itself.
        ahead: unit vectors in which the eye looks at them (n, 3).
        shade: share of the sun that is kept from them (n).
    """
    plain = (normals == 0.0).all(axis=1, keepdims=True)
    normals = normals * -np.sign((normals * ahead).sum(axis=1))[:, None]  # towards the eye
    sun = np.maximum(normals @ SUN, 0.0) * (1.0 - shade)
    half = SUN - ahead
    half /= np.linalg.norm(half, axis=1)[:, None]
    shine = SHINE * np.maximum((normals * half).sum(axis=1), 0.0) ** GLOSS * (sun > 0.0)
    up = 0.5 + 0.5 * normals[:, 2:]
    light = colors * (sun[:, None] * SUNLIGHT + up * SKYLIGHT + (1.0 - up) * FLOORLIGHT) + shine[:, None]
    return np.where(plain, colors, light)


def coded(light: Array) -> NDArray[np.uint8]:
    """Light as sRGB (IEC 61966-2-1), 0 to 255."""
    v = np.clip(light, 0.0, 1.0)
    return np.round(255.0 * np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1.0 / 2.4) - 0.055)).astype(np.uint8)
