"""Contact of the quadrotors and of the beam with walls.

A quadrotor's shape is a sphere about its centre of mass, its guard, and one about each rotor that stands out of it
(`spheres`). The beam is a capsule: its ends touch as spheres, its length touches a wall's edges and its top.
Each contact acts at the nearest point, with its penetration δ there:

    N = max(0, k δ + c δ̇) if δ > 0, else 0         F = −c_t v, shortened to the length μ N if it is longer,

N acts along the line between the nearest points, F against the sliding velocity v of the surface there. The distance
to a wall is continuous, so k δ is a spring, and both forces are passive.

The set of near walls changes slowly: `nearest_with` examines all of them at intervals, from `no_walls_near` on, and in
every step of a vehicle that is fast (`clearance.is_fast`). `near_wall_loads` measures the distance to the near ones in
every state, so it stays exact in between. Impacts that springs would not stop are stopped by `impulses`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.algebra import greatest, minimum, sqrt
from tandemlift.core.arrays import array, lengths
from tandemlift.core.law import choice, law
from tandemlift.core.types import Number, PerQuadrotor, number
from tandemlift.core.vector import ZERO, Absent, Mat3, Vec3, apply, apply_transposed, cross, dot, each
from tandemlift.parts.contact.beam_axis import (
    Beam,
    BeamAxis,
    WallToBeam,
    beam_axis,
    beam_point,
    point_by_edge,
    point_by_top,
)
from tandemlift.parts.contact.spheres import (
    ContactPair,
    NearRotors,
    RotorSpheres,
    WallContact,
    nearest_to_rotors_with,
    no_walls_near_rotors,
    rotor_wall_contact,
    sphere_contact,
    with_rotor_loads,
)
from tandemlift.parts.contact.springs import mobility, softened_for_step, surface_mobility
from tandemlift.parts.contact.wall_geometry import (
    WALL,
    Wall,
    edges_of,
    nearer,
    offset,
    offset_from_top,
    second_nearest,
    selected_wall,
)
from tandemlift.parts.mechanics.loads import (
    PartLoad,
    PartLoads,
    PartsLayout,
    scaled,
    sum_over_set,
    translated,
)
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

IN_GUARDS = Absent()


class Walls(NamedTuple):
    """Contact with walls: k [N/m], c [N·s/m], μ and c_t [N·s/m]; `guards`: radius of every quadrotor's sphere [m].

    `rotors`: a `RotorSpheres`, or `Absent` if all rotors are in their guard; `beam`: a `Beam`, or `Absent` if the
    payload has no shape; `reach` [m]: of all these from the centre of mass.
    """

    stiffness: Number
    damping: Number
    friction: Number
    tangential_damping: Number
    guards: PerQuadrotor
    rotors: RotorSpheres | Absent
    beam: Beam | Absent
    reach: Number


class NearBeam(NamedTuple):
    """The wall nearest to each end of the beam (of sets), the two nearest edges, the wall with the nearest top."""

    ends: Wall
    edge: Wall
    other_edge: Wall
    topped: Wall


class NearWalls(NamedTuple):
    """The two walls nearest to every quadrotor (of sets); a `NearRotors` and a `NearBeam`, each or `Absent`."""

    first: Wall
    second: Wall
    rotors: NearRotors | Absent
    beam: NearBeam | Absent


class BeamContact(NamedTuple):
    """Contact of the beam about its centre: of its ends (sets), with the two nearest edges, with a wall's top."""

    ends: WallContact
    edge: WallContact
    other: WallContact
    top: WallContact


class NearWallContact(NamedTuple):
    """Contact of all parts with the walls near them: of guards (sets), rotors and beam, each or `Absent`."""

    guards: ContactPair
    rotors: ContactPair | Absent
    beam: BeamContact | Absent


@law
def contact_at_beam_point(w: WallToBeam, a: BeamAxis, along: Number, o: Vec3) -> WallContact:
    """Contact of the beam with a wall at a point `along` its axis [m], at the offset o [m]."""
    arm = scaled(a.direction, along)
    velocity = translated(a.velocity, cross(a.spin, arm))
    found = sphere_contact(w, translated(a.center, arm), o, w.beam.radius, velocity, a.spin)
    return found._replace(load=PartLoad(found.load.force, found.load.moment + cross(arm, found.load.force)))


@choice(absent="beam")
def beam_contact(
    beam: Beam | Absent, w: Walls, near: NearBeam | Absent, frame: PartsLayout, s: State
) -> BeamContact | Absent:
    """Contact of the beam with the near walls."""


@beam_contact.register(Beam)
def _capsule(beam: Beam, w: WallToBeam, near: NearBeam, frame: PartsLayout, s: State) -> BeamContact:
    a, half = beam_axis(frame.payload, s), beam.ends[1]
    i, j = point_by_edge(a, half, near.edge), point_by_edge(a, half, near.other_edge)
    k = point_by_top(a, half, near.topped)
    return BeamContact(
        contact_at_beam_point(w, a, beam.ends, offset(near.ends, beam_point(a, beam.ends))),
        contact_at_beam_point(w, a, i, offset(near.edge, beam_point(a, i))),
        contact_at_beam_point(w, a, j, offset(near.other_edge, beam_point(a, j))),
        contact_at_beam_point(w, a, k, offset_from_top(near.topped, beam_point(a, k))),
    )


@choice(absent=PartLoad(ZERO, ZERO))
def beam_load(contact: BeamContact | Absent, R: Mat3) -> PartLoad:
    """Load of the near walls on the payload."""


@beam_load.register(BeamContact)
def _of_capsule(c: BeamContact, R: Mat3) -> PartLoad:
    ends = PartLoad(sum_over_set(c.ends.load.force), sum_over_set(c.ends.load.moment))
    load = ends + c.edge.load + c.other.load + c.top.load
    return PartLoad(load.force, apply_transposed(R, load.moment))


@law
def near_wall_contact(w: Walls, near: NearWalls, frame: PartsLayout, s: State) -> NearWallContact:
    """Contact of all parts with the near walls."""
    R = rotation_from_quaternion(s.attitude)
    spin, arm = apply(R, s.rates), apply(R, frame.quadrotors)
    p, v = translated(s.position, arm), translated(s.velocity, cross(spin, arm))
    guards = ContactPair(
        sphere_contact(w, p, offset(near.first, p), w.guards, v, spin),
        sphere_contact(w, p, offset(near.second, p), w.guards, v, spin),
    )
    return NearWallContact(
        guards, rotor_wall_contact(w.rotors, w, near.rotors, s, R), beam_contact(w.beam, w, near.beam, frame, s)
    )


@law
def loads_of_walls(w: Walls, contact: NearWallContact, frame: PartsLayout, R: Mat3) -> PartLoads:
    """Loads of the near walls on all parts; R of the attitude."""
    load = contact.guards.first.load + contact.guards.second.load
    load = with_rotor_loads(contact.rotors, w.rotors, load, frame, R)
    return PartLoads(beam_load(contact.beam, R), PartLoad(load.force, apply_transposed(R, load.moment)))


@law
def near_wall_loads(w: Walls, near: NearWalls, frame: PartsLayout, s: State) -> PartLoads:
    """Loads of the near walls on all parts."""
    return loads_of_walls(w, near_wall_contact(w, near, frame, s), frame, rotation_from_quaternion(s.attitude))


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


@law
def nearest_with(w: Walls, wall: Wall, near: NearWalls, frame: PartsLayout, s: State) -> NearWalls:
    """The nearest walls, with `wall` (of numbers) taken into account."""
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), frame.quadrotors))
    return NearWalls(
        nearer(wall, near.first, p, p),
        second_nearest(wall, near.first, near.second, p, p, p),
        nearest_to_rotors_with(w.rotors, wall, near.rotors, s),
        nearest_to_beam_with(w.beam, wall, near.beam, frame, s),
    )


def no_walls_near(w: Walls) -> NearWalls:
    """No wall is near."""
    walls, ends = [Wall(*[each(n)(*[v] * n) for v in WALL]) for n in (len(w.guards), 2)]
    rotors = no_walls_near_rotors(w.rotors)
    return NearWalls(walls, walls, rotors, NearBeam(ends, WALL, WALL, WALL) if isinstance(w.beam, Beam) else Absent())


def walls(
    quadrotors: ArrayLike,
    guards: ArrayLike,
    mass: float,
    inertia: ArrayLike,
    step: float,
    *,
    friction: float,
    rotors: RotorSpheres | Absent = IN_GUARDS,
    beam: tuple[float, float] | None = None,
    payload: ArrayLike = (0.0, 0.0, 0.0),
    stiffness: float = 5000.0,
    damping_ratio: float = 0.5,
) -> Walls:
    """Contact of a vehicle with walls, with the given stiffness, or less for a long step [s] of the Runge-Kutta method.

    Args:
        quadrotors: N × 3, their centres of mass from the system's [m, body axes].
        guards: radius of the sphere about each of them [m], one number or N.
        mass: of the vehicle [kg].
        inertia: 3 × 3 about its centre of mass [kg·m²].
        step: [s].
        friction: μ of guards, rotors and beam on walls.
        rotors: a `RotorSpheres`, or `Absent` if all rotors are in their guard.
        beam: length [m] of the axis and radius [m] of a capsule along body y, if the payload is one.
        payload: its centre of mass from the system's [m, body axes].
        stiffness: of a contact [N/m].
        damping_ratio: of the vehicle oscillating on one contact, without rotation.
    """
    J, centers = array(inertia), array(quadrotors)
    radii = np.broadcast_to(guards, len(centers))
    spheres = list(zip(centers, radii, strict=True))
    if beam:
        half = 0.5 * beam[0]
        spheres += [(np.add(payload, [0.0, end, 0.0]), beam[1]) for end in (-half, half)]
    if isinstance(rotors, RotorSpheres):
        spheres += [(array([x, y, z]), radius) for x, y, z, radius in zip(*rotors.hub, rotors.radius, strict=True)]
    centers = array([tuple(center) for center, _ in spheres])  # where N acts, were all in contact at once
    k, c = softened_for_step(stiffness, 2.0 * damping_ratio * sqrt(stiffness * mass), mobility(centers, mass, J), step)
    tangential_mobility = sum(surface_mobility(center, radius, mass, J) for center, radius in spheres)
    shape = Beam(number(beam[1]), each(2)(-half, half)) if beam else Absent()
    reach = greatest([number(far + radius) for far, (_, radius) in zip(lengths(centers), spheres, strict=True)])
    return Walls(
        k,
        c,
        number(friction),
        minimum(c, 1.0 / (tangential_mobility * step)),
        each(len(radii))(*map(number, radii)),
        rotors,
        shape,
        reach,
    )
