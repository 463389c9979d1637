"""The record of touches: of each kind of part on floor and walls, the first touch, the greatest force, the impulse.

A rotor that touches anything stops for good. Feet on the floor are no touch. Forces are those of springs; impulses of
walls (`impulses`), whose mean force depends on the step, are left out.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra import greatest, maximum, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import NEVER, Number, PerRotor
from tandemlift.core.vector import ZERO, Absent, Vec3, each, set_of, total
from tandemlift.parts.contact.hull import Ellipsoids, FloorContact, Hull, HullContact
from tandemlift.parts.contact.polyhedron import Polyhedron, PolyhedronContact
from tandemlift.parts.contact.spheres import ContactPair, RotorSpheres
from tandemlift.parts.contact.wall_geometry import first_number, only_number
from tandemlift.parts.contact.walls import Beam, BeamContact, NearWallContact, Walls
from tandemlift.parts.mechanics.joint_loads import translated
from tandemlift.parts.mechanics.rigid_body import State


class TouchRecord(NamedTuple):
    """Touches of one kind of part on one surface.

    Of the first touch, `time` [s], `place` [m, world axes] and `part`, its number from 1; before it, `NEVER`, zero and
    0. If parts touch at once, the hardest counts. Of all parts together, `force`: the greatest sum of normal forces
    [N]; `impulse`: that of the normal forces [N·s].
    """

    time: Number
    place: Vec3
    part: Number
    force: Number
    impulse: Number


UNTOUCHED = TouchRecord(NEVER, ZERO, 0.0, 0.0, 0.0)


class SurfaceTouches(NamedTuple):
    """Records of rotors, guards and beam on floor or walls; `Absent` where a part has no shape to that surface."""

    rotors: TouchRecord | Absent
    guards: TouchRecord
    beam: TouchRecord | Absent


class Touches(NamedTuple):
    """1 for each rotor that still turns, 0 from its first touch on; the records on floor and walls, or `Absent`."""

    turning: PerRotor
    floor: SurfaceTouches | Absent
    walls: SurfaceTouches | Absent


class PartContacts(NamedTuple):
    """Normal force on every part of a kind [N], and where it acts [m, world axes]: sets."""

    normal: Any
    place: Vec3


class SurfaceContacts(NamedTuple):
    """Contact of rotors, guards and beam with a surface: `PartContacts`, or `Absent`."""

    rotors: PartContacts | Absent
    guards: PartContacts
    beam: PartContacts


@elementwise
def unless_touched(turning: Number, normal: Number) -> Number:
    """0 for what is touched or was before, else 1."""
    return where(normal > 0.0, 0.0, turning)


@elementwise
def first_or_second(first: Number, second: Number, a: Number, b: Number) -> Number:
    """b where the second normal force [N] is the greater, else a."""
    return where(second > first, b, a)


@law(absent="record")
def record_after(contacts: PartContacts, record: TouchRecord, t: Number, dt: Number) -> TouchRecord:
    """The record after a step of dt [s] that began at time t [s]; unchanged without contacts."""
    most = greatest(contacts.normal)
    part = first_number(contacts.normal, most)
    place = Vec3(*[total(only_number(axis, part)) for axis in contacts.place])
    is_first = where(record.part > 0.5, 0.0, where(most > 0.0, 1.0, 0.0)) > 0.5
    sum_of_normals = total(contacts.normal)
    return TouchRecord(
        where(is_first, t, record.time),
        where(is_first, place, record.place),
        where(is_first, part, record.part),
        maximum(record.force, sum_of_normals),
        record.impulse + sum_of_normals * dt,
    )


@law(absent="records")
def surface_records_with(contacts: SurfaceContacts, records: SurfaceTouches, t: Number, dt: Number) -> SurfaceTouches:
    """The records of a surface after a step, unchanged while it is out of reach."""
    return SurfaceTouches(
        record_after(contacts.rotors, records.rotors, t, dt),
        record_after(contacts.guards, records.guards, t, dt),
        record_after(contacts.beam, records.beam, t, dt),
    )


@law(absent="turning")
def untouched(contacts: PartContacts, turning: PerRotor) -> PerRotor:
    """The rotors that still turn after a step with these contacts of rotors."""
    return unless_touched(turning, contacts.normal)


@law(absent="turning")
def turning_after(contacts: SurfaceContacts, turning: PerRotor) -> PerRotor:
    """The rotors that still turn after a step with contacts of a surface."""
    return untouched(contacts.rotors, turning)


@law
def touches_after(
    touches: Touches, floor: SurfaceContacts | Absent, walls: SurfaceContacts | Absent, t: Number, dt: Number
) -> Touches:
    """The touches after a step of dt [s] that began at time t [s]; `floor`, `walls`: `SurfaceContacts` or `Absent`."""
    return Touches(
        turning_after(walls, turning_after(floor, touches.turning)),
        surface_records_with(floor, touches.floor, t, dt),
        surface_records_with(walls, touches.walls, t, dt),
    )


@elementwise
def thrust_if_turning(thrust: Number, turning: Number) -> Number:
    """The thrust of a rotor [N], 0 if it no longer turns."""
    return where(turning > 0.5, thrust, 0.0)


@law(absent="thrusts")
def of_turning_rotors(touches: Touches, thrusts: PerRotor) -> PerRotor:
    """The thrust of each rotor [N], 0 of one that has touched anything."""
    return thrust_if_turning(thrusts, touches.turning)


@law(absent="contact")
def floor_parts(contact: FloorContact, s: State) -> PartContacts:
    """Contacts of one kind of part with the floor."""
    return PartContacts(contact.normal, translated(s.position, contact.arm))


@law
def floor_contacts(contact: HullContact, s: State) -> SurfaceContacts:
    """Contacts of the vehicle in state `s` with the floor."""
    return SurfaceContacts(floor_parts(contact.rotors, s), floor_parts(contact.guards, s), floor_parts(contact.beam, s))


@law(absent="pair")
def harder_of(pair: ContactPair) -> PartContacts:
    """Contacts with two walls as one: both normal forces, at the place of the greater."""
    n, m = pair.first.normal, pair.second.normal
    places = zip(pair.first.place, pair.second.place, strict=True)
    return PartContacts(n + m, Vec3(*[first_or_second(n, m, a, b) for a, b in places]))


@choice(absent="contact")
def beam_parts(contact: BeamContact | PolyhedronContact | Absent) -> PartContacts | Absent:
    """Contacts of the payload with walls, wherever on it."""


@beam_parts.register(BeamContact)
def _of_beam(c: BeamContact) -> PartContacts:
    ends, single = c.ends, (c.edge, c.other, c.top)
    places = zip(ends.place, *[touch.place for touch in single], strict=True)
    normals = set_of([*ends.normal, *[touch.normal for touch in single]])  # type: ignore[misc]  # of a set
    return PartContacts(normals, Vec3(*[set_of([*both, *rest]) for both, *rest in places]))


@beam_parts.register(PolyhedronContact)
def _of_polyhedron(contact: PolyhedronContact) -> PartContacts:
    places = zip(*[c.place for c in contact], strict=True)
    normals = set_of([normal for c in contact for normal in c.normal])  # type: ignore[attr-defined]  # of a set
    return PartContacts(normals, Vec3(*[set_of([x for axis in axes for x in axis]) for axes in places]))


@law
def wall_contacts(contact: NearWallContact) -> SurfaceContacts:
    """Contacts of the vehicle with the walls near it."""
    return SurfaceContacts(harder_of(contact.rotors), harder_of(contact.guards), beam_parts(contact.beam))


def start_touches(floor: object, walls: object, rotors: int) -> Touches | Absent:
    """No touch yet, of `rotors` in all; `Absent` without a hull that meets the floor and without walls."""
    hull = getattr(floor, "hull", Absent())
    on_floor = SurfaceTouches(UNTOUCHED, UNTOUCHED, _unless_absent(hull.beam)) if isinstance(hull, Hull) else Absent()
    on_walls: SurfaceTouches | Absent = Absent()
    if isinstance(walls, Walls):
        on_walls = SurfaceTouches(_unless_absent(walls.rotors), UNTOUCHED, _unless_absent(walls.beam))
    if isinstance(on_floor, Absent) and isinstance(on_walls, Absent):
        return Absent()
    return Touches(each(rotors)(*[1.0] * rotors), on_floor, on_walls)


def _unless_absent(part: Ellipsoids | RotorSpheres | Beam | Polyhedron | Absent) -> TouchRecord | Absent:
    return part if isinstance(part, Absent) else UNTOUCHED
