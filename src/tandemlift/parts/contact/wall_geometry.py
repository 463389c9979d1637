"""Upright rectangles from the ground to a top: the offset of a point from them, and the nearest of several.

World axes. A rectangle of numbers serves one point, one of sets serves a set of points, each its own.
"""

from typing import NamedTuple

from tandemlift.core.algebra import absolute, clip, least, maximum, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number, NumberSet, number
from tandemlift.core.vector import Vec3, dot, set_of

SEAM = 1e-8  # m²: rectangles nearer to each other than this are joined there
AWAY = 1e6  # m, place of a rectangle that stands for none
HIDDEN = 1e30  # m², more than any distance


class Wall(NamedTuple):
    """Start x, y [m], from there to its end [m], 1 over the square of its length [1/m²], top [m].

    A wall of no length is an edge, with 0 for 1 over its square.
    """

    x: Number
    y: Number
    along_x: Number
    along_y: Number
    per_square: Number
    top: Number


WALL = Wall(AWAY, AWAY, 0.0, 0.0, 0.0, -AWAY)  # nowhere


def no_walls(count: int) -> Wall:
    """A wall that is nowhere for each of `count` points, as sets."""
    return Wall(*[set_of([value] * count) for value in WALL])


def wall(start: tuple[float, float], end: tuple[float, float], top: float) -> Wall:
    """The wall from `start` to `end` (x, y) [m] with its `top` at z [m]; a post if they are the same."""
    x, y = end[0] - start[0], end[1] - start[1]
    square = x * x + y * y
    per_square = where(square > SEAM, 1.0 / where(square > SEAM, square, 1.0), 0.0)
    return Wall(number(start[0]), number(start[1]), number(x), number(y), per_square, number(top))


@elementwise
def fraction_along(
    p_x: Number, p_y: Number, x: Number, y: Number, along_x: Number, along_y: Number, per_square: Number
) -> Number:
    """The place on a wall nearest to p, from 0 at its start to 1 at its end."""
    return clip(((p_x - x) * along_x + (p_y - y) * along_y) * per_square, 0.0, 1.0)


@elementwise
def coordinate_offset(p: Number, start: Number, along: Number, fraction: Number) -> Number:
    """One coordinate of the offset of p from a point of a wall."""
    return p - start - along * fraction


@elementwise
def height_above_top(z: Number, top: Number) -> Number:
    """Height of z above the top [m], 0 below it."""
    return maximum(z - top, 0.0)


@elementwise
def height_from_top(z: Number, top: Number) -> Number:
    """Height of z above the top [m]."""
    return z - top


@law
def offset(wall: Wall, p: Vec3) -> Vec3:
    """Offset of p from the nearest point of a wall [m]."""
    fraction = fraction_along(p.x, p.y, wall.x, wall.y, wall.along_x, wall.along_y, wall.per_square)
    return Vec3(
        coordinate_offset(p.x, wall.x, wall.along_x, fraction),
        coordinate_offset(p.y, wall.y, wall.along_y, fraction),
        height_above_top(p.z, wall.top),
    )


@law
def offset_from_top(wall: Wall, p: Vec3) -> Vec3:
    """Offset of p from the nearest point of a wall's top edge [m]."""
    o = offset(wall, p)
    return Vec3(o.x, o.y, height_from_top(p.z, wall.top))


@law
def edges_of(wall: Wall) -> tuple[Wall, Wall]:
    """The upright edges at its start and at its end."""
    start = wall._replace(along_x=0.0, along_y=0.0, per_square=0.0)
    return start, start._replace(x=wall.x + wall.along_x, y=wall.y + wall.along_y)


@elementwise
def selected(d: Number, limit: Number, a: Number, b: Number) -> Number:
    """a where d < limit, else b."""
    return where(d < limit, a, b)


@elementwise
def number_at(value: Number, limit: Number, number: Number, none: Number) -> Number:
    """The number of what reaches a limit, such as the part with the greatest normal force, else `none`."""
    return where(value >= limit, number, none)


@elementwise
def if_number(number: Number, wanted: Number, value: Number) -> Number:
    """The value if the number is the `wanted` one, else 0."""
    return where(absolute(number - wanted) < 0.5, value, 0.0)


@law
def first_number(values: NumberSet, limit: Number) -> Number:
    """The number, counted from 1, of the first value of a set that reaches a limit."""
    count = len(values)
    return least(number_at(values, limit, numbers(count), 1.0 + count))


@law
def only_number(values: NumberSet, wanted: Number) -> NumberSet:
    """A set of values with 0 in the place of all but the one with the `wanted` number, counted from 1."""
    kept: NumberSet = if_number(numbers(len(values)), wanted, values)
    return kept


def numbers(count: int) -> NumberSet:
    """1, 2, 3, … as a set."""
    return set_of([1.0 + i for i in range(count)])


@law
def selected_wall(d: Number, limit: Number, a: Wall, b: Wall) -> Wall:
    """The wall a where d < limit, else b."""
    return Wall(
        selected(d, limit, a.x, b.x),
        selected(d, limit, a.y, b.y),
        selected(d, limit, a.along_x, b.along_x),
        selected(d, limit, a.along_y, b.along_y),
        selected(d, limit, a.per_square, b.per_square),
        selected(d, limit, a.top, b.top),
    )


@law
def nearer(wall: Wall, other: Wall, p: Vec3, q: Vec3) -> Wall:
    """The nearer of two walls; the distance of the first is taken from p, that of the other from q."""
    d, e = offset(wall, p), offset(other, q)
    return selected_wall(dot(d, d), dot(e, e), wall, other)


@law
def two_nearest_to(p: Vec3, wall: Wall, first: Wall, second: Wall) -> tuple[Wall, Wall]:
    """The two of three walls that are nearest to p, `first` nearer than `second`."""
    return nearer(wall, first, p, p), second_nearest(wall, first, second, p, p, p)


@law
def second_nearest(wall: Wall, first: Wall, second: Wall, p: Vec3, p1: Vec3, p2: Vec3) -> Wall:
    """The second nearest of three walls, `first` nearer than `second`; their distances are from p, p1 and p2.

    A wall whose nearest point is also a point of the nearest one does not count: where walls join, only one acts.
    """
    d, d1, d2 = offset(wall, p), offset(first, p1), offset(second, p2)
    square, square1 = dot(d, d), dot(d1, d1)
    separation, separation1 = offset(first, p - d), offset(wall, p1 - d1)
    behind = selected_wall(selected(SEAM, dot(separation, separation), square, HIDDEN), dot(d2, d2), wall, second)
    return selected_wall(square, square1, selected_wall(SEAM, dot(separation1, separation1), first, second), behind)
