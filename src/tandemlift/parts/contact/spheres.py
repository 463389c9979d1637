"""Contact of spheres with walls, and of rotors that stand out of their guard, each a sphere about its hub.

A rotor is in its guard where its rim is at most `GUARD_DEFLECTION` outside it. Against a wall such a rotor has no shape
of its own, and the guard's sphere stands for it.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import greatest, maximum, sqrt, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number, PerRotor, number
from tandemlift.core.vector import Absent, Mat3, Vec3, apply, cross, dot, set_of, spread
from tandemlift.parts.contact.hull import rotor_sums
from tandemlift.parts.contact.springs import Springs, friction_factor, spring_damper
from tandemlift.parts.contact.wall_geometry import Wall, no_walls, offset, two_nearest_to
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartsLayout, scaled, translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

LEAST_SQUARE = 1e-18  # m²: no direction is known at this distance
GUARD_DEFLECTION = 0.02  # m, deflection of a guard under some 100 N


@elementwise
def inverse_root(square: Number) -> Number:
    """1/√square, bounded."""
    return 1.0 / sqrt(maximum(square, LEAST_SQUARE))


@elementwise
def penetration(distance: Number, radius: Number) -> Number:
    """Penetration [m] of a sphere whose centre is at a distance."""
    return radius - distance


class WallContact(NamedTuple):
    """Contact of a part with a wall, or of sets: N [N], nearest point of the wall [m], load about the part's centre.

    World axes; `offset` [m]: of the part's nearest point, before its radius, from that of the wall.
    """

    normal: Number
    place: Vec3
    offset: Vec3
    load: PartLoad


class ContactPair(NamedTuple):
    """Contact with the two nearest walls."""

    first: WallContact
    second: WallContact


@law
def sphere_contact(k: Springs, p: Vec3, o: Vec3, radius: Number, velocity: Vec3, spin: Vec3) -> WallContact:
    """Contact of a wall with a sphere that moves at a velocity [m/s] and rotates at `spin` [rad/s], all in world axes.

    p is its centre, o the offset of p from the wall [m]; the moment is about p [N·m].
    """
    square = dot(o, o)
    inverse = inverse_root(square)
    n = scaled(o, inverse)
    rate = -dot(n, velocity)
    normal = spring_damper(penetration(square * inverse, radius), rate, k.stiffness, k.damping)
    sliding = scaled(velocity - cross(spin, o) + scaled(n, rate), k.tangential_damping)
    factor = friction_factor(dot(sliding, sliding), normal * k.friction)
    force = scaled(n, normal) - scaled(sliding, factor)
    return WallContact(normal, p - o, o, PartLoad(force, cross(force, o)))


@law
def about_arm(c: WallContact, arm: Vec3) -> WallContact:
    """A contact with its moment about a point from which the part is at `arm` [m, world axes]."""
    return c._replace(load=PartLoad(c.load.force, c.load.moment + cross(arm, c.load.force)))


@law
def contact_pair(
    k: Springs, p: Vec3, first: Wall, second: Wall, radius: Number, velocity: Vec3, spin: Vec3
) -> ContactPair:
    """Contact of spheres about p with the two walls nearest to each; otherwise as `sphere_contact`."""
    return ContactPair(
        sphere_contact(k, p, offset(first, p), radius, velocity, spin),
        sphere_contact(k, p, offset(second, p), radius, velocity, spin),
    )


class RotorSpheres(NamedTuple):
    """Spheres of the rotors, as sets of four a quadrotor: hub from the system's centre of mass, radius [m].

    The radius of a rotor in its guard is 0.
    """

    hub: Vec3
    radius: PerRotor


class NearRotors(NamedTuple):
    """The two walls nearest to every rotor (of sets)."""

    first: Wall
    second: Wall


@law(absent="rotors")
def rotor_wall_contact(rotors: RotorSpheres, k: Springs, near: NearRotors, s: State, R: Mat3) -> ContactPair:
    """Contact of the rotors with the walls nearest to each, about their hubs; `Absent` where all are in guards."""
    spin, arm = apply(R, s.rates), apply(R, rotors.hub)
    p, v = translated(s.position, arm), translated(s.velocity, cross(spin, arm))
    return contact_pair(k, p, near.first, near.second, rotors.radius, v, spin)


@law(absent="load")
def with_rotor_loads(
    contact: ContactPair, rotors: RotorSpheres, load: PartLoad, frame: PartsLayout, R: Mat3
) -> PartLoad:
    """A load on the quadrotors about their centres, world axes, with that of the walls on their rotors."""
    more = contact.first.load + contact.second.load
    force, moment = rotor_sums(more.force), rotor_sums(more.moment + cross(apply(R, rotors.hub), more.force))
    return PartLoad(load.force + force, load.moment + moment - cross(apply(R, frame.quadrotors), force))


@law(absent="near")
def nearest_to_rotors_with(rotors: RotorSpheres, wall: Wall, near: NearRotors, s: State) -> NearRotors:
    """The walls nearest to the rotors, with `wall` taken into account."""
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), rotors.hub))
    return NearRotors(*two_nearest_to(p, wall, *near))


def no_walls_near_rotors(rotors: RotorSpheres | Absent) -> NearRotors | Absent:
    """No wall is near."""
    if isinstance(rotors, Absent):
        return rotors
    nowhere = no_walls(len(rotors.radius))
    return NearRotors(nowhere, nowhere)


def rotor_spheres(vehicle: Vehicle) -> RotorSpheres | Absent:
    """The spheres of a vehicle's rotors that stand out of their guard; `Absent` if all are in it."""
    sizes = list[Number]()
    for q in vehicle.quadrotors:
        rims = [sqrt(x * x + y * y) + q.rotor_radius for x, y in q.rotors]
        sizes += [where(rim > q.guard_radius + GUARD_DEFLECTION, q.rotor_radius, 0.0) for rim in rims]
    if not greatest(sizes) > 0.0:
        return Absent()
    return RotorSpheres(spread(vehicle.hubs), set_of(list(map(number, sizes))))
