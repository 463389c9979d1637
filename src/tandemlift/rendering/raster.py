"""Triangles to pixels: which is the nearest one in every pixel, in compiled code.

Nearness is larger for what is nearer, and linear over the picture, such as the inverse of the distance ahead.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.common.types import Array
from tandemlift.rendering.pixels import Pixels, array, columns, load_where, store_where
from tandemlift.trace import Function, Graph
from tandemlift.trace.elementary import floor, maximum, minimum, to_integer, where

UNIFORM = ("corner", "row", "height", "width")


class Corner(NamedTuple):
    """Column, row [pixels] and nearness."""

    x: Any
    y: Any
    near: Any


def span(p: Any, q: Any, r: Any, count: Any) -> Any:
    """First pixel, and the one after the last, whose centres may lie between three coordinates; none if one is NaN."""
    low, high = minimum(minimum(p, q), r), maximum(maximum(p, q), r)
    first, after = maximum(0.0, -floor(-(low - 0.5))), minimum(count, floor(high - 0.5) + 1.0)
    total = p + q + r
    return to_integer(first), to_integer(where(total == total, after, 0.0))


def share(a: Corner, b: Corner, c: Corner, row: Any, column: Any) -> Any:
    """Weights of the corners b and c at a pixel's centre; outside of the triangle one of them or of a is negative."""
    x, y = column + 0.5 - a.x, row + 0.5 - a.y
    area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
    return (x * (c.y - a.y) - y * (c.x - a.x)) / area, (y * (b.x - a.x) - x * (b.y - a.y)) / area


def met(a: Corner, b: Corner, c: Corner, row: Any, column: Any, depth: Any) -> Any:
    """Whether a pixel shows a triangle, how near it is there, and the weights of its corners b and c."""
    v, w = share(a, b, c, row, column)
    near = a.near + v * (b.near - a.near) + w * (c.near - a.near)
    return (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0) & (near > depth), near, v, w


@contextmanager
def triangles(g: Graph, f: Function, at: dict[str, str]) -> Iterator[tuple[str, list[Corner]]]:
    """A loop over triangles: the number of each, and its corners."""
    numbers = [g.input("corner", i) for i in range(9)]
    f.read |= {"height": lambda i: at["height"], "width": lambda i: at["width"]}
    corners = array(f, at["corners"])
    with f.repeat(at["count"]) as number:
        triangle = f.at(corners, f.integer("mul", number, 9), "double")
        f.read["corner"] = lambda i: f.load(triangle, i, "double")
        f.values(numbers)  # before pixels are written, which might be the same memory
        yield number, [Corner(*numbers[i : i + 3]) for i in (0, 3, 6)]


@contextmanager
def pixels(g: Graph, f: Function, at: dict[str, str], corners: list[Corner]) -> Iterator[tuple[str, str, list[str]]]:
    """A loop over the pixels of a triangle: which, where it is seen, and there its nearness and weights."""
    height, width, row, column = (g.input(kind, type="i") for kind in ("height", "width", "row", "column"))
    a, b, c = corners
    first, after = span(a.x, b.x, c.x, width)
    seen, *values = met(a, b, c, row, column, g.input("depth"))
    seen, within, depth = seen & (column < after), column < after, array(f, at["depth"])
    top, below, left, right = map(f.scalar, (*span(a.y, b.y, c.y, height), first, after))
    with f.repeat(below, top) as i:
        f.read["row"] = lambda m: i
        with columns(f, left, right) as j:
            pixel = f.integer("add", f.integer("mul", i, at["width"]), j)
            known = load_where(f, f.value(within), f.at(depth, pixel, "double"))[0]
            f.read["depth"] = lambda m: known
            mask = f.value(seen)
            with f.when(f.any(mask)):
                yield pixel, mask, f.values(values)


def _write_nearest(g: Graph, f: Function, at: dict[str, str]) -> None:
    depth, face, weights = (array(f, at[name]) for name in ("depth", "face", "weights"))
    with triangles(g, f, at) as (number, corners), pixels(g, f, at, corners) as (pixel, mask, (near, v, w)):
        store_where(f, mask, [near], f.at(depth, pixel, "double"))
        store_where(f, mask, [f.spread(number, "i64")], f.at(face, pixel, "i64"), "i64")
        store_where(f, mask, [v, w], f.at(weights, f.integer("mul", pixel, 2), "double"))


def _write_glaze(g: Graph, f: Function, at: dict[str, str]) -> None:
    colors, picture = array(f, at["colors"]), array(f, at["picture"])
    *paint, opacity = (g.input("color", i) for i in range(4))
    mixed = [p + opacity * (c - p) for p, c in zip((g.input("light", i) for i in range(4)), [*paint, 1.0], strict=True)]
    with triangles(g, f, at) as (number, corners), pixels(g, f, at, corners) as (pixel, mask, _):
        color = f.at(colors, f.integer("mul", number, 4), "double")
        place = f.at(picture, f.integer("mul", pixel, 4), "double")
        light = load_where(f, mask, place, 4)
        f.read |= {"color": lambda i: f.load(color, i, "double"), "light": lambda i: light[i]}
        store_where(f, mask, f.values(mixed), place)


SIZE = ("count", "height", "width", "corners")
_nearest = Pixels("nearest", (*SIZE, "depth", "face", "weights"), _write_nearest, UNIFORM)
_glaze = Pixels("glaze", (*SIZE, "colors", "depth", "picture"), _write_glaze, (*UNIFORM, "color"))


def nearest(corners: Array, depth: Array, face: NDArray[np.int64], weights: Array) -> None:
    """Enter triangles into the picture so far, where they are nearer than what is there.

    Args:
        corners: (F, 3, 3) column, row [pixels] and nearness; a triangle with a NaN is left out.
        depth: (H, W) nearness of what is seen, 0 where nothing is; updated.
        face: (H, W) index of the triangle seen; updated.
        weights: (H, W, 2) of its second and third corner; updated.
    """
    _nearest(len(corners), *depth.shape, np.ascontiguousarray(corners), depth, face, weights)


def glaze(corners: Array, colors: Array, depth: Array, picture: Array) -> None:
    """Lay see-through triangles over a picture, in their order, where nothing nearer is.

    Args:
        corners: (F, 3, 3) as in `nearest`.
        colors: (F, 4) linear colour and opacity.
        depth: (H, W) nearness of what is opaque.
        picture: (H, W, 4) linear colour times opacity, and opacity; updated.
    """
    _glaze(len(corners), *depth.shape, np.ascontiguousarray(corners), np.ascontiguousarray(colors), depth, picture)
