"""The background: the sky, and a floor with a metric grid that fades into haze.

Compiled code computes each pixel. A grid line colours a pixel in proportion to the fraction that it covers, so that
the grid needs no supersampling and becomes an even grey in the distance.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import numpy as np

from tandemlift.algebra.layout import flat, rebuilt
from tandemlift.algebra.vector import ZERO, Vec3
from tandemlift.common.types import Array
from tandemlift.rendering.camera import View
from tandemlift.rendering.light import HAZE, SKYLIGHT, SUN, SUNLIGHT, ZENITH, Shadow
from tandemlift.rendering.mesh import linear
from tandemlift.rendering.pixels import LANES, Pixels, array, column_blocks, store_where
from tandemlift.trace import Function, Graph
from tandemlift.trace.elementary import exp, maximum, minimum, sqrt, to_integer, where
from tandemlift.trace.elementary import floor as rounded_down

FLOOR, LINE = linear("#d2d5d8"), linear("#a3abb3")
THIN, THICK = 0.018, 0.04  # line width / cell size, for each cell and for every fifth
FAR = 9.0  # distance at which haze hides half of the floor / distance of the vehicle
DARKEST, DIM = 0.75, 0.22  # fraction of sunlight and of skylight that the umbra blocks
LEVEL = 1e-4  # slope of a ray below the horizon; above it, the ray shows the sky
LOG_2 = 0.6931471805599453
SLOPE = 2.2  # gradient of the sky's colour over the sine of the elevation


def line_coverage(start: Any, blur: Any, cell: Any, width: Any) -> Any:
    """Fraction of the interval from `start` to `start + blur` that lines cover; each starts at a multiple of `cell`."""
    end = start + blur
    first, last = rounded_down(start / cell), rounded_down(end / cell)
    before = first * width + minimum(start - first * cell, width)
    after = last * width + minimum(end - last * cell, width)
    return (after - before) / blur


def uncovered(x: Any, blur: Any, cell: Any) -> Any:
    """Fraction of the interval x ± blur/2 that no grid line covers."""
    thin, thick = THIN * cell, THICK * cell
    x = x - 0.5 * blur
    return (1.0 - line_coverage(x + 0.5 * thin, blur, cell, thin)) * (
        1.0 - line_coverage(x + 0.5 * thick, blur, 5.0 * cell, thick)
    )


class PaintedFloor(NamedTuple):
    """The parameters of the floor.

    Attributes:
        height: of the floor [m].
        cell: size of a grid cell [m].
        hazy: distance at which haze hides half of the floor [m].
        west: smallest x of the shadow map [m].
        south: smallest y of the shadow map [m].
        texel: size of a texel of the shadow map [m].
    """

    height: Any
    cell: Any
    hazy: Any
    west: Any
    south: Any
    texel: Any


class Viewpoint(NamedTuple):
    """A `View` as values that can be traced."""

    place: Vec3
    right: Vec3
    up: Vec3
    ahead: Vec3
    focal: Any
    width: Any
    middle: Any

    @classmethod
    def of(cls, view: View) -> Viewpoint:
        """The viewpoint of a view."""
        place, right, up, ahead = (Vec3(*map(float, v)) for v in (view.eye, *view.axes))
        return cls(place, right, up, ahead, view.focal, view.width, view.middle)

    def ray(self, row: Any, column: Any) -> Vec3:
        """The ray direction through the centre of a pixel."""
        up, right = (self.middle - row - 0.5) / self.focal, (column + 0.5 - self.width / 2.0) / self.focal
        return Vec3(*(right * r + up * u + a for r, u, a in zip(self.right, self.up, self.ahead, strict=True)))


def lines_at(floor: PaintedFloor, eye: Viewpoint, ray: Vec3, x: Any, y: Any) -> Any:
    """Fraction of a pixel that grid lines cover; its ray meets the floor at (x, y) [m]."""
    right, up = eye.right, eye.up
    # footprint of a pixel on the floor
    step = (floor.height - eye.place.z) / (ray.z * eye.focal)
    blur_x = step * (abs(right.x - ray.x * right.z / ray.z) + abs(up.x - ray.x * up.z / ray.z))
    blur_y = step * (abs(right.y - ray.y * right.z / ray.z) + abs(up.y - ray.y * up.z / ray.z))
    return 1.0 - uncovered(x, blur_x, floor.cell) * uncovered(y, blur_y, floor.cell)


def texel_at(floor: PaintedFloor, x: Any, y: Any, rows: Any, columns: Any) -> Any:
    """(Whether the shadow map covers a point of the floor, the index of its texel, its fractions of the texel)."""
    row, column = (y - floor.south) / floor.texel - 0.5, (x - floor.west) / floor.texel - 0.5
    known = (row >= 0.0) & (row < rows - 1.0) & (column >= 0.0) & (column < columns - 1.0)
    row, column = where(known, row, 0.0), where(known, column, 0.0)
    i, j = to_integer(row), to_integer(column)
    return known, i * columns + j, row - i, column - j


def shade_at(known: Any, corners: Any, y: Any, x: Any) -> Any:
    """The shade interpolated between four texels of the shadow map; 0 outside of the map."""
    a, b, c, d = corners
    upper, lower = a * (1.0 - x) + b * x, c * (1.0 - x) + d * x
    return where(known, upper * (1.0 - y) + lower * y, 0.0)


def floor_light(floor: PaintedFloor, ray: Vec3, reach: Any, line: Any, shade: Any) -> list[Any]:
    """Light (3) from the floor along a ray."""
    way = reach * sqrt(ray.x * ray.x + ray.y * ray.y + ray.z * ray.z) / floor.hazy
    haze = 1.0 - exp(-way * way * LOG_2)
    light = []
    for k in range(3):
        sent = SUN[2] * SUNLIGHT[k] * (1.0 - DARKEST * shade) + SKYLIGHT[k] * (1.0 - DIM * shade)
        here = (FLOOR[k] + (LINE[k] - FLOOR[k]) * line) * sent
        light.append(here + (HAZE[k] - here) * haze)
    return light


def sky_light(ray: Vec3) -> list[Any]:
    """Light (3) from the sky along a ray."""
    part = SLOPE * ray.z / sqrt(ray.x * ray.x + ray.y * ray.y + ray.z * ray.z)
    part = minimum(maximum(part, 0.0), 1.0)
    return [HAZE[k] + (ZENITH[k] - HAZE[k]) * part for k in range(3)]


def _traced(g: Graph) -> tuple[list[Any], Any]:
    """(The light (3) of a pixel, the index of its texel); the four texels there are the inputs `shade`."""
    numbers = (g.input("number", i) for i in itertools.count())
    floor = rebuilt(numbers, PaintedFloor(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    eye = rebuilt(numbers, Viewpoint(ZERO, ZERO, ZERO, ZERO, 0.0, 0.0, 0.0))
    ray = eye.ray(g.input("row", type="i"), g.input("column", type="i"))
    down = ray.z <= -LEVEL
    below = ray._replace(z=where(down, ray.z, -1.0))
    reach = (floor.height - eye.place.z) / below.z
    x, y = eye.place.x + below.x * reach, eye.place.y + below.y * reach
    inside, entry, v, u = texel_at(floor, x, y, *(g.input(kind, type="i") for kind in ("rows", "columns")))
    shade = shade_at(inside, [g.input("shade", i) for i in range(4)], v, u)
    ground = floor_light(floor, below, reach, lines_at(floor, eye, below, x, y), shade)
    return [where(down, a, b) for a, b in zip(ground, sky_light(ray), strict=True)], entry


def _gathered(f: Function, table: str, entries: str, beyond: str | int) -> str:
    """The numbers of a table at the offset `beyond` from each entry."""
    found = "poison"
    for lane in range(LANES):
        entry = f.integer("add", f.op(f"extractelement <{LANES} x i64> {entries}, i64 {lane}"), beyond)
        found = f.op(f"insertelement {f.vector} {found}, double {f.load(table, entry, 'double')}, i64 {lane}")
    return found


def _write_paint(g: Graph, f: Function, at: dict[str, str]) -> None:
    light, entry = _traced(g)
    numbers, shade, picture = (array(f, at[name]) for name in ("numbers", "shade", "light"))
    f.read |= {"rows": lambda i: at["rows"], "columns": lambda i: at["columns"], "width": lambda i: at["width"]}
    f.read["number"] = lambda i: f.load(numbers, i, "double")
    next_row = f.integer("add", at["columns"], 1)
    within = g.input("column", type="i") < g.input("width", type="i")
    with f.repeat(at["height"]) as row:
        f.read["row"] = lambda i: row
        with column_blocks(f, "0", at["width"]) as first:
            entries = f.value(entry)
            beyond = ["0", "1", at["columns"], next_row]
            f.read["shade"] = lambda i: _gathered(f, shade, entries, beyond[i])
            place = f.integer("mul", f.integer("add", f.integer("mul", row, at["width"]), first), 3)
            store_where(f, f.value(within), f.values(light), f.at(picture, place, "double"))


paint = Pixels(
    "paint",
    ("height", "width", "rows", "columns", "numbers", "shade", "light"),
    _write_paint,
    ("number", "rows", "columns", "row", "width"),
)


def background(view: View, height: float, distance: float, shadow: Shadow, cell: float) -> Array:
    """Light (H, W, 3) of sky and floor.

    Args:
        view: the view, from above the floor.
        height: of the floor [m].
        distance: from the camera to its target [m].
        shadow: of the vehicle.
        cell: size of a grid cell [m].
    """
    west, south = shadow.low
    floor = PaintedFloor(height, cell, FAR * distance, west, south, shadow.texel)
    light = np.empty((view.height, view.width, 3))
    paint(*light.shape[:2], *shadow.shade.shape, np.array(flat(floor) + flat(Viewpoint.of(view))), shadow.shade, light)
    return light
