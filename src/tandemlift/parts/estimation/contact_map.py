"""The map of walls: finds the wall that may have caused a horizontal force, and the place.

A force may come from a wall if the part is near it, and if the force points away from it within the friction cone.
Upright sides and edges count; the tops of walls do not, because their forces are vertical.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, greatest, least, maximum, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number, PerQuadrotor
from tandemlift.core.vector import ZERO, Absent, Vec3, apply, dot, each, total
from tandemlift.parts.contact.beam_axis import BeamAxis, NearBeam, beam_axis, beam_point, point_by_edge
from tandemlift.parts.contact.polyhedron import NearPolyhedron
from tandemlift.parts.contact.wall_geometry import Wall, if_number, number_at, offset
from tandemlift.parts.contact.walls import NearWalls
from tandemlift.parts.mechanics.joint_loads import translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

LEAST_COSINE = 0.6  # between a force and a wall's normal: friction of 0.8 rotates it by 39°, noise by more


class TouchGeometry(NamedTuple):
    """The parts that touch, from the system's centre of mass [m, body axes].

    `quadrotors`: centres of the guards (a vector of sets) with their radii `guards` [m]; `payload`: the centre of the
    beam, which is `half` long either way along body y, with a `radius` [m]; `corners`: those of a convex body (a vector
    of sets), or `Absent`. `margin` [m]: how far from a known wall a
    part may seem to be when it touches.
    """

    quadrotors: Vec3
    guards: PerQuadrotor
    payload: Vec3
    half: Number
    radius: Number
    margin: Number
    corners: Vec3 | Absent = Absent()


class BeamMatch(NamedTuple):
    """1 if a known wall explains a force on the beam, else 0; its place [m, body y]; the offset from the wall [m]."""

    matched: Number
    along: Number
    offset: Vec3


class GuardMatch(NamedTuple):
    """Likewise for every guard, as sets; the offset is zero where no wall matches."""

    matched: PerQuadrotor
    offset: Vec3


UNMATCHED = BeamMatch(0.0, 0.0, ZERO)


@elementwise
def explains(square: Number, radius: Number, margin: Number, product: Number, force: Number) -> Number:
    """1 if a wall at the distance √square explains a force, else 0.

    Args:
        square: of the distance of the part's axis from the wall [m²].
        radius: of the part [m].
        margin: see `TouchGeometry` [m].
        product: of the offset from the wall with the force [m N].
        force: its square [N²].
    """
    aligned = where(product * product > LEAST_COSINE * LEAST_COSINE * square * force, 1.0, 0.0)
    return where(square < (radius + margin) * (radius + margin), where(product > 0.0, aligned, 0.0), 0.0)


@elementwise
def unless(flag: Number, value: Number) -> Number:
    """0 where a flag is 1, else the value."""
    return where(flag > 0.0, 0.0, value)


@law
def level(o: Vec3) -> Vec3:
    """The horizontal part of an offset, which may be of sets."""
    return Vec3(o.x, o.y, o.z * 0.0)


@law
def guard_match(g: TouchGeometry, wall: Wall, p: Vec3, force: Vec3) -> GuardMatch:
    """`GuardMatch` of a wall for each guard at p [m, world axes] and the force on it [N, world axes]; all of sets."""
    o = level(offset(wall, p))
    square = dot(o, o)
    matched = explains(square, g.guards, g.margin, dot(o, force), dot(force, force))
    return GuardMatch(matched, Vec3(o.x * matched, o.y * matched, o.z))


@choice
def guards_matched(near: NearWalls | Absent, g: TouchGeometry, s: State, force: Vec3) -> GuardMatch:
    """`GuardMatch` of forces on the guards [N, world axes], with the walls that the pilot knows near them."""


@guards_matched.register(Absent)
def _no_map(near: Absent, g: TouchGeometry, s: State, force: Vec3) -> GuardMatch:
    none = force.x * 0.0
    return GuardMatch(none, Vec3(none, none, none))


@guards_matched.register(NearWalls)
def _on_map(near: NearWalls, g: TouchGeometry, s: State, force: Vec3) -> GuardMatch:
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), g.quadrotors))
    first, second = guard_match(g, near.first, p, force), guard_match(g, near.second, p, force)
    other = unless(first.matched, second.matched)
    return GuardMatch(
        first.matched + other,
        Vec3(first.offset.x + second.offset.x * other, first.offset.y + second.offset.y * other, first.offset.z),
    )


@law
def beam_match(g: TouchGeometry, a: BeamAxis, along: Number, wall: Wall, force: Vec3) -> BeamMatch:
    """`BeamMatch` of a wall and a force [N, world axes] at a point `along` the beam [m]."""
    o = level(offset(wall, beam_point(a, along)))
    square = dot(o, o)
    matched = explains(square, g.radius, g.margin, dot(o, force), dot(force, force))
    return BeamMatch(matched, along, o)


@law
def first_match(a: BeamMatch, b: BeamMatch) -> BeamMatch:
    """The first of two matches, or the second if the first is none."""
    matched = maximum(a.matched, b.matched)
    return BeamMatch(matched, where(a.matched > 0.0, a.along, b.along), chosen(a.matched, a.offset, b.offset))


@choice(absent=UNMATCHED)
def beam_matched(near: NearBeam | NearPolyhedron | Absent, g: TouchGeometry, s: State, force: Vec3) -> BeamMatch:
    """`BeamMatch` of a force on the payload [N, world axes]."""


@beam_matched.register(NearBeam)
def _beam_on_map(near: NearBeam, g: TouchGeometry, s: State, force: Vec3) -> BeamMatch:
    a = beam_axis(g.payload, s)
    by_edge = beam_match(g, a, point_by_edge(a, g.half, near.edge), near.edge, force)
    by_other = beam_match(g, a, point_by_edge(a, g.half, near.other_edge), near.other_edge, force)
    start = beam_match(g, a, -g.half, wall_of(near.ends, 0), force)
    end = beam_match(g, a, g.half, wall_of(near.ends, 1), force)
    return first_match(first_match(by_edge, by_other), first_match(start, end))


@beam_matched.register(NearPolyhedron)
def _body_on_map(near: NearPolyhedron, g: TouchGeometry, s: State, force: Vec3) -> BeamMatch:
    """By the first of its corners that a wall near it explains."""
    arm = g.corners
    assert isinstance(arm, Vec3)
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), arm))
    return first_match(corner_match(g, near.first, arm, p, force), corner_match(g, near.second, arm, p, force))


@law
def corner_match(g: TouchGeometry, walls: Wall, arm: Vec3, p: Vec3, force: Vec3) -> BeamMatch:
    """`BeamMatch` of a force [N, world axes] and walls, one for each corner at p [m, world axes]."""
    o, count = level(offset(walls, p)), len(arm.x)
    matched = explains(dot(o, o), 0.0, g.margin, dot(o, force), dot(force, force))
    numbers = each(count)(*[1.0 + i for i in range(count)])
    first = least(number_at(matched, 1.0, numbers, 1.0 + count))
    along, x, y = (total(if_number(numbers, first, axis)) for axis in (arm.y, o.x, o.y))
    return BeamMatch(greatest(matched), along - g.payload.y, Vec3(x, y, 0.0))


@law
def wall_of(walls: Wall, i: int) -> Wall:
    """One of a set of walls."""
    return Wall(*[value[i] for value in walls])  # type: ignore[index]  # of a set of walls


@law(absent=UNMATCHED)
def beam_of(near: NearWalls, g: TouchGeometry, s: State, force: Vec3) -> BeamMatch:
    """`beam_matched` by the walls that the pilot knows near the beam."""
    return beam_matched(near.beam, g, s, force)


@law
def picked(numbers: PerQuadrotor, number: Number, values: PerQuadrotor) -> Number:
    """The value of a set at the place where `numbers` is `number`, 0 where it is nowhere."""
    return total(at_number(numbers, number, values))


@elementwise
def at_number(own: Number, number: Number, value: Number) -> Number:
    """The value where the number is its own, else 0."""
    return where(own == number, value, 0.0)
