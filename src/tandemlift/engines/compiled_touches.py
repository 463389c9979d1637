"""Touches of the compiled body: which parts touch floor and walls at the start of a step."""

from __future__ import annotations

from tandemlift.core.law import choice
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent
from tandemlift.engines.compiled_contact import CompiledPlant, DistantWalls, hull_contact_with
from tandemlift.parts.contact.hull import HullContact
from tandemlift.parts.contact.touches import (
    SurfaceContacts,
    Touches,
    floor_contacts,
    touches_after,
    wall_contacts,
)
from tandemlift.parts.contact.walls import NearWallContact, NearWalls, Walls, near_wall_contact
from tandemlift.parts.mechanics.loads import PartsLayout
from tandemlift.parts.mechanics.rigid_body import State


@choice(absent="walls")
def wall_contact_with(
    walls: Walls | DistantWalls | Absent, near: NearWalls | Absent, frame: PartsLayout, s: State
) -> NearWallContact | Absent:
    """Contact with the near walls; `Absent` where they are out of reach."""


@wall_contact_with.register(DistantWalls)
def _untouched_walls(walls: DistantWalls, near: NearWalls, frame: PartsLayout, s: State) -> Absent:
    return Absent()


@wall_contact_with.register(Walls)
def _near_walls(walls: Walls, near: NearWalls, frame: PartsLayout, s: State) -> NearWallContact:
    return near_wall_contact(walls, near, frame, s)


@choice(absent="contact")
def parts_touched(contact: HullContact | NearWallContact | Absent, s: State) -> SurfaceContacts | Absent:
    """The `SurfaceContacts` of a contact with floor or walls in state `s`, or `Absent`."""


@parts_touched.register(HullContact)
def _on_floor(contact: HullContact, s: State) -> SurfaceContacts:
    return floor_contacts(contact, s)


@parts_touched.register(NearWallContact)
def _on_walls(contact: NearWallContact, s: State) -> SurfaceContacts:
    return wall_contacts(contact)


@choice(absent="touches")
def touches_in(
    touches: Touches | Absent, plant: CompiledPlant, near: NearWalls | Absent, s: State, t: Number, dt: Number
) -> Touches | Absent:
    """The touches after a step of dt [s] that began at time t [s] in state `s`."""


@touches_in.register(Touches)
def _touches(
    touches: Touches, plant: CompiledPlant, near: NearWalls | Absent, s: State, t: Number, dt: Number
) -> Touches:
    floor, walls = hull_contact_with(plant.floor, s), wall_contact_with(plant.walls, near, plant.frame, s)
    return touches_after(touches, parts_touched(floor, s), parts_touched(walls, s), t, dt)
