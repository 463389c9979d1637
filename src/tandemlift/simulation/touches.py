"""The touches of a flight: the record of its last state in words and numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.vector import Absent, Vec3
from tandemlift.engines.touches import SurfaceTouches, Touches, TouchRecord
from tandemlift.flight.record import Flight
from tandemlift.parts.guidance.contact_hold import BEAM, DIRECTIONS, HALF_PLACES, PLACES, code_of
from tandemlift.simulation.loop.step import FlightState

SIDES = ("−", "", "+")


def describe_contact(code: int) -> str:
    """The part that touches, its place, and the direction of the wall in world axes, from `contact_hold.code_of`."""
    rest, place = divmod(code, int(PLACES))
    part, direction = divmod(rest, int(DIRECTIONS))
    sides = zip((SIDES[direction // 3], SIDES[direction % 3]), "xy", strict=True)
    signs = [f"{sign}{axis}" for sign, axis in sides if sign]
    along = (place - int(HALF_PLACES)) / 100.0
    where = f"beam, {abs(along):.2f} m from its centre" if part == int(BEAM) else f"guard of quadrotor {part}"
    return f"{where}, towards {' '.join(signs) or 'no side'}"


def contact_codes(flight: Flight) -> list[int]:
    """The code of the contact in each sample of a flight, 0 for none; an empty list if the flight estimates none."""
    if "contact_part" not in flight:
        return []
    columns = zip(flight["contact_part"], flight["contact_along_beam"], flight["contact_normal"], strict=True)
    return [int(code_of(part, Vec3(*map(float, normal)), along)) if part else 0 for part, along, normal in columns]


class TouchReport(NamedTuple):
    """The touches of one kind of part on one surface.

    Attributes:
        part: that touched first, such as "rotor 3 of quadrotor 1", "guard of quadrotor 2" or "beam".
        surface: "floor" or "wall".
        time: of the first touch [s].
        place: of it [m, world axes].
        force: the greatest sum of normal forces on all parts of this kind [N].
        impulse: that of these forces [N s].
    """

    part: str
    surface: str
    time: float
    place: tuple[float, float, float]
    force: float
    impulse: float


def touches_of(flight_state: FlightState) -> list[TouchReport]:
    """The touches of a flight up to this state, in the order of time.

    Feet on the floor are no touch. Floor and walls have up to one report each for rotors, guards and beam.
    """
    touches: Any = flight_state.touches
    if not isinstance(touches, Touches):
        return []
    found = [*_of_surface(touches.floor, "floor"), *_of_surface(touches.walls, "wall")]
    return sorted(found, key=lambda report: report.time)


def _of_surface(records: SurfaceTouches | Absent, surface: str) -> list[TouchReport]:
    if not isinstance(records, SurfaceTouches):
        return []
    found = []
    for kind, record in zip(records._fields, records, strict=True):
        if isinstance(record, TouchRecord) and record.part > 0.5:
            x, y, z = map(float, record.place)
            part = _part(kind, int(record.part) - 1)
            force, impulse = float(record.force), float(record.impulse)
            found.append(TouchReport(part, surface, float(record.time), (x, y, z), force, impulse))
    return found


def _part(kind: str, index: int) -> str:
    """The name of a part, from its kind and its number from 0."""
    if kind == "beam":
        return "beam"
    return (
        f"guard of quadrotor {index + 1}"
        if kind == "guards"
        else f"rotor {index % 4 + 1} of quadrotor {index // 4 + 1}"
    )
