"""Contact of the quadrotors and of the beam with walls.

A quadrotor's shape is a sphere about its centre of mass. The beam is a capsule: its ends touch as spheres, its length
touches a wall's edges and its top. Each contact acts at the nearest point, with its penetration δ there:

    N = max(0, k δ + c δ̇) if δ > 0, else 0         F = −c_t v, shortened to the length μ N if it is longer,

N acts along the line between the nearest points, F against the sliding velocity v of the surface there. The distance
to a wall is continuous, so k δ is a spring, and both forces are passive.

Which walls are near changes slowly: `nearest_with` looks at all of them now and then, from `no_walls_near` on.
`near_wall_loads` measures the distance to the near ones in every state, so it stays exact in between.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.algebra.arrays import array, lengths
from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import clip, greatest, maximum, minimum, sqrt, where
from tandemlift.algebra.types import Number, PerQuadrotor, number
from tandemlift.algebra.vector import ZERO, Nothing, Vec3, apply, apply_transposed, cross, dot, each
from tandemlift.laws.mechanics.collision.springs import (
    friction_factor,
    mobility,
    softened_for_step,
    spring_damper,
    surface_mobility,
)
from tandemlift.laws.mechanics.loads import (
    PartLoad,
    PartLoads,
    PartsLayout,
    scaled,
    sum_over_set,
    translated,
)
from tandemlift.laws.mechanics.rigid_body import State
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.laws.mechanics.wall_geometry import (
    WALL,
    Wall,
    edges_of,
    nearer,
    offset,
    offset_from_top,
    second_nearest,
    selected_wall,
)

SMALL = 1e-18  # m²: no direction is known at this distance
PARALLEL = 1e-12  # sin² of the angle between lines that have no one nearest point


class Beam(NamedTuple):
    """The payload as a capsule along body y: its radius [m], and its two ends, −½ and +½ of its axis [m], as a set."""

    radius: Number
    ends: Any


class Walls(NamedTuple):
    """Contact with walls: k [N/m], c [N·s/m], μ and c_t [N·s/m]; `guards`: radius of every quadrotor's sphere [m].

    `beam`: a `Beam`, or `Nothing` if the payload has no shape; `reach` [m]: of all these from the centre of mass.
    """

    stiffness: Number
    damping: Number
    friction: Number
    tangential_damping: Number
    guards: PerQuadrotor
    beam: Any
    reach: Number


class NearBeam(NamedTuple):
    """The wall nearest to each end of the beam (of sets), the two nearest edges, the wall with the nearest top."""

    ends: Wall
    edge: Wall
    other_edge: Wall
    topped: Wall


class NearWalls(NamedTuple):
    """The two walls nearest to every quadrotor (of sets), and a `NearBeam`, or `Nothing`."""

    first: Wall
    second: Wall
    beam: NearBeam | Nothing


class BeamAxis(NamedTuple):
    """The beam's axis, world axes: centre [m], its velocity [m/s], direction, turn rate [rad/s]."""

    center: Vec3
    velocity: Vec3
    direction: Vec3
    spin: Vec3


@elementwise
def inverse_root(square: Number) -> Number:
    """1/√square, bounded."""
    return 1.0 / sqrt(maximum(square, SMALL))


@elementwise
def penetration(distance: Number, radius: Number) -> Number:
    """Penetration [m] of a sphere whose centre is at a distance."""
    return radius - distance


@law
def sphere_load(w: Walls, o: Vec3, radius: Number, velocity: Vec3, spin: Vec3) -> PartLoad:
    """Load of a wall on a sphere that moves at a velocity [m/s] and turns at `spin` [rad/s], all in world axes.

    o is the offset of the sphere's centre from the wall [m]; the moment is about that centre [N·m].
    """
    square = dot(o, o)
    inverse = inverse_root(square)
    n = scaled(o, inverse)
    rate = -dot(n, velocity)
    normal = spring_damper(penetration(square * inverse, radius), rate, w.stiffness, w.damping)
    sliding = scaled(velocity - cross(spin, o) + scaled(n, rate), w.tangential_damping)
    factor = friction_factor(dot(sliding, sliding), normal * w.friction)
    force = scaled(n, normal) - scaled(sliding, factor)
    return PartLoad(force, cross(force, o))


@law
def point_by_edge(a: BeamAxis, half: Number, edge: Wall) -> Number:
    """Where along the beam's axis, ±half, it is nearest to an edge [m]: level with it, or nearest to its upper end."""
    x, y, b = edge.x - a.center.x, edge.y - a.center.y, a.direction
    along = x * b.x + y * b.y
    level = along / maximum(b.x * b.x + b.y * b.y, SMALL)
    up = edge.top - a.center.z
    return clip(where(level * b.z < up, level, along + up * b.z), -half, half)


@law
def point_by_top(a: BeamAxis, half: Number, wall: Wall) -> Number:
    """Where along the beam's axis, ±half, it is nearest to a wall's top [m]."""
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


@law
def load_at_beam_point(w: Walls, a: BeamAxis, along: Number, o: Vec3) -> PartLoad:
    """Load of a wall on the beam at a point `along` its axis [m], at the offset o [m]: world axes, about its centre."""
    arm = scaled(a.direction, along)
    load = sphere_load(w, o, w.beam.radius, translated(a.velocity, cross(a.spin, arm)), a.spin)
    return PartLoad(load.force, load.moment + cross(arm, load.force))


@choice(absent=PartLoad(ZERO, ZERO))
def beam_load(beam: Beam | Nothing, w: Walls, near: NearBeam | Nothing, frame: PartsLayout, s: State) -> Any:
    """Load of the near walls on the payload."""


@beam_load.register(Beam)
def _capsule(beam: Beam, w: Walls, near: NearBeam, frame: PartsLayout, s: State) -> PartLoad:
    a, half = beam_axis(frame.payload, s), beam.ends[1]
    ends = load_at_beam_point(w, a, beam.ends, offset(near.ends, beam_point(a, beam.ends)))
    i, j = point_by_edge(a, half, near.edge), point_by_edge(a, half, near.other_edge)
    k = point_by_top(a, half, near.topped)
    edge = load_at_beam_point(w, a, i, offset(near.edge, beam_point(a, i)))
    other = load_at_beam_point(w, a, j, offset(near.other_edge, beam_point(a, j)))
    top = load_at_beam_point(w, a, k, offset_from_top(near.topped, beam_point(a, k)))
    load = PartLoad(sum_over_set(ends.force), sum_over_set(ends.moment)) + edge + other + top
    return PartLoad(load.force, apply_transposed(rotation_from_quaternion(s.attitude), load.moment))


@law
def near_wall_loads(w: Walls, near: NearWalls, frame: PartsLayout, s: State) -> PartLoads:
    """Loads of the near walls on all parts."""
    R = rotation_from_quaternion(s.attitude)
    spin, arm = apply(R, s.rates), apply(R, frame.quadrotors)
    p, v = translated(s.position, arm), translated(s.velocity, cross(spin, arm))
    first, second = offset(near.first, p), offset(near.second, p)
    load = sphere_load(w, first, w.guards, v, spin) + sphere_load(w, second, w.guards, v, spin)
    return PartLoads(beam_load(w.beam, w, near.beam, frame, s), PartLoad(load.force, apply_transposed(R, load.moment)))


@choice(absent="near")
def nearest_to_beam_with(
    beam: Beam | Nothing, wall: Wall, near: NearBeam | Nothing, frame: PartsLayout, s: State
) -> Any:
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


@law
def nearest_with(w: Walls, wall: Wall, near: NearWalls, frame: PartsLayout, s: State) -> NearWalls:
    """The nearest walls, with `wall` (of numbers) taken into account."""
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), frame.quadrotors))
    return NearWalls(
        nearer(wall, near.first, p, p),
        second_nearest(wall, near.first, near.second, p, p, p),
        nearest_to_beam_with(w.beam, wall, near.beam, frame, s),
    )


def no_walls_near(w: Walls) -> NearWalls:
    """No wall is near."""
    walls, ends = [Wall(*[each(n)(*[v] * n) for v in WALL]) for n in (len(w.guards), 2)]
    return NearWalls(walls, walls, NearBeam(ends, WALL, WALL, WALL) if isinstance(w.beam, Beam) else Nothing())


def walls(
    quadrotors: ArrayLike,
    guards: ArrayLike,
    mass: float,
    inertia: ArrayLike,
    step: float,
    *,
    friction: float,
    beam: tuple[float, float] | None = None,
    payload: ArrayLike = (0.0, 0.0, 0.0),
    stiffness: float = 5000.0,
    damping_ratio: float = 0.5,
) -> Walls:
    """Contact of a vehicle with walls: as stiff as asked, softer if the step [s] of the Runge-Kutta method demands it.

    Args:
        quadrotors: N × 3, their centres of mass from the system's [m, body axes].
        guards: radius of the sphere about each of them [m], one number or N.
        mass: of the vehicle [kg].
        inertia: 3 × 3 about its centre of mass [kg·m²].
        step: [s].
        friction: μ of guards and beam on walls.
        beam: length [m] of the axis and radius [m] of a capsule along body y, if the payload is one.
        payload: its centre of mass from the system's [m, body axes].
        stiffness: of a contact [N/m].
        damping_ratio: of the vehicle oscillating on one contact, without turning.
    """
    J, centers = array(inertia), array(quadrotors)
    radii = np.broadcast_to(guards, len(centers))
    spheres = list(zip(centers, radii, strict=True))
    if beam:
        half = 0.5 * beam[0]
        spheres += [(np.add(payload, [0.0, end, 0.0]), beam[1]) for end in (-half, half)]
    centers = array([tuple(center) for center, _ in spheres])  # where N acts, were all in contact at once
    k, c = softened_for_step(stiffness, 2.0 * damping_ratio * sqrt(stiffness * mass), mobility(centers, mass, J), step)
    tangential_mobility = sum(surface_mobility(center, radius, mass, J) for center, radius in spheres)
    shape = Beam(number(beam[1]), each(2)(-half, half)) if beam else Nothing()
    reach = greatest([number(far + radius) for far, (_, radius) in zip(lengths(centers), spheres, strict=True)])
    return Walls(
        k,
        c,
        number(friction),
        minimum(c, 1.0 / (tangential_mobility * step)),
        each(len(radii))(*map(number, radii)),
        shape,
        reach,
    )
