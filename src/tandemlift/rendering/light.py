"""Lighting: sun, sky, reflection from the floor, and the vehicle's shadow.

Colours are linear RGB; `to_srgb` encodes them for a file.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tandemlift.common.types import Array
from tandemlift.rendering.mesh import linear
from tandemlift.rendering.raster import rasterize

SUN = np.array([0.35, -0.42, 0.84]) / np.linalg.norm([0.35, -0.42, 0.84])  # unit vector towards the sun
SUNLIGHT, SKYLIGHT, FLOORLIGHT = np.array([0.82, 0.78, 0.71]), np.array([0.30, 0.34, 0.40]), np.array([0.2, 0.19, 0.18])
SHINE, GLOSS = 0.16, 30.0  # strength and exponent of the highlight
PENUMBRA = 0.035  # width of a shadow's edge / height of the part that casts it
TEXEL = 0.003  # m, smallest texel of the shadow map
FINEST = 500  # largest number of texels in each direction
BIAS = 0.02  # m, shadow bias: a part less far above casts no shadow, or surfaces would shade themselves
HAZE, ZENITH = linear("#e9edf1"), linear("#a9c4de")


class Shadow:
    """The shadow map of the vehicle, on the plane of the floor along the sun's rays.

    Args:
        corners: of the triangles that cast the shadow (F, 3, 3) [m, world axes].
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
        rasterize(np.concatenate([(places - low) / self.texel, above], axis=-1), self.height, face, weights)
        width = 0.02 + PENUMBRA * float(above.mean())
        self.shade = blurred((self.height > 0.0).astype(float), max(1, round(width / self.texel)))

    def _along_sun(self, points: Array, floor: float) -> Array:
        """The points (…, 2) [m] at which the sun's rays through `points` meet the floor."""
        return points[..., :2] - SUN[:2] / SUN[2] * (points[..., 2:] - floor)

    def _texels(self, points: Array) -> tuple[Array, Array, Array]:
        """Row and column of points (…, 3), and whether the map covers them."""
        column, row = np.moveaxis((self._along_sun(points, self.floor) - self.low) / self.texel - 0.5, -1, 0)
        rows, columns = self.height.shape
        return row, column, (row > 0.0) & (row < rows - 2.0) & (column > 0.0) & (column < columns - 2.0)

    def shade_on(self, points: Array) -> Array:
        """Fraction of sunlight that is blocked at points of the vehicle (…, 3)."""
        row, column, known = self._texels(points)
        i, j = np.where(known, row, 1.0).astype(int), np.where(known, column, 1.0).astype(int)
        height = points[..., 2] - self.floor + BIAS
        hidden = sum((self.height[i + a, j + b] > height).astype(float) for a in (0, 1) for b in (0, 1))
        return np.where(known, hidden / 4.0, 0.0)


def blurred(table: Array, width: int) -> Array:
    """A table smoothed by three running means in each direction, close to a Gaussian."""
    for axis in (0, 1, 0, 1, 0, 1):
        before = [(width // 2 + 1, width - 1 - width // 2) if k == axis else (0, 0) for k in (0, 1)]
        sums = np.pad(table, before).cumsum(axis=axis)
        high = sums.take(range(width, sums.shape[axis]), axis=axis)
        table = (high - sums.take(range(sums.shape[axis] - width), axis=axis)) / width
    return table


def reflected_light(colors: Array, normals: Array, ahead: Array, shade: Array) -> Array:
    """Light (n, 3) that surfaces reflect towards the camera (Blinn-Phong).

    Args:
        colors: of the surfaces (n, 3).
        normals: unit normals (n, 3); zero for an emissive surface.
        ahead: unit vectors of the view rays (n, 3).
        shade: fraction of sunlight that is blocked (n).
    """
    plain = (normals == 0.0).all(axis=1, keepdims=True)
    normals = normals * -np.sign((normals * ahead).sum(axis=1))[:, None]  # towards the camera
    sun = np.maximum(normals @ SUN, 0.0) * (1.0 - shade)
    half = SUN - ahead
    half /= np.linalg.norm(half, axis=1)[:, None]
    shine = SHINE * np.maximum((normals * half).sum(axis=1), 0.0) ** GLOSS * (sun > 0.0)
    up = 0.5 + 0.5 * normals[:, 2:]
    light = colors * (sun[:, None] * SUNLIGHT + up * SKYLIGHT + (1.0 - up) * FLOORLIGHT) + shine[:, None]
    return np.where(plain, colors, light)


def to_srgb(light: Array) -> NDArray[np.uint8]:
    """Light as sRGB (IEC 61966-2-1), 0 to 255."""
    v = np.clip(light, 0.0, 1.0)
    return np.round(255.0 * np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1.0 / 2.4) - 0.055)).astype(np.uint8)
