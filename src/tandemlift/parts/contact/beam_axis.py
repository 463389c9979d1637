"""The axis of the beam, and its point nearest to an edge or to the top of a wall."""

from typing import NamedTuple, Protocol

from tandemlift.core.algebra import clip, maximum, where
from tandemlift.core.law import law
from tandemlift.core.types import Number, PerQuadrotor
from tandemlift.core.vector import Vec3, apply, cross, dot
from tandemlift.parts.contact.spheres import SMALL, SpringyWall
from tandemlift.parts.contact.wall_geometry import Wall
from tandemlift.parts.mechanics.loads import scaled, translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

PARALLEL = 1e-12  # sin² of the angle between lines without a unique nearest point


class Beam(NamedTuple):
    """The payload as a capsule along body y: its radius [m], and its two ends, −½ and +½ of its axis [m], as a set."""

    radius: Number
    ends: PerQuadrotor


class WallToBeam(SpringyWall, Protocol):
    """Contact of walls with a vehicle whose payload has a shape."""

    @property
    def beam(self) -> Beam:
        """Its shape."""


class BeamAxis(NamedTuple):
    """The beam's axis, world axes: centre [m], its velocity [m/s], direction, angular velocity [rad/s]."""

    center: Vec3
    velocity: Vec3
    direction: Vec3
    spin: Vec3


@law
def point_by_edge(a: BeamAxis, half: Number, edge: Wall) -> Number:
    """The place on the beam's axis, ±half, nearest to an edge [m]: level with it, or nearest to its upper end."""
    x, y, b = edge.x - a.center.x, edge.y - a.center.y, a.direction
    along = x * b.x + y * b.y
    level = along / maximum(b.x * b.x + b.y * b.y, SMALL)
    up = edge.top - a.center.z
    return clip(where(level * b.z < up, level, along + up * b.z), -half, half)


@law
def point_by_top(a: BeamAxis, half: Number, wall: Wall) -> Number:
    """The place on the beam's axis, ±half, nearest to a wall's top [m]."""
    # Ericson, Real-Time Collision Detection, section 5.1.9
    b, r = a.direction, a.center - Vec3(wall.x, wall.y, wall.top)
    cosine, on_beam = b.x * wall.along_x + b.y * wall.along_y, dot(b, r)
    on_wall = r.x * wall.along_x + r.y * wall.along_y
    sine = maximum(1.0 - cosine * cosine * wall.per_square, PARALLEL)
    crossing = clip((cosine * on_wall * wall.per_square - on_beam) / sine, -half, half)
    share = clip((cosine * crossing + on_wall) * wall.per_square, 0.0, 1.0)
    return clip(cosine * share - on_beam, -half, half)


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
