"""Impulses that keep walls out of the core of every shape, however fast it comes: a soft shell about a hard core.

Springs (`walls`) give way to a blow, and one that reaches a shape's centre, or the axis of the beam, would push it out
on the other side. So the inner `CORE` of each radius r is hard. Its distance from a wall, d − CORE r, decreases at the
start of a step of dt at no more than it would take to close it within the step. With the approach rate ḋ = n·v of the
nearest point, and its acceleration d̈, with or without the springs of walls, whichever is smaller,

    ḋ ≥ ḋ_min = −(d − CORE r)/dt − ½ d̈ dt,        P = max(0, min(ḋ_min, −ḋ) − ḋ)/M,        M = n·(mobility) n.

The impulse P acts along n. It leaves ḋ at no more than −ḋ, so it takes P (2 ḋ + M P)/2 ≤ 0 of energy. In translation
the distance of convex shapes is convex, so the linear prediction is safe; the error of rotations is of third order.
Several contacts are solved one after another, the worst of each kind first (sequential impulses, Catto 2005); the bound
is that of speculative contacts. A touch that springs hold is not changed by a bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

from tandemlift.core.algebra import chosen, greatest, maximum, minimum, sqrt, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number, NumberSet
from tandemlift.core.vector import Absent, Vec3, apply, apply_transposed, cross, dot, is_set, set_of
from tandemlift.parts.contact.polyhedron import Polyhedron, PolyhedronContact
from tandemlift.parts.contact.spheres import ContactPair, RotorSpheres, WallContact, inverse_root
from tandemlift.parts.contact.wall_geometry import first_number, only_number
from tandemlift.parts.contact.walls import Beam, BeamContact, NearWallContact, Walls, loads_of_walls
from tandemlift.parts.mechanics.joint_loads import (
    PartLoad,
    PartLoads,
    PartsLayout,
    add_to_each,
    scaled,
    sum_over_set,
    translated,
)
from tandemlift.parts.mechanics.rigid_body import RigidBody, State, about_center, apply_inertia, at_position
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

CORE = 0.25  # of the radius; the rest is left to the springs
SWEEPS = 3  # over all kinds of contact; what is left of a collision of several parts is stopped in the next step
FREELY = -1e9  # m/s: the rate of what has no core


class Approach(NamedTuple):
    """The approach of shapes, a set, to walls.

    `normal`: from the wall, world axes; `lever` [m, body axes]: arm × normal, so that the rate of the distance is
    normal · velocity + lever · rates; `mobility` [1/kg]: its change by a unit impulse; `least`: ḋ_min [m/s].
    """

    normal: Vec3
    lever: Vec3
    mobility: NumberSet
    least: NumberSet


class WallImpulses(NamedTuple):
    """The state after impulses of walls, and these by their mean forces over the step [N]: contact, loads on parts."""

    state: State
    contact: NearWallContact | Absent
    loads: PartLoads | Absent


@elementwise
def least_rate(distance: Number, radius: Number, acceleration: Number, dt: Number) -> Number:
    """ḋ_min [m/s] at a distance of the nearest point from a wall; a shape without radius has none."""
    closing = -maximum(distance - CORE * radius, 0.0) / dt - 0.5 * acceleration * dt
    return where(radius > 0.0, closing, FREELY)


@elementwise
def change_needed(rate: Number, bound: Number) -> Number:
    """The change of a distance's rate by an impulse [m/s]: to the bound ḋ_min, but at most to −ḋ."""
    return maximum(minimum(bound, -rate) - rate, 0.0)


@law
def rate_along(n: Vec3, lever: Vec3, velocity: Vec3, rates: Vec3) -> Number:
    """The rate of distances along n [m/s]; for a motion, its derivative without the terms of rotation."""
    return dot(n, velocity) + dot(lever, rates)


@law
def approach(
    c: WallContact, radius: Number, body: RigidBody, s: State, free: State, sprung: State, dt: Number
) -> Approach:
    """The approach of shapes to walls at contacts in state `s`, by its motion without and with their springs."""
    R, square = rotation_from_quaternion(s.attitude), dot(c.offset, c.offset)
    arm, n = translated(-s.position, c.place + c.offset), scaled(c.offset, inverse_root(square))
    lever, spin = apply_transposed(R, cross(arm, n)), apply(R, s.rates)
    turning = dot(n, spin) * dot(arm, spin) - dot(n, arm) * dot(spin, spin)
    freely = rate_along(n, lever, free.velocity, free.rates)
    acceleration = turning + minimum(freely, rate_along(n, lever, sprung.velocity, sprung.rates))
    turned = about_center(body.center, s.attitude, n, lever)
    mobility = add_to_each(dot(turned, apply_inertia(body.inverse_inertia, turned)), body.inverse_mass)
    return Approach(n, lever, mobility, least_rate(sqrt(square), radius, acceleration, dt))


@law
def after_worst(a: Approach, body: RigidBody, s: State) -> tuple[State, Any]:
    """The state once the worst of a set of contacts was stopped, and the impulses of all [N·s], a set."""
    change = change_needed(rate_along(a.normal, a.lever, s.velocity, s.rates), a.least)
    worst = first_number(change, greatest(change))
    impulse = only_number(change / a.mobility, worst)
    forces, moments = sum_over_set(scaled(a.normal, impulse)), sum_over_set(scaled(a.lever, impulse))
    turned = apply_inertia(body.inverse_inertia, about_center(body.center, s.attitude, forces, moments))
    velocity = at_position(body.center, s.attitude, s.velocity + forces * body.inverse_mass, turned)
    return State(s.position, velocity, s.attitude, s.rates + turned), impulse


T = TypeVar("T", bound=tuple[Any, ...])


@law
def in_one_set(several: T, *others: Any) -> T:
    """Nested values of a set and of single contacts, as values of one set."""
    if is_set(several):
        joined: Any = set_of([*several, *others])
        return joined
    return type(several)(*[in_one_set(*parts) for parts in zip(several, *others, strict=True)])


@law
def struck(c: WallContact, force: Number, arm: Vec3) -> WallContact:
    """A contact that presses by a force [N], at `arm` from its part's centre [m]. All may be of sets."""
    pressing = scaled(c.offset, inverse_root(dot(c.offset, c.offset)) * force)
    return WallContact(force, c.place, c.offset, PartLoad(pressing, cross(arm, pressing)))


@law
def struck_spheres(pair: ContactPair | Absent, forces: Sequence[NumberSet]) -> Any:
    """Spheres that press on two walls by forces [N]; `Absent` of `Absent`."""
    return type(pair)(*[struck(c, force, -c.offset) for c, force in zip(pair, forces, strict=True)])


@choice(absent="contact")
def struck_beam(
    contact: BeamContact | PolyhedronContact | Absent, several: Sequence[NumberSet], center: Vec3
) -> BeamContact | PolyhedronContact | Absent:
    """A payload, by its origin [m, world axes], that presses on walls by forces [N].

    Those of a beam are one set, of its ends and of its length; a convex body has a set for each of its contacts.
    """


@struck_beam.register(BeamContact)
def _struck_beam(contact: BeamContact, several: Sequence[NumberSet], center: Vec3) -> BeamContact:
    (ends, *single), (forces,) = contact, several
    return BeamContact(
        struck(ends, set_of(forces[:2]), translated(-center, ends.place)),
        *[struck(c, force, c.place - center) for c, force in zip(single, forces[2:], strict=True)],
    )


@struck_beam.register(PolyhedronContact)
def _struck_polyhedron(contact: PolyhedronContact, several: Sequence[NumberSet], center: Vec3) -> PolyhedronContact:
    arms = [translated(-center, c.place) for c in contact]
    return PolyhedronContact(*map(struck, contact, several, arms))


@law
def impulses_of_walls(
    w: Walls,
    contact: NearWallContact,
    frame: PartsLayout,
    body: RigidBody,
    s: State,
    free: State,
    sprung: State,
    dt: Number,
) -> WallImpulses:
    """The impulses of walls at the start of a step of dt [s].

    Args:
        w: the contact shapes.
        contact: contact with the walls near them in state `s`.
        frame: where the parts are.
        body: its mass and inertia.
        s: the state before.
        free: its motion without walls.
        sprung: its motion with the springs of walls.
        dt: [s].
    """
    shapes: list[tuple[WallContact, Number]] = [(c, w.guards) for c in contact.guards]
    if isinstance(w.rotors, RotorSpheres):
        shapes += [(c, w.rotors.radius) for c in contact.rotors]
    if isinstance(w.beam, Beam):
        shapes.append((in_one_set(*contact.beam), w.beam.radius))
    if isinstance(w.beam, Polyhedron):
        shapes += [(c, w.beam.radius) for c in contact.beam]
    approaches = [approach(c, radius, body, s, free, sprung, dt) for c, radius in shapes]
    after, forces = s, [a.mobility * 0.0 for a in approaches]
    for i, a in [*enumerate(approaches)] * SWEEPS:
        after, impulse = after_worst(a, body, after)
        forces[i] = forces[i] + impulse * (1.0 / dt)
    # without an impulse, the state keeps its bits
    after = chosen(greatest([greatest(force) for force in forces]), after, s)
    R, spheres = rotation_from_quaternion(s.attitude), 2 + len(contact.rotors)
    guards, rotors = struck_spheres(contact.guards, forces[:2]), struck_spheres(contact.rotors, forces[2:spheres])
    beam = struck_beam(contact.beam, forces[spheres:], s.position + apply(R, frame.payload))
    struck_parts = NearWallContact(guards, rotors, beam)
    return WallImpulses(after, struck_parts, loads_of_walls(w, struck_parts, frame, R))
