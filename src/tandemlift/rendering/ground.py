"""What is behind everything: the sky, and a floor with a grid of metres that fades into the haze.

Pixel by pixel in compiled code. A line of the grid colours a pixel by the share of it that it covers, so that the grid
needs no smoothing and far away turns into an even grey.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.rendering.camera import View
from tandemlift.rendering.light import HAZE, SKYLIGHT, SUN, SUNLIGHT, ZENITH, Shadow
from tandemlift.rendering.mesh import linear
from tandemlift.rendering.raster import compiled

Array = NDArray[np.float64]

FLOOR, LINE = linear("#d2d5d8"), linear("#a3abb3")
THIN, THICK = 0.018, 0.04  # width over distance of the lines of every cell, and of every fifth
FAR = 9.0  # distances from the eye to the vehicle at which the floor is half lost in the haze
DARKEST, DIM = 0.75, 0.22  # share of the sun and of the sky that the middle of a shadow keeps out
LEVEL = 1e-4  # slope below the horizon at which the floor is too far to be seen
SLOPE = 2.2  # of the sky's colour over the share of the way that goes up


@compiled
def covered(start: float, blur: float, cell: float, width: float) -> float:
    """Share of the interval from `start` to `start + blur` on lines of a width, one from every multiple of a cell."""
    end = start + blur
    first, last = np.floor(start / cell), np.floor(end / cell)
    before = first * width + min(start - first * cell, width)
    after = last * width + min(end - last * cell, width)
    return (after - before) / blur


@compiled
def free(x: float, blur: float, cell: float) -> float:
    """Share of x ± blur/2 that no line of the grid covers."""
    thin, thick = THIN * cell, THICK * cell
    x -= 0.5 * blur
    return (1.0 - covered(x + 0.5 * thin, blur, cell, thin)) * (1.0 - covered(x + 0.5 * thick, blur, 5.0 * cell, thick))


@compiled
def shade_at(table: Array, row: float, column: float) -> float:
    """A table of shade between its entries; 0 outside."""
    if not (0.0 <= row < table.shape[0] - 1.0 and 0.0 <= column < table.shape[1] - 1.0):
        return 0.0
    i, j = int(row), int(column)
    y, x = row - i, column - j
    upper = table[i, j] * (1.0 - x) + table[i, j + 1] * x
    lower = table[i + 1, j] * (1.0 - x) + table[i + 1, j + 1] * x
    return upper * (1.0 - y) + lower * y


class Floor(NamedTuple):
    """The floor as the eye sees it.

    Its `height` [m], the `cell` of its grid [m], the distance `hazy` at which the haze hides half of it [m], and the
    shadow on it: a table, its lowest corner [m] and its step [m].
    """

    height: float
    cell: float
    hazy: float
    shade: Array
    low: Array
    texel: float


@compiled
def lines_at(floor: Floor, view: View, ray: Any, x: float, y: float) -> float:
    """Share of the pixel that looks along a ray, at (x, y) on the floor [m], that lines of the grid cover."""
    dx, dy, dz = ray
    right, up, _ = view.axes
    # how the place on the floor changes from one pixel to the next, right and up
    step = (floor.height - view.eye[2]) / (dz * view.focal)
    blur_x = step * (abs(right[0] - dx * right[2] / dz) + abs(up[0] - dx * up[2] / dz))
    blur_y = step * (abs(right[1] - dy * right[2] / dz) + abs(up[1] - dy * up[2] / dz))
    return 1.0 - free(x, blur_x, floor.cell) * free(y, blur_y, floor.cell)


@compiled
def paint_floor(light: Array, floor: Floor, view: View, ray: Any) -> None:
    """Fill in the light (3) of the floor where a ray meets it."""
    dx, dy, dz = ray
    reach = (floor.height - view.eye[2]) / dz
    x, y = view.eye[0] + dx * reach, view.eye[1] + dy * reach
    line = lines_at(floor, view, ray, x, y)
    shade = shade_at(floor.shade, (y - floor.low[1]) / floor.texel - 0.5, (x - floor.low[0]) / floor.texel - 0.5)
    way = reach * np.sqrt(dx * dx + dy * dy + dz * dz) / floor.hazy
    haze = 1.0 - np.exp2(-way * way)
    for k in range(3):
        sent = SUN[2] * SUNLIGHT[k] * (1.0 - DARKEST * shade) + SKYLIGHT[k] * (1.0 - DIM * shade)
        here = (FLOOR[k] + (LINE[k] - FLOOR[k]) * line) * sent
        light[k] = here + (HAZE[k] - here) * haze


@compiled
def paint_sky(light: Array, ray: Any) -> None:
    """Fill in the light (3) of the sky along a ray."""
    dx, dy, dz = ray
    share = min(max(SLOPE * dz / np.sqrt(dx * dx + dy * dy + dz * dz), 0.0), 1.0)
    for k in range(3):
        light[k] = HAZE[k] + (ZENITH[k] - HAZE[k]) * share


@compiled
def paint(light: Array, floor: Floor, view: View) -> None:
    """Fill in the light (H, W, 3) of floor and sky."""
    axes = view.axes
    for row in range(view.height):
        up = (view.middle - row - 0.5) / view.focal
        for column in range(view.width):
            right = (column + 0.5 - view.width / 2.0) / view.focal
            ray = (
                right * axes[0, 0] + up * axes[1, 0] + axes[2, 0],
                right * axes[0, 1] + up * axes[1, 1] + axes[2, 1],
                right * axes[0, 2] + up * axes[1, 2] + axes[2, 2],
            )
            if ray[2] > -LEVEL:
                paint_sky(light[row, column], ray)
            else:
                paint_floor(light[row, column], floor, view, ray)


def background(view: View, height: float, distance: float, shadow: Shadow, cell: float) -> Array:
    """Light (H, W, 3) of sky and floor.

    Args:
        view: the eye, above the floor.
        height: of the floor [m].
        distance: how far the eye looks [m].
        shadow: of the vehicle.
        cell: of the grid [m].
    """
    light = np.empty((view.height, view.width, 3))
    paint(light, Floor(height, cell, FAR * distance, shadow.shade, shadow.low, shadow.texel), view)
    return light
