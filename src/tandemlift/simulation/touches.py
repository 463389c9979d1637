"""What a flight touched: the record of touches of its last state, in words and numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra.vector import Absent
from tandemlift.parts.contact.touches import SurfaceTouches, Touches, TouchRecord
from tandemlift.simulation.loop.step import FlightState


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
    """What a flight touched up to this state, in the order of time; nothing where there is nothing to touch.

    Feet on the floor are no touch. Floor and walls have up to one report each for rotors, guards and beam.
    """
    touches: Any = flight_state.touches
    if not isinstance(touches, Touches):
        return []
    found = [*_of_surface(touches.floor, "floor"), *_of_surface(touches.walls, "wall")]
    return sorted(found, key=lambda report: report.time)


def struck_rotors(flight_state: FlightState) -> list[tuple[int, int]]:
    """The rotors that have stopped at a touch: numbers of quadrotor and rotor, from 1."""
    touches: Any = flight_state.touches
    if not isinstance(touches, Touches):
        return []
    return [(i // 4 + 1, i % 4 + 1) for i, turning in enumerate(touches.turning) if not turning > 0.5]


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
