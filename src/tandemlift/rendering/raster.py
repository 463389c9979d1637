"""Rasterization of triangles with a depth buffer, in compiled code.

Depth is stored as nearness, such as the inverse depth: it is larger for a nearer point, and linear over the picture.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.common.types import Array
from tandemlift.rendering.pixels import Pixels, array, column_blocks, load_where, store_where
from tandemlift.trace import Function, Graph
from tandemlift.trace.elementary import floor, maximum, minimum, to_integer, where

UNIFORM = ("corner", "row", "height", "width")


class Corner(NamedTuple):
    """A projected corner: column, row [pixels] and nearness."""

    x: Any
    y: Any
    near: Any


def pixel_range(p: Any, q: Any, r: Any, count: Any) -> Any:
    """First pixel within three coordinates, and the one after the last; an empty range if a coordinate is NaN."""
    low, high = minimum(minimum(p, q), r), maximum(maximum(p, q), r)
    first, after = maximum(0.0, -floor(-(low - 0.5))), minimum(count, floor(high - 0.5) + 1.0)
    total = p + q + r
    return to_integer(first), to_integer(where(total == total, after, 0.0))


def barycentric(a: Corner, b: Corner, c: Corner, row: Any, column: Any) -> Any:
    """Barycentric weights of the corners b and c at a pixel's centre."""
    x, y = column + 0.5 - a.x, row + 0.5 - a.y
    area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
    return (x * (c.y - a.y) - y * (c.x - a.x)) / area, (y * (b.x - a.x) - x * (b.y - a.y)) / area


def depth_test(a: Corner, b: Corner, c: Corner, row: Any, column: Any, depth: Any) -> Any:
    """(Whether the triangle is visible at a pixel, its nearness there, the weights of its corners b and c)."""
    v, w = barycentric(a, b, c, row, column)
    near = a.near + v * (b.near - a.near) + w * (c.near - a.near)
    return (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0) & (near > depth), near, v, w


@contextmanager
def each_triangle(g: Graph, f: Function, at: dict[str, str]) -> Iterator[tuple[str, list[Corner]]]:
    """A loop over triangles; yields the index and the corners of each."""
    numbers = [g.input("corner", i) for i in range(9)]
    f.read |= {"height": lambda i: at["height"], "width": lambda i: at["width"]}
    corners = array(f, at["corners"])
    with f.repeat(at["count"]) as number:
        triangle = f.at(corners, f.integer("mul", number, 9), "double")
        f.read["corner"] = lambda i: f.load(triangle, i, "double")
        f.values(numbers)  # before pixels are written, as the arrays might alias
        yield number, [Corner(*numbers[i : i + 3]) for i in (0, 3, 6)]


@contextmanager
def each_pixel(
    g: Graph, f: Function, at: dict[str, str], corners: list[Corner]
) -> Iterator[tuple[str, str, list[str]]]:
    """A loop over blocks of a triangle's pixels; yields the first pixel, the mask, and nearness and weights."""
    height, width, row, column = (g.input(kind, type="i") for kind in ("height", "width", "row", "column"))
    a, b, c = corners
    first, after = pixel_range(a.x, b.x, c.x, width)
    seen, *values = depth_test(a, b, c, row, column, g.input("depth"))
    seen, within, depth = seen & (column < after), column < after, array(f, at["depth"])
    top, below, left, right = map(f.scalar, (*pixel_range(a.y, b.y, c.y, height), first, after))
    with f.repeat(below, top) as i:
        f.read["row"] = lambda m: i
        with column_blocks(f, left, right) as j:
            pixel = f.integer("add", f.integer("mul", i, at["width"]), j)
            known = load_where(f, f.value(within), f.at(depth, pixel, "double"))[0]
            f.read["depth"] = lambda m: known
            mask = f.value(seen)
            with f.when(f.any(mask)):
                yield pixel, mask, f.values(values)


def _write_rasterize(g: Graph, f: Function, at: dict[str, str]) -> None:
    depth, face, weights = (array(f, at[name]) for name in ("depth", "face", "weights"))
    with each_triangle(g, f, at) as (number, corners), each_pixel(g, f, at, corners) as (pixel, mask, (near, v, w)):
        store_where(f, mask, [near], f.at(depth, pixel, "double"))
        store_where(f, mask, [f.spread(number, "i64")], f.at(face, pixel, "i64"), "i64")
        store_where(f, mask, [v, w], f.at(weights, f.integer("mul", pixel, 2), "double"))


def _write_blend(g: Graph, f: Function, at: dict[str, str]) -> None:
    colors, picture = array(f, at["colors"]), array(f, at["picture"])
    *paint, opacity = (g.input("color", i) for i in range(4))
    mixed = [p + opacity * (c - p) for p, c in zip((g.input("light", i) for i in range(4)), [*paint, 1.0], strict=True)]
    with each_triangle(g, f, at) as (number, corners), each_pixel(g, f, at, corners) as (pixel, mask, _):
        color = f.at(colors, f.integer("mul", number, 4), "double")
        place = f.at(picture, f.integer("mul", pixel, 4), "double")
        light = load_where(f, mask, place, 4)
        f.read |= {"color": lambda i: f.load(color, i, "double"), "light": lambda i: light[i]}
        store_where(f, mask, f.values(mixed), place)


SIZE = ("count", "height", "width", "corners")
_rasterize = Pixels("rasterize", (*SIZE, "depth", "face", "weights"), _write_rasterize, UNIFORM)
_blend = Pixels("blend", (*SIZE, "colors", "depth", "picture"), _write_blend, (*UNIFORM, "color"))


def rasterize(corners: Array, depth: Array, face: NDArray[np.int64], weights: Array) -> None:
    """Rasterize triangles into the buffers, where they are nearer than the triangles already there.

    Args:
        corners: (F, 3, 3) column, row [pixels] and nearness; a triangle with a NaN is skipped.
        depth: (H, W) nearness of the visible triangle, 0 for none; updated.
        face: (H, W) index of the visible triangle; updated.
        weights: (H, W, 2) barycentric weights of its second and third corner; updated.
    """
    _rasterize(len(corners), *depth.shape, np.ascontiguousarray(corners), depth, face, weights)


def blend(corners: Array, colors: Array, depth: Array, picture: Array) -> None:
    """Blend translucent triangles over a picture, in their order, where no opaque triangle is nearer.

    Args:
        corners: (F, 3, 3) as in `rasterize`.
        colors: (F, 4) linear colour and opacity.
        depth: (H, W) nearness of the opaque triangles.
        picture: (H, W, 4) premultiplied linear colour, and opacity; updated.
    """
    _blend(len(corners), *depth.shape, np.ascontiguousarray(corners), np.ascontiguousarray(colors), depth, picture)
