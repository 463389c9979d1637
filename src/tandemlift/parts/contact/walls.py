"""Contact of the quadrotors and of the payload with walls.

A quadrotor's shape is a sphere about its centre of mass, its guard, and one about each rotor that stands out of it
(`spheres`). The payload is a capsule (`beam_axis`) or a convex body (`polyhedron`).
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

from tandemlift.core.algebra import greatest, minimum, sqrt
from tandemlift.core.arrays import array, lengths
from tandemlift.core.law import law
from tandemlift.core.types import Array, Number, PerQuadrotor, number
from tandemlift.core.vector import Absent, Mat3, apply, apply_transposed, cross, set_of
from tandemlift.parts.contact.beam_axis import (
    Beam,
    BeamContact,
    NearBeam,
    beam_contact,
    beam_load,
    nearest_to_beam_with,
)
from tandemlift.parts.contact.polyhedron import (
    NearPolyhedron,
    Polyhedron,
    PolyhedronContact,
    no_walls_near_polyhedron,
    polyhedron,
)
from tandemlift.parts.contact.spheres import (
    ContactPair,
    NearRotors,
    RotorSpheres,
    contact_pair,
    nearest_to_rotors_with,
    no_walls_near_rotors,
    rotor_spheres,
    rotor_wall_contact,
    with_rotor_loads,
)
from tandemlift.parts.contact.springs import Springs, mobility, softened_for_step, surface_mobility
from tandemlift.parts.contact.wall_geometry import WALL, Wall, no_walls, two_nearest_to
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartLoads, PartsLayout, translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

EDGES = 3  # of a body, which may press at a corner, too


class Walls(NamedTuple):
    """Contact with walls by `springs`; `guards`: radius of every quadrotor's sphere [m].

    `rotors`: a `RotorSpheres`, or `Absent` if all rotors are in their guard; `beam`: a `Beam`, a
    `Polyhedron`, or `Absent` if the payload has no shape; `reach` [m]: of all these from the centre of mass.
    """

    springs: Springs
    guards: PerQuadrotor
    rotors: RotorSpheres | Absent
    beam: Beam | Polyhedron | Absent
    reach: Number


class NearWalls(NamedTuple):
    """The two walls nearest to every quadrotor (of sets); those near the rotors and the payload, or `Absent`."""

    first: Wall
    second: Wall
    rotors: NearRotors | Absent
    beam: NearBeam | NearPolyhedron | Absent


class NearWallContact(NamedTuple):
    """Contact of all parts with the walls near them: of guards (sets), rotors and beam, each or `Absent`."""

    guards: ContactPair
    rotors: ContactPair | Absent
    beam: BeamContact | PolyhedronContact | Absent


@law
def near_wall_contact(w: Walls, near: NearWalls, frame: PartsLayout, s: State) -> NearWallContact:
    """Contact of all parts with the near walls."""
    R = rotation_from_quaternion(s.attitude)
    spin, arm = apply(R, s.rates), apply(R, frame.quadrotors)
    p, v = translated(s.position, arm), translated(s.velocity, cross(spin, arm))
    return NearWallContact(
        contact_pair(w.springs, p, near.first, near.second, w.guards, v, spin),
        rotor_wall_contact(w.rotors, w.springs, near.rotors, s, R),
        beam_contact(w.beam, w.springs, near.beam, frame, s),
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


@law
def nearest_with(w: Walls, wall: Wall, near: NearWalls, frame: PartsLayout, s: State) -> NearWalls:
    """The nearest walls, with `wall` (of numbers) taken into account."""
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), frame.quadrotors))
    return NearWalls(
        *two_nearest_to(p, wall, near.first, near.second),
        nearest_to_rotors_with(w.rotors, wall, near.rotors, s),
        nearest_to_beam_with(w.beam, wall, near.beam, frame, s),
    )


def no_walls_near(w: Walls) -> NearWalls:
    """No wall is near."""
    nowhere = no_walls(len(w.guards))
    beam = NearBeam(no_walls(2), WALL, WALL, WALL) if isinstance(w.beam, Beam) else no_walls_near_polyhedron(w.beam)
    return NearWalls(nowhere, nowhere, no_walls_near_rotors(w.rotors), beam)


def walls(
    vehicle: Vehicle, mass: float, step: float, friction: float, stiffness: float = 5000.0, damping_ratio: float = 0.5
) -> Walls:
    """Contact of a vehicle with walls, with the given stiffness, or less for a long step of the Runge-Kutta method.

    Args:
        vehicle: whose guards, rotors and payload touch walls.
        mass: of the real vehicle [kg].
        step: [s].
        friction: μ of guards, rotors and payload on walls.
        stiffness: of a contact [N/m].
        damping_ratio: of the vehicle oscillating on one contact, without rotation.
    """
    J, origin, hulls = array(vehicle.inertia), vehicle.origin, vehicle.payload.hulls
    shape: Beam | Polyhedron | Absent = polyhedron(hulls)
    if vehicle.beam is not None:
        length, radius = vehicle.beam
        shape = Beam(number(radius), set_of([-0.5 * length, 0.5 * length]))
    rotors, radii = rotor_spheres(vehicle), [number(q.guard_radius) for q in vehicle.quadrotors]
    of_payload = _payload_spheres(shape, origin)
    spheres = [*zip(array(vehicle.lever_arms), radii, strict=True), *of_payload]
    if isinstance(rotors, RotorSpheres):
        spheres += [(array([x, y, z]), radius) for x, y, z, radius in zip(*rotors.hub, rotors.radius, strict=True)]
    several = spheres + of_payload * EDGES if isinstance(shape, Polyhedron) else spheres
    pressed = array([tuple(center) for center, _ in several])  # where N acts, were all in contact at once
    k, c = softened_for_step(stiffness, 2.0 * damping_ratio * sqrt(stiffness * mass), mobility(pressed, mass, J), step)
    tangential_mobility = sum(surface_mobility(center, radius, mass, J) for center, radius in spheres)
    reach = greatest([number(far + radius) for far, (_, radius) in zip(lengths(pressed), several, strict=True)])
    for body in hulls:
        reach = max(reach, float(lengths(np.add(origin, body.corners)).max()))
    # with more tangential damping, friction would reverse the sliding within a step
    springs = Springs(k, c, number(friction), minimum(c, 1.0 / (tangential_mobility * step)))
    return Walls(springs, set_of(radii), rotors, shape, reach)


def _payload_spheres(shape: Beam | Polyhedron | Absent, origin: Array) -> list[tuple[Array, Number]]:
    """Centre [m] and radius [m] of the ends of a beam, or of the corners of a body."""
    if isinstance(shape, Beam):
        return [(np.add(origin, [0.0, end, 0.0]), shape.radius) for end in shape.ends]
    if isinstance(shape, Absent):
        return []
    return [(np.add(origin, corner), shape.radius) for corner in np.array(shape.corners).T]
