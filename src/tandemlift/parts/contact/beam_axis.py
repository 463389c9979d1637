"""The beam against walls: a capsule, whose ends touch as spheres, its length a wall's edges and its top.

What the laws of a beam are for another payload is registered in `polyhedron`.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import clip, maximum, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number, PerQuadrotor
from tandemlift.core.vector import ZERO, Absent, Mat3, Vec3, apply, apply_transposed, cross, dot
from tandemlift.parts.contact.spheres import LEAST_SQUARE, WallContact, about_arm, sphere_contact
from tandemlift.parts.contact.springs import Springs
from tandemlift.parts.contact.wall_geometry import (
    Wall,
    edges_of,
    nearer,
    offset,
    offset_from_top,
    second_nearest,
    selected_wall,
)
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartsLayout, scaled, sum_over_set, translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

PARALLEL = 1e-12  # sin² of the angle between lines without a unique nearest point


class Beam(NamedTuple):
    """The payload as a capsule along body y: its radius [m], and its two ends, −½ and +½ of its axis [m], as a set."""

    radius: Number
    ends: PerQuadrotor


class BeamAxis(NamedTuple):
    """An axis, or a set of them, world axes: centre [m], its velocity [m/s], direction, angular velocity [rad/s]."""

    center: Vec3
    velocity: Vec3
    direction: Vec3
    spin: Vec3


class NearBeam(NamedTuple):
    """The wall nearest to each end of the beam (of sets), the two nearest edges, the wall with the nearest top."""

    ends: Wall
    edge: Wall
    other_edge: Wall
    topped: Wall


class BeamContact(NamedTuple):
    """Contact of the beam about its centre: of its ends (sets), with the two nearest edges, with a wall's top."""

    ends: WallContact
    edge: WallContact
    other: WallContact
    top: WallContact


@elementwise
def _by_edge(
    c_x: Number,
    c_y: Number,
    c_z: Number,
    b_x: Number,
    b_y: Number,
    b_z: Number,
    e_x: Number,
    e_y: Number,
    _x: Number,
    _y: Number,
    _square: Number,
    top: Number,
    half: Number,
) -> Number:
    x, y = e_x - c_x, e_y - c_y
    along = x * b_x + y * b_y
    level = along / maximum(b_x * b_x + b_y * b_y, LEAST_SQUARE)
    up = top - c_z
    return clip(where(level * b_z < up, level, along + up * b_z), -half, half)


@elementwise
def _by_top(
    c_x: Number,
    c_y: Number,
    c_z: Number,
    b_x: Number,
    b_y: Number,
    b_z: Number,
    w_x: Number,
    w_y: Number,
    along_x: Number,
    along_y: Number,
    per_square: Number,
    top: Number,
    half: Number,
) -> Number:
    # Ericson, Real-Time Collision Detection, section 5.1.9
    b, r = Vec3(b_x, b_y, b_z), Vec3(c_x, c_y, c_z) - Vec3(w_x, w_y, top)
    cosine, on_beam = b.x * along_x + b.y * along_y, dot(b, r)
    on_wall = r.x * along_x + r.y * along_y
    sine = maximum(1.0 - cosine * cosine * per_square, PARALLEL)
    crossing = clip((cosine * on_wall * per_square - on_beam) / sine, -half, half)
    share = clip((cosine * crossing + on_wall) * per_square, 0.0, 1.0)
    return clip(cosine * share - on_beam, -half, half)


@law
def point_by_edge(a: BeamAxis, half: Number, edge: Wall) -> Number:
    """The place on an axis, ±half, nearest to an upright edge [m]: level with it, or nearest to its upper end."""
    return _by_edge(*a.center, *a.direction, *edge, half)


@law
def point_by_top(a: BeamAxis, half: Number, wall: Wall) -> Number:
    """The place on an axis, ±half, nearest to a wall's top [m]."""
    return _by_top(*a.center, *a.direction, *wall, half)


@law
def beam_axis(center: Vec3, s: State) -> BeamAxis:
    """The beam's axis in state `s`; its centre from the system's centre of mass [m, body axes]."""
    R = rotation_from_quaternion(s.attitude)
    spin, arm = apply(R, s.rates), apply(R, center)
    return BeamAxis(s.position + arm, s.velocity + cross(spin, arm), Vec3(R.x.y, R.y.y, R.z.y), spin)


@law
def beam_point(a: BeamAxis, along: Number) -> Vec3:
    """Points of the beam's axis [m, world axes]."""
    return translated(a.center, scaled(a.direction, along))


@law
def contact_at_beam_point(k: Springs, radius: Number, a: BeamAxis, along: Number, o: Vec3) -> WallContact:
    """Contact of a beam with a wall at a point `along` its axis [m], at the offset o [m]."""
    arm = scaled(a.direction, along)
    velocity = translated(a.velocity, cross(a.spin, arm))
    c = sphere_contact(k, translated(a.center, arm), o, radius, velocity, a.spin)
    return about_arm(c, arm)


@choice(absent="beam")
def beam_contact(
    beam: Beam | Absent, k: Springs, near: NearBeam | Absent, frame: PartsLayout, s: State
) -> BeamContact | Absent:
    """Contact of the beam with the near walls."""


@beam_contact.register(Beam)
def _capsule(beam: Beam, k: Springs, near: NearBeam, frame: PartsLayout, s: State) -> BeamContact:
    a, half, r = beam_axis(frame.payload, s), beam.ends[1], beam.radius
    edge, other = point_by_edge(a, half, near.edge), point_by_edge(a, half, near.other_edge)
    top = point_by_top(a, half, near.topped)
    return BeamContact(
        contact_at_beam_point(k, r, a, beam.ends, offset(near.ends, beam_point(a, beam.ends))),
        contact_at_beam_point(k, r, a, edge, offset(near.edge, beam_point(a, edge))),
        contact_at_beam_point(k, r, a, other, offset(near.other_edge, beam_point(a, other))),
        contact_at_beam_point(k, r, a, top, offset_from_top(near.topped, beam_point(a, top))),
    )


@choice(absent=PartLoad(ZERO, ZERO))
def beam_load(contact: BeamContact | Absent, R: Mat3) -> PartLoad:
    """Load of the near walls on the payload."""


@beam_load.register(BeamContact)
def _of_capsule(c: BeamContact, R: Mat3) -> PartLoad:
    ends = PartLoad(sum_over_set(c.ends.load.force), sum_over_set(c.ends.load.moment))
    load = ends + c.edge.load + c.other.load + c.top.load
    return PartLoad(load.force, apply_transposed(R, load.moment))


@choice(absent="near")
def nearest_to_beam_with(
    beam: Beam | Absent, wall: Wall, near: NearBeam | Absent, frame: PartsLayout, s: State
) -> NearBeam | Absent:
    """The walls nearest to the beam, with `wall` taken into account."""


@nearest_to_beam_with.register(Beam)
def _near_beam(beam: Beam, wall: Wall, near: NearBeam, frame: PartsLayout, s: State) -> NearBeam:
    a, half = beam_axis(frame.payload, s), beam.ends[1]
    ends, (start, end) = beam_point(a, beam.ends), edges_of(wall)
    edge, other = two_nearest_edges(a, half, start, near.edge, near.other_edge)
    edge, other = two_nearest_edges(a, half, end, edge, other)
    d = offset_from_top(wall, beam_point(a, point_by_top(a, half, wall)))
    e = offset_from_top(near.topped, beam_point(a, point_by_top(a, half, near.topped)))
    return NearBeam(
        nearer(wall, near.ends, ends, ends), edge, other, selected_wall(dot(d, d), dot(e, e), wall, near.topped)
    )


@law
def two_nearest_edges(a: BeamAxis, half: Number, edge: Wall, first: Wall, second: Wall) -> tuple[Wall, Wall]:
    """The two of three edges that are nearest to the beam."""
    p = beam_point(a, point_by_edge(a, half, edge))
    p1, p2 = beam_point(a, point_by_edge(a, half, first)), beam_point(a, point_by_edge(a, half, second))
    return nearer(edge, first, p, p1), second_nearest(edge, first, second, p, p1, p2)
