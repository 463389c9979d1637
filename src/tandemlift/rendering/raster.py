"""Triangles to pixels: which is the nearest one in every pixel, in compiled code.

Nearness is larger for what is nearer, and linear over the picture, such as the inverse of the distance ahead.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

compiled = numba.njit(nogil=True, error_model="numpy")


@compiled
def _span(p: float, q: float, r: float, count: int) -> Any:
    """First pixel, and the one after the last, whose centres may lie between three coordinates."""
    return max(0, int(np.ceil(min(p, q, r) - 0.5))), min(count, int(np.floor(max(p, q, r) - 0.5)) + 1)


@compiled
def _share(a: Array, b: Array, c: Array, row: int, column: int) -> Any:
    """Weights of the corners b and c at a pixel's centre; outside of the triangle one of them or of a is negative."""
    x, y = column + 0.5 - a[0], row + 0.5 - a[1]
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (x * (c[1] - a[1]) - y * (c[0] - a[0])) / area, (y * (b[0] - a[0]) - x * (b[1] - a[1])) / area


@compiled
def nearest(corners: Array, depth: Array, face: Any, weights: Array) -> None:
    """Enter triangles into the picture so far, where they are nearer than what is there.

    Args:
        corners: (F, 3, 3) column, row [pixels] and nearness; a triangle with a NaN is left out.
        depth: (H, W) nearness of what is seen, 0 where nothing is; updated.
        face: (H, W) index of the triangle seen; updated.
        weights: (H, W, 2) of its second and third corner; updated.
    """
    height, width = depth.shape
    for f in range(len(corners)):
        a, b, c = corners[f]
        if np.isnan(a[2] + b[2] + c[2]):
            continue
        top, below = _span(a[1], b[1], c[1], height)
        left, after = _span(a[0], b[0], c[0], width)
        for row in range(top, below):
            for column in range(left, after):
                v, w = _share(a, b, c, row, column)
                near = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2])
                if v >= 0.0 and w >= 0.0 and v + w <= 1.0 and near > depth[row, column]:
                    depth[row, column], face[row, column] = near, f
                    weights[row, column, 0], weights[row, column, 1] = v, w


@compiled
def glaze(corners: Array, colors: Array, depth: Array, picture: Array) -> None:
    """Lay see-through triangles over a picture, in their order, where nothing nearer is.

    Args:
        corners: (F, 3, 3) as in `nearest`.
        colors: (F, 4) linear colour and opacity.
        depth: (H, W) nearness of what is opaque.
        picture: (H, W, 4) linear colour times opacity, and opacity; updated.
    """
    height, width = depth.shape
    for f in range(len(corners)):
        a, b, c = corners[f]
        if np.isnan(a[2] + b[2] + c[2]):
            continue
        top, below = _span(a[1], b[1], c[1], height)
        left, after = _span(a[0], b[0], c[0], width)
        for row in range(top, below):
            for column in range(left, after):
                v, w = _share(a, b, c, row, column)
                near = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2])
                if v >= 0.0 and w >= 0.0 and v + w <= 1.0 and near > depth[row, column]:
                    for k in range(3):
                        picture[row, column, k] += colors[f, 3] * (colors[f, k] - picture[row, column, k])
                    picture[row, column, 3] += colors[f, 3] * (1.0 - picture[row, column, 3])
