"""Contact of rotors, guards and payload with a level floor, in every attitude.

Rotor discs and the quadrotors' guards are flat ellipsoids: radius r across body z, half thickness c along it. The ends
of the beam are spheres (r = c), as the lowest point of a capsule is always at one of its ends; so are the corners of a
convex body, small ones. With body z at b, and with the part of the vertical n that lies in the disc, u = n − (b·n) b,
a shape reaches below its centre by

    h = √(r² |u|² + c² (b·n)²),        at its point        −(c² n + (r² − c²) u)/h.

That point is −∂h/∂n, so δ = z_floor − z + h changes at the rate at which the point moves down. Both forces act there:

    N = max(0, k δ + c δ̇) if δ > 0, else 0         F = −c_t v, shortened to the length μ N if it is longer,

with v the sliding velocity. Thus k δ is a spring, the rest dissipates, and contact never adds energy.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import absolute, greatest, least, minimum, sqrt
from tandemlift.core.arrays import array, largest, lengths
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Array, Condition, Number, NumberSet, number
from tandemlift.core.vector import (
    ZERO,
    Absent,
    Mat3,
    Vec3,
    apply,
    apply_transposed,
    cross,
    dot,
    quarters,
    set_of,
    spread,
    vec3,
)
from tandemlift.parts.contact.springs import friction_factor, mobility, softened_for_step, spring_damper
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartLoads, PartsLayout, add_to_each, sum_over_set
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import world_z_in_body
from tandemlift.parts.mechanics.vehicle import Vehicle

MAX_ACCELERATION = 500.0  # m/s², more than rotors, pushes and walls give
MAX_ANGULAR_ACCELERATION = 1000.0  # rad/s², more than rotors give
HALF_THICKNESS = 0.01  # m, of a rotor's disc and of a guard
CORNER = 1e-3  # m, radius of the corners of a convex body
STIFFNESS, DAMPING_RATIO = 20000.0, 0.2  # N/m of a contact; of the vehicle on it, without rotation


class Ellipsoids(NamedTuple):
    """Shapes that meet the floor, as sets: centre from the system's centre of mass [m, body axes], r and c [m]."""

    center: Vec3
    radius: NumberSet
    half_thickness: NumberSet


class Hull(NamedTuple):
    """The parts of a vehicle besides its feet that touch the floor; of one contact k [N/m], c and c_t [N·s/m].

    `rotors`: number j of quadrotor i, both from 0, is 4 i + j; `guards`: one for each quadrotor; `beam`: its two ends,
    at −y and at +y, or the corners of a convex body, or `Absent` if the payload has no shape. All are in a box about
    `middle` with sides of twice `half` [m, body axes], no further than `reach` [m] from the centre of mass.
    """

    stiffness: Number
    damping: Number
    tangential_damping: Number
    rotors: Ellipsoids
    guards: Ellipsoids
    beam: Ellipsoids | Absent
    middle: Vec3
    half: Vec3
    reach: Number


class FloorContact(NamedTuple):
    """Contact of shapes, as sets, world axes: lowest point from the system's centre of mass [m], N [N], force [N]."""

    arm: Vec3
    normal: NumberSet
    force: Vec3


class HullContact(NamedTuple):
    """Contact of all parts with the floor; `beam` is `Absent` without a beam."""

    rotors: FloorContact
    guards: FloorContact
    beam: FloorContact | Absent


@elementwise
def reach_below(radius: Number, half_thickness: Number, leaning: Number, level: Number) -> Number:
    """h [m], how far a shape reaches below its centre; |u|² and (b·n)²: `level` is 1 where it lies flat, else less."""
    return sqrt(radius * radius * leaning + half_thickness * half_thickness * level)


@elementwise
def sideways(radius: Number, half_thickness: Number, below: Number, along: Number) -> Number:
    """Horizontal offset of a shape's lowest point from its centre [m], along an axis on which n − u is `along`."""
    return (radius * radius - half_thickness * half_thickness) / below * along


@law(absent="shapes")
def floor_contact(shapes: Ellipsoids, hull: Hull, friction: Number, height: Number, s: State, R: Mat3) -> FloorContact:
    """Contact of shapes, or of `Absent`, with a floor at a height z [m]; R of the state's attitude."""
    leaning, level = R.x.z * R.x.z + R.y.z * R.y.z, R.z.z * R.z.z
    below = reach_below(shapes.radius, shapes.half_thickness, leaning, level)
    center = apply(R, shapes.center)
    arm = Vec3(
        center.x + sideways(shapes.radius, shapes.half_thickness, below, R.x.z * R.z.z),
        center.y + sideways(shapes.radius, shapes.half_thickness, below, R.y.z * R.z.z),
        center.z - below,
    )
    turn = cross(apply(R, s.rates), arm)
    depth, rate = add_to_each(-arm.z, height - s.position.z), add_to_each(-turn.z, -s.velocity.z)
    normal = spring_damper(depth, rate, hull.stiffness, hull.damping)
    drag_x = add_to_each(turn.x, s.velocity.x) * hull.tangential_damping
    drag_y = add_to_each(turn.y, s.velocity.y) * hull.tangential_damping
    factor = friction_factor(drag_x * drag_x + drag_y * drag_y, normal * friction)
    return FloorContact(arm, normal, Vec3(-(drag_x * factor), -(drag_y * factor), normal))


@law
def hull_contact(hull: Hull, friction: Number, height: Number, s: State, R: Mat3) -> HullContact:
    """Contact of all parts with a floor at a height z [m]; R of the state's attitude."""
    return HullContact(
        floor_contact(hull.rotors, hull, friction, height, s, R),
        floor_contact(hull.guards, hull, friction, height, s, R),
        floor_contact(hull.beam, hull, friction, height, s, R),
    )


@law
def summed_load(contact: FloorContact, center: Vec3) -> PartLoad:
    """Load of all shapes of one part about its centre, which is at `center` from the system's; world axes."""
    force = sum_over_set(contact.force)
    return PartLoad(force, sum_over_set(cross(contact.arm, contact.force)) - cross(center, force))


@law(absent=PartLoad(ZERO, ZERO))
def beam_end_load(contact: FloorContact, center: Vec3) -> PartLoad:
    """Load of the floor on the beam, world axes."""
    return summed_load(contact, center)


@law
def rotor_sums(v: Vec3) -> Vec3:
    """For every quadrotor, the sum of a vector over its four rotors."""
    x, y, z = quarters(v.x), quarters(v.y), quarters(v.z)
    return Vec3(
        x.first + x.second + x.third + x.fourth,
        y.first + y.second + y.third + y.fourth,
        z.first + z.second + z.third + z.fourth,
    )


@law
def hull_loads(contact: HullContact, frame: PartsLayout, R: Mat3) -> PartLoads:
    """Loads of the floor on all parts; R of the attitude."""
    rotors, guards = contact.rotors, contact.guards
    force = rotor_sums(rotors.force) + guards.force
    moment = rotor_sums(cross(rotors.arm, rotors.force)) + cross(guards.arm, guards.force)
    about_each = moment - cross(apply(R, frame.quadrotors), force)
    beam = beam_end_load(contact.beam, apply(R, frame.payload))
    return PartLoads(
        PartLoad(beam.force, apply_transposed(R, beam.moment)), PartLoad(force, apply_transposed(R, about_each))
    )


@law
def hull_may_touch(hull: Hull, height: Number, s: State, time: Number) -> Condition:
    """1 if any part may touch the floor at z = `height` [m] within `time` [s] of state `s`, else 0.

    The distance that a point may fall is doubled for safety.
    """
    up, way = world_z_in_body(s.attitude), sqrt(dot(s.rates, s.rates)) * hull.reach
    lowest = s.position.z + dot(up, hull.middle) - dot(absolute(up), hull.half)
    faster = (MAX_ACCELERATION + MAX_ANGULAR_ACCELERATION * hull.reach) * time
    return lowest - 2.0 * time * (way - minimum(s.velocity.z, 0.0) + faster) < height


def lowest_of_hull(hull: Hull, R: Mat3) -> Number:
    """z of the lowest point of a hull from the centre of mass [m]; R of the attitude."""
    leaning, level, found = R.x.z * R.x.z + R.y.z * R.y.z, R.z.z * R.z.z, list[Number]()
    for p in (hull.rotors, hull.guards, hull.beam):
        if isinstance(p, Ellipsoids):
            found += apply(R, p.center).z - reach_below(p.radius, p.half_thickness, leaning, level)
    return least(found)


def hull(vehicle: Vehicle, mass: float, step: float) -> Hull:
    """The shapes of a vehicle that touch the floor, on springs of `STIFFNESS`, or softer for a long step.

    Args:
        vehicle: whose rotors, guards and payload touch the floor.
        mass: of the real vehicle [kg].
        step: of the Runge-Kutta method [s].
    """
    fleet, rotors = vehicle.quadrotors, vehicle.rotor_count
    ends, radius = _payload_ends(vehicle)
    points = np.concatenate([vehicle.hubs, vehicle.lever_arms, ends])
    radii = array([*[q.rotor_radius for q in fleet for _ in range(4)], *[q.guard_radius for q in fleet]])
    radii = np.concatenate([radii, [radius] * len(ends)])
    half_thickness = array([HALF_THICKNESS] * (rotors + len(fleet)) + [radius] * len(ends))
    body_mobility = mobility(points, mass, array(vehicle.inertia))
    k, c = softened_for_step(STIFFNESS, 2.0 * DAMPING_RATIO * sqrt(STIFFNESS * mass), body_mobility, step)
    sizes = np.column_stack([radii, radii, half_thickness])
    low, high = -largest(sizes - points, axis=0), largest(sizes + points, axis=0)

    def shapes(part: slice) -> Ellipsoids:
        columns = ([number(x) for x in values[part]] for values in (radii, half_thickness))
        return Ellipsoids(spread(points[part]), *map(set_of, columns))

    return Hull(
        stiffness=k,
        damping=c,
        tangential_damping=minimum(c, 1.0 / (body_mobility * step)),
        rotors=shapes(slice(rotors)),
        guards=shapes(slice(rotors, rotors + len(fleet))),
        beam=shapes(slice(rotors + len(fleet), None)) if len(ends) else Absent(),
        middle=vec3((low + high) * 0.5),
        half=vec3((high - low) * 0.5),
        reach=greatest([number(far) for far in lengths(points) + radii]),
    )


def _payload_ends(vehicle: Vehicle) -> tuple[Array, Number]:
    """Centres (n, 3) [m] and radius [m] of the spheres of a payload: the ends of a beam, or corners of bodies."""
    if vehicle.beam is not None:
        length, radius = vehicle.beam
        return np.add(vehicle.origin, [[0.0, 0.5 * side * length, 0.0] for side in (-1.0, 1.0)]), radius
    corners = [body.inset(CORNER) for body in vehicle.payload.hulls]
    return np.add(vehicle.origin, np.concatenate(corners) if corners else np.zeros((0, 3))), CORNER
