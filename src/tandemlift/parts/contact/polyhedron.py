"""A convex body, or several, against walls: its corners against their surface, its edges against their edges and tops.

Walls are thin. The nearest points of two convex bodies are a corner and a face, or of two edges. So every corner
touches as a sphere the two walls nearest to it; every edge touches as a capsule the two nearest upright edges and the
two nearest tops; and every face touches the upper corners of these edges, in the depth s of a corner below it. The
spheres and capsules are as deep inside as their radius, so the faces are where they should be; corners are rounded.
Each distance is continuous, also where an edge's nearest point comes to its end, so every contact is a spring.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import greatest, least, maximum, minimum, where
from tandemlift.core.law import law
from tandemlift.core.types import Number, NumberSet, number
from tandemlift.core.vector import Absent, Mat3, Vec3, apply, apply_transposed, cross, dot, each, set_of, spread, total
from tandemlift.parts.contact.beam_axis import (
    BeamAxis,
    beam_contact,
    beam_load,
    beam_point,
    nearest_to_beam_with,
    point_by_edge,
    point_by_top,
)
from tandemlift.parts.contact.spheres import WallContact, about_arm, sphere_contact
from tandemlift.parts.contact.springs import Springs
from tandemlift.parts.contact.wall_geometry import (
    HIDDEN,
    SEAM,
    WALL,
    Wall,
    edges_of,
    first_number,
    no_walls,
    offset,
    offset_from_top,
    only_number,
    selected,
    selected_wall,
    two_nearest_to,
)
from tandemlift.parts.mechanics.bodies import ConvexHull
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartsLayout, sum_over_set, translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

ROUNDING = 0.02  # m, radius of corners and edges, or a quarter of the body's width if that is less
BESIDE = 1e-9  # m, tolerance of a point on a face
LEAST_DISTANCE = 1e-6  # m, distance at which a direction is known
FAR_DISTANCE = 1e3  # m


class Faces(NamedTuple):
    """The faces of a convex body, from the payload's origin [m, body axes]: unit `normal` and `distance`, sets.

    `others`: those of the next body of several, or `Absent`.
    """

    normal: Vec3
    distance: NumberSet
    others: Faces | Absent


class Polyhedron(NamedTuple):
    """The payload as convex bodies, from its origin in body axes [m].

    `radius` of all corners and edges. As sets, of all bodies together: the `corners` of the cores, the bodies without
    their outermost `radius`; `middle`, `direction` and `half` length of the edges between them. `faces`: body by body.
    """

    radius: Number
    corners: Vec3
    middle: Vec3
    direction: Vec3
    half: NumberSet
    faces: Faces


class NearPolyhedron(NamedTuple):
    """The two walls nearest to every corner (of sets); to all bodies together, two upright edges and two tops."""

    first: Wall
    second: Wall
    edge: Wall
    other_edge: Wall
    topped: Wall
    other_topped: Wall


class PolyhedronContact(NamedTuple):
    """Contact about the payload's origin, all of sets: of corners; of edges with edges and tops; of faces with tips."""

    first: WallContact
    second: WallContact
    edge: WallContact
    other_edge: WallContact
    top: WallContact
    other_top: WallContact
    tips: WallContact


class Spots(NamedTuple):
    """Points of the core, sets, in world axes [m], and their offset from a wall [m]."""

    place: Vec3
    offset: Vec3


@law
def corners_in(p: Polyhedron, frame: PartsLayout, s: State) -> Vec3:
    """The corners of the core [m, world axes], a set."""
    return translated(s.position, apply(rotation_from_quaternion(s.attitude), translated(frame.payload, p.corners)))


@law
def edges_in(p: Polyhedron, frame: PartsLayout, s: State) -> BeamAxis:
    """The edges of the core, a set."""
    R = rotation_from_quaternion(s.attitude)
    spin, arm = apply(R, s.rates), apply(R, translated(frame.payload, p.middle))
    velocity = translated(s.velocity, cross(spin, arm))
    return BeamAxis(translated(s.position, arm), velocity, apply(R, p.direction), spin)


@law
def by_edge(a: BeamAxis, half: NumberSet, edge: Wall) -> Spots:
    """The points of edges nearest to an upright edge of a wall."""
    place = beam_point(a, point_by_edge(a, half, edge))
    return Spots(place, offset(edge, place))


@law
def by_top(a: BeamAxis, half: NumberSet, wall: Wall) -> Spots:
    """The points of edges nearest to the top of a wall."""
    place = beam_point(a, point_by_top(a, half, wall))
    return Spots(place, offset_from_top(wall, place))


def faces_of(p: Polyhedron) -> list[Faces]:
    """The faces of every body."""
    found = [p.faces]
    while isinstance(found[-1].others, Faces):
        found.append(found[-1].others)
    return found


@law
def offset_from_tip(faces: Faces, radius: Number, edge: Wall, origin: Vec3, R: Mat3) -> Vec3:
    """Offset of a core's nearest face from the upper end of an edge [m, world axes]; far where no face is before it.

    Below the faces by s, the nearest one of the core is r − s behind the tip, and at least a little.
    """
    tip = apply_transposed(R, Vec3(edge.x, edge.y, edge.top) - origin)
    above = dot(faces.normal, tip) - faces.distance
    most = greatest(above)
    face = first_number(above, most)
    normal = Vec3(*[total(only_number(axis, face)) for axis in faces.normal])
    beside = greatest(dot(faces.normal, tip - normal * most) - faces.distance)
    return apply(R, normal * -where(beside < BESIDE, maximum(most + radius, LEAST_DISTANCE), FAR_DISTANCE))


@law
def by_tips(p: Polyhedron, near: NearPolyhedron, frame: PartsLayout, s: State) -> Spots:
    """The points of the cores' faces nearest to the upper ends of the two nearest edges."""
    R = rotation_from_quaternion(s.attitude)
    origin, bodies = s.position + apply(R, frame.payload), faces_of(p)
    offsets = [offset_from_tip(f, p.radius, edge, origin, R) for f in bodies for edge in (near.edge, near.other_edge)]
    pairs = (near.edge, near.other_edge) * len(bodies)
    places = [Vec3(edge.x, edge.y, edge.top) + o for edge, o in zip(pairs, offsets, strict=True)]
    place, o = (Vec3(*[set_of(axis) for axis in zip(*points, strict=True)]) for points in (places, offsets))
    return Spots(place, o)


@law
def spots_by_walls(p: Polyhedron, near: NearPolyhedron, frame: PartsLayout, s: State) -> tuple[Spots, ...]:
    """All points of the core that may touch near walls, in the order of `PolyhedronContact`."""
    corners, a = corners_in(p, frame, s), edges_in(p, frame, s)
    return (
        Spots(corners, offset(near.first, corners)),
        Spots(corners, offset(near.second, corners)),
        by_edge(a, p.half, near.edge),
        by_edge(a, p.half, near.other_edge),
        by_top(a, p.half, near.topped),
        by_top(a, p.half, near.other_topped),
        by_tips(p, near, frame, s),
    )


@law
def contact_at_spots(k: Springs, radius: Number, spots: Spots, origin: Vec3, velocity: Vec3, spin: Vec3) -> WallContact:
    """Contact of a body at some of its points, about an origin that moves at a velocity [m/s]; world axes."""
    arm = translated(-origin, spots.place)
    moving = translated(velocity, cross(spin, arm))
    return about_arm(sphere_contact(k, spots.place, spots.offset, radius, moving, spin), arm)


@beam_contact.register(Polyhedron)
def _polyhedron(p: Polyhedron, k: Springs, near: NearPolyhedron, frame: PartsLayout, s: State) -> PolyhedronContact:
    R = rotation_from_quaternion(s.attitude)
    spin, arm = apply(R, s.rates), apply(R, frame.payload)
    origin, velocity = s.position + arm, s.velocity + cross(spin, arm)
    spots = spots_by_walls(p, near, frame, s)
    return PolyhedronContact(*[contact_at_spots(k, p.radius, some, origin, velocity, spin) for some in spots])


@beam_load.register(PolyhedronContact)
def _of_polyhedron(contact: PolyhedronContact, R: Mat3) -> PartLoad:
    loads = [PartLoad(sum_over_set(c.load.force), sum_over_set(c.load.moment)) for c in contact]
    load = loads[0] + loads[1] + loads[2] + loads[3] + loads[4] + loads[5] + loads[6]
    return PartLoad(load.force, apply_transposed(R, load.moment))


@law
def least_square(spots: Spots) -> Number:
    """The smallest square of the distance of points from a wall [m²]."""
    return least(dot(spots.offset, spots.offset))


@law
def square_from_edge(p: Polyhedron, edge: Wall, a: BeamAxis, origin: Vec3, R: Mat3) -> Number:
    """Square of the distance of the bodies from an upright edge [m²]."""
    tips, square = [offset_from_tip(f, p.radius, edge, origin, R) for f in faces_of(p)], by_edge(a, p.half, edge)
    return functools.reduce(minimum, [dot(tip, tip) for tip in tips], least_square(square))


@law
def separation(a: Wall, b: Wall) -> Number:
    """0 of a wall, or an edge, and itself [m²]."""
    x, y, along_x, along_y = a.x - b.x, a.y - b.y, a.along_x - b.along_x, a.along_y - b.along_y
    return x * x + y * y + along_x * along_x + along_y * along_y


@law
def two_nearest(
    wall: Wall, first: Wall, second: Wall, square: Number, square1: Number, square2: Number
) -> tuple[Wall, Wall]:
    """The two nearest of three walls, or edges, by the squares of their distances; a double counts once."""
    apart = separation(wall, first)
    behind = selected_wall(selected(SEAM, apart, square, HIDDEN), square2, wall, second)
    pushed = selected_wall(SEAM, apart, first, second)
    return selected_wall(square, square1, wall, first), selected_wall(square, square1, pushed, behind)


@nearest_to_beam_with.register(Polyhedron)
def _near_polyhedron(p: Polyhedron, wall: Wall, near: NearPolyhedron, frame: PartsLayout, s: State) -> NearPolyhedron:
    corners, a, R = corners_in(p, frame, s), edges_in(p, frame, s), rotation_from_quaternion(s.attitude)
    origin, edges, tops = s.position + apply(R, frame.payload), near[2:4], near[4:]
    for edge in edges_of(wall):
        edges = two_nearest(edge, *edges, *[square_from_edge(p, e, a, origin, R) for e in (edge, *edges)])
    tops = two_nearest(wall, *tops, *[least_square(by_top(a, p.half, one)) for one in (wall, *tops)])
    return NearPolyhedron(*two_nearest_to(corners, wall, near.first, near.second), *edges, *tops)


def no_walls_near_polyhedron(p: object) -> NearPolyhedron | Absent:
    """No wall is near; `Absent` for anything but a `Polyhedron`."""
    if not isinstance(p, Polyhedron):
        return Absent()
    nowhere = no_walls(len(p.corners.x))
    return NearPolyhedron(nowhere, nowhere, WALL, WALL, WALL, WALL)


def polyhedron(hulls: Sequence[ConvexHull]) -> Polyhedron | Absent:
    """The contact shape of convex hulls; `Absent` without any."""
    if not hulls:
        return Absent()
    radius = min(ROUNDING, *[0.25 * hull.width for hull in hulls])
    cores = [hull.inset(radius) for hull in hulls]
    a, b = np.concatenate([core[hull.edges] for core, hull in zip(cores, hulls, strict=True)]).transpose(1, 0, 2)
    lengths = np.linalg.norm(b - a, axis=1)
    faces: Faces | Absent = Absent()
    for hull in reversed(hulls):
        faces = Faces(spread(hull.normals), each(len(hull.offsets))(*map(number, hull.offsets)), faces)
    assert isinstance(faces, Faces)
    return Polyhedron(
        number(radius),
        spread(np.concatenate(cores)),
        spread(0.5 * (a + b)),
        spread((b - a) / lengths[:, None]),
        each(len(a))(*map(number, 0.5 * lengths)),
        faces,
    )
