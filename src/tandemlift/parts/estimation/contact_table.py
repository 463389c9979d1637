"""Contact detection, `[contact]`: its keys and its start."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.low_pass import low_pass
from tandemlift.core.types import number
from tandemlift.core.vector import Absent, each, spread, vec3
from tandemlift.parts.estimation.contact_detection import ContactState, start_contact
from tandemlift.parts.estimation.contact_evidence import ContactDetector
from tandemlift.parts.estimation.contact_map import TouchGeometry
from tandemlift.parts.estimation.wrench.observation import WholeForce
from tandemlift.parts.mechanics.rigid_body import inertia_value
from tandemlift.parts.mechanics.vehicle import Vehicle


class ContactTable(Table, acts='contact.model = "on"'):
    """`[contact]`: distinction of contact with a wall from a push and from a faulty sensor, and the reaction to it.

    It needs `pilot.guidance = "interactive"`, `pilot.push` other than "truth", and rotors that push along body z alone,
    as all do here. See docs/explanation/safety.md.
    """

    model: Literal["none", "on"] = key(
        "none",
        None,
        "detection of contacts",
        choices={
            "none": "none: a guard that touches a wall looks like joints that disagree",
            "on": "contacts are reported, and the reference is kept outside the wall (needs sensors)",
        },
    )
    threshold: Positive = key(
        1.0,
        "N",
        "smallest sudden force on a part that may be a contact",
        source="chosen: twenty times its noise with the sensors of mission iris",
    )
    gap: NonNegative = key(0.06, "m", "distance by which the reference moves away from the wall", source="chosen")
    recovery_time: NonNegative = key(
        1.0, "s", "time after a contact for which the reference still does not cross its place", source="chosen"
    )
    hold_timeout: Positive = key(
        10.0, "s", "time in contact, less time without, after which the vehicle lands", source="chosen"
    )


FAST = 80.0  # rad/s: 12 ms until half of a sudden force is seen; keeps 0.05 N of the noise of mission iris's sensors
SLOW = 8.0  # rad/s, of the slow means: pushes and gusts change more slowly than a contact
MARGIN = 0.06  # m: 30 ms at 1 m/s until a contact is detected, and an error of the position


def start_contact_detection(
    table: ContactTable, vehicle: Vehicle, step: float, *, joints: bool
) -> tuple[ContactDetector, ContactState] | tuple[Absent, Absent]:
    """The detector of contacts, by joint sensors or motion, for the nominal vehicle, and its memory; or `Absent`."""
    if table.model == "none":
        return Absent(), Absent()
    payload, N = vehicle.payload, vehicle.count
    geometry = TouchGeometry(
        quadrotors=spread(vehicle.lever_arms),
        guards=each(N)(*[number(q.guard_radius) for q in vehicle.quadrotors]),
        payload=vec3(vehicle.origin),
        half=0.0 if payload.span is None else 0.5 * payload.span,
        radius=0.0 if payload.radius is None else payload.radius,
        corners=spread([c for h in payload.hulls for c in vehicle.origin + h.corners]) if payload.hulls else Absent(),
        margin=MARGIN,
    )
    whole = WholeForce(vehicle.mass, inertia_value(vehicle.inertia), -vec3(vehicle.payload_center))
    detector = ContactDetector(
        fast=low_pass(FAST, step),
        slow_rate=SLOW,
        threshold=table.threshold,
        mass=vehicle.mass,
        geometry=geometry,
        numbers=each(N)(*[float(i + 1) for i in range(N)]),
        whole=Absent() if joints else whole,
    )
    return detector, start_contact(detector)


def contact_checks(table: ContactTable, guidance: str, sensors: str, push: str) -> Iterator[CheckResult]:
    """Check for a detection without interactive guidance or joints; `pilot.guidance`, `sensors.model`, `pilot.push`."""
    if table.model == "none":
        return
    if guidance != "interactive":
        yield refused('contact.model = "on": must be "none" where pilot.guidance is "scheduled"')
    if sensors == "none" or push == "truth":
        yield refused('contact.model = "on": must be "none" where the pilot reads no joints (pilot.push = "truth")')
