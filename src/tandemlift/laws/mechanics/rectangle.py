"""Upright rectangles, from the ground to a top: the way from them to a point, and which of several are nearest.

World axes. A rectangle of numbers serves one point, one of sets serves a set of points, each its own.
"""

from typing import NamedTuple

from tandemlift.algebra.law import elementwise, law
from tandemlift.algebra.ops import clip, maximum, where
from tandemlift.algebra.types import Number
from tandemlift.algebra.vector import Vec3, dot

SEAM = 1e-8  # m²: rectangles that are this near to each other are joined there
AWAY = 1e6  # m, of a rectangle that is not there
HIDDEN = 1e30  # m², more than anything that is there


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


def wall(start: tuple[float, float], end: tuple[float, float], top: float) -> Wall:
    """The wall from `start` to `end` (x, y) [m] with its `top` at z [m]; a post if they are the same."""
    x, y = end[0] - start[0], end[1] - start[1]
    square = x * x + y * y
    per_square = 1.0 / square if square > SEAM else 0.0
    return Wall(float(start[0]), float(start[1]), float(x), float(y), per_square, float(top))


@elementwise
def share_of(
    p_x: Number, p_y: Number, x: Number, y: Number, along_x: Number, along_y: Number, per_square: Number
) -> Number:
    """How far along a wall its point nearest to p is, in [0, 1]."""
    return clip(((p_x - x) * along_x + (p_y - y) * along_y) * per_square, 0.0, 1.0)


@elementwise
def apart(p: Number, start: Number, along: Number, share: Number) -> Number:
    """One coordinate of p less that of a wall's point."""
    return p - start - along * share


@elementwise
def above(z: Number, top: Number) -> Number:
    """z above the top [m], or 0 below it."""
    return maximum(z - top, 0.0)


@law
def offset(wall: Wall, p: Vec3) -> Vec3:
    """The way from the nearest point of a wall to p [m]."""
    share = share_of(p.x, p.y, wall.x, wall.y, wall.along_x, wall.along_y, wall.per_square)
    return Vec3(apart(p.x, wall.x, wall.along_x, share), apart(p.y, wall.y, wall.along_y, share), above(p.z, wall.top))


@law
def offset_from_top(wall: Wall, p: Vec3) -> Vec3:
    """The way from the nearest point of a wall's upper rim to p [m]."""
    o = offset(wall, p)
    return Vec3(o.x, o.y, p.z - wall.top)


@law
def edges_of(wall: Wall) -> tuple[Wall, Wall]:
    """The upright edges at its start and at its end."""
    return (
        Wall(wall.x, wall.y, 0.0, 0.0, 0.0, wall.top),
        Wall(wall.x + wall.along_x, wall.y + wall.along_y, 0.0, 0.0, 0.0, wall.top),
    )


@elementwise
def smaller(d: Number, limit: Number, a: Number, b: Number) -> Number:
    """a where d < limit, else b."""
    return where(d < limit, a, b)


@law
def pick(d: Number, limit: Number, a: Wall, b: Wall) -> Wall:
    """The wall a where d < limit, else b."""
    return Wall(
        smaller(d, limit, a.x, b.x),
        smaller(d, limit, a.y, b.y),
        smaller(d, limit, a.along_x, b.along_x),
        smaller(d, limit, a.along_y, b.along_y),
        smaller(d, limit, a.per_square, b.per_square),
        smaller(d, limit, a.top, b.top),
    )


@law
def nearer(wall: Wall, other: Wall, p: Vec3, q: Vec3) -> Wall:
    """The one of two walls that is nearer, the distance of the first taken from p, that of the other from q."""
    d, e = offset(wall, p), offset(other, q)
    return pick(dot(d, d), dot(e, e), wall, other)


@law
def runner_up(wall: Wall, first: Wall, second: Wall, p: Vec3, p1: Vec3, p2: Vec3) -> Wall:
    """The second nearest of three walls, `first` nearer than `second`; their distances are from p, p1 and p2.

    A wall whose nearest point is also a point of the nearest one does not count: where walls join, one presses.
    """
    d, d1, d2 = offset(wall, p), offset(first, p1), offset(second, p2)
    square, square1 = dot(d, d), dot(d1, d1)
    gap, gap1 = offset(first, p - d), offset(wall, p1 - d1)
    behind = pick(smaller(SEAM, dot(gap, gap), square, HIDDEN), dot(d2, d2), wall, second)
    return pick(square, square1, pick(SEAM, dot(gap1, gap1), first, second), behind)
