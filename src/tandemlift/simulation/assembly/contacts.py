"""The detector of contacts of a mission's pilot."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra.types import number
from tandemlift.core.algebra.vector import Nothing, each, spread, vec3
from tandemlift.core.settings import Mission
from tandemlift.parts.estimation.contact_detection import start_contact
from tandemlift.parts.estimation.contact_evidence import ContactDetector
from tandemlift.parts.estimation.contact_map import TouchGeometry
from tandemlift.parts.signals.low_pass import low_pass
from tandemlift.parts.vehicle import Vehicle

FAST = 80.0  # rad/s: 12 ms until half of a sudden force is seen; keeps 0.05 N of the noise of mission iris's sensors
SLOW = 8.0  # rad/s, of the slow means: a hand and gusts change more slowly than a contact
MARGIN = 0.06  # m: 30 ms at 1 m/s until a contact is seen, and an error of the position


def start_contacts(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    """The detector of contacts and its memory before the first step, for the nominal vehicle; or `Nothing`."""
    if mission.contact.model == "none":
        return Nothing(), Nothing()
    payload, N = vehicle.payload, vehicle.count
    geometry = TouchGeometry(
        quadrotors=spread(vehicle.lever_arms),
        guards=each(N)(*[number(q.guard_radius) for q in vehicle.quadrotors]),
        payload=vec3(-vehicle.center_of_mass),
        half=0.0 if payload.length is None else 0.5 * payload.length,
        radius=0.0 if payload.radius is None else payload.radius,
        margin=MARGIN,
    )
    detector = ContactDetector(
        fast=low_pass(FAST, mission.mission.step),
        slow_rate=SLOW,
        threshold=mission.contact.threshold,
        mass=vehicle.mass,
        geometry=geometry,
        numbers=each(N)(*[float(i + 1) for i in range(N)]),
    )
    return detector, start_contact(detector)
