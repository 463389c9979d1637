"""Contacts in words: their codes in events, read, and formed from the channels of a flight."""

from __future__ import annotations

from tandemlift.core.algebra.vector import ZERO, Vec3
from tandemlift.flight.record import Flight
from tandemlift.parts.estimation.contact_detection import ContactEstimate
from tandemlift.parts.guidance.contact_hold import BEAM, DIRECTIONS, HALF_PLACES, PLACES, code_of

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
    contacts = [ContactEstimate(p, ZERO, ZERO, a, Vec3(*map(float, n)), 0.0, 0.0) for p, a, n in columns]
    return [int(code_of(c)) if c.part else 0 for c in contacts]
