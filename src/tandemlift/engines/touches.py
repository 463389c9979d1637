"""The record of touches: of the compiled body, and of a body in another engine from the contacts found there."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.law import choice, law
from tandemlift.core.types import Array, Number, flat
from tandemlift.core.vector import Absent, Vec3, set_of
from tandemlift.engines.compiled_contact import CompiledPlant, DistantWalls, hull_contact_with
from tandemlift.parts.contact.hull import HullContact
from tandemlift.parts.contact.touches import (
    PartContacts,
    SurfaceContacts,
    SurfaceTouches,
    Touches,
    TouchRecord,
    floor_contacts,
    start_touches,
    touches_after,
    wall_contacts,
)
from tandemlift.parts.contact.walls import NearWallContact, NearWalls, Walls, near_wall_contact
from tandemlift.parts.mechanics.joint_loads import PartsLayout
from tandemlift.parts.mechanics.rigid_body import State

__all__ = ["ContactLog", "SurfaceTouches", "TouchRecord", "Touches", "touches_in"]

SURFACES, KINDS = ("floor", "wall"), ("rotor", "guard", "beam")


class ContactLog:
    """Touches of a body, step by step.

    Args:
        floor: a `parts.contact.feet.Floor`, or `Absent`.
        walls: a `parts.contact.walls.Walls`, or `Absent`.
        quadrotors: how many.
        step: [s].

    Attributes:
        numbers: of a `parts.contact.touches.Touches`; empty if there is nothing to touch.
    """

    def __init__(self, floor: Any, walls: Any, quadrotors: int, step: float) -> None:
        self._touches = start_touches(floor, walls, 4 * quadrotors)
        self.numbers: Array = np.array(flat(self._touches))
        self._counts = {"rotor": 4 * quadrotors, "guard": quadrotors, "beam": 1}
        self._found: dict[tuple[str, str], tuple[Array, Array, Array]] = {}
        self._step, self._k = step, 0

    def add(self, surface: str, kind: str, index: int, normal: float, place: ArrayLike) -> None:
        """Note a contact at the end of this step.

        Args:
            surface: "floor" or "wall".
            kind: "rotor", "guard" or "beam".
            index: of the part, from 0; of rotor j of quadrotor i, 4 i + j.
            normal: force [N].
            place: [m, world axes] (3).
        """
        if not normal > 0.0:
            return
        count = self._counts[kind]
        fresh = np.zeros(count), np.zeros(count), np.zeros((3, count))
        sums, hardest, places = self._found.setdefault((surface, kind), fresh)
        sums[index] += normal
        if normal > hardest[index]:
            hardest[index], places[:, index] = normal, place

    def end_step(self) -> None:
        """Enter the contacts at the end of a step into the record."""
        self._k += 1
        if self._found and not isinstance(self._touches, Absent):
            floor, walls = (self._surface(surface) for surface in SURFACES)
            t = self._k * self._step
            self._touches = touches_after(self._touches, floor, walls, t, self._step)
            self.numbers[:] = flat(self._touches)
            self._found.clear()

    def _surface(self, surface: str) -> Any:
        """The contacts with a surface, or `Absent`."""
        parts = [self._contacts(surface, kind) for kind in KINDS]
        return Absent() if all(isinstance(part, Absent) for part in parts) else SurfaceContacts(*parts)

    def _contacts(self, surface: str, kind: str) -> Any:
        found = self._found.get((surface, kind))
        if found is None:
            return Absent()
        sums, _, (x, y, z) = found
        return PartContacts(set_of(sums.tolist()), Vec3(*[set_of(axis.tolist()) for axis in (x, y, z)]))


# ---- The compiled body: which parts touch floor and walls at the start of a step


@law(absent="walls", instead={DistantWalls: Absent()})
def wall_contact_with(walls: Walls, near: NearWalls, frame: PartsLayout, s: State) -> NearWallContact:
    """Contact with the near walls; `Absent` where they are out of reach."""
    return near_wall_contact(walls, near, frame, s)


@choice(absent="contact")
def parts_touched(contact: HullContact | NearWallContact | Absent, s: State) -> SurfaceContacts | Absent:
    """The `SurfaceContacts` of a contact with floor or walls in state `s`, or `Absent`."""


parts_touched.register(HullContact)(floor_contacts)


@parts_touched.register(NearWallContact)
def _on_walls(contact: NearWallContact, s: State) -> SurfaceContacts:
    return wall_contacts(contact)


@law(absent="touches")
def touches_in(
    touches: Touches, plant: CompiledPlant, near: NearWalls | Absent, s: State, t: Number, dt: Number
) -> Touches:
    """The touches after a step of dt [s] that began at time t [s] in state `s`."""
    floor, walls = hull_contact_with(plant.floor, s), wall_contact_with(plant.walls, near, plant.frame, s)
    return touches_after(touches, parts_touched(floor, s), parts_touched(walls, s), t, dt)
