"""Contact with a wall: the part of the vehicle that touches, and place, direction and force of the contact.

`contact_evidence` gives the evidence for each part. A contact is reported after 15 ms of evidence, so that the first
impact has identified the part. While a part touches, the slow means are held, so the force of a long contact is known.
The contact ends once there is no force for a time, or once the part has moved away from the place.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from tandemlift.core.algebra import chosen, maximum, sqrt, where
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.law import law
from tandemlift.core.low_pass import low_pass
from tandemlift.core.part import Part
from tandemlift.core.types import Number, PerQuadrotor, number
from tandemlift.core.vector import ZERO, Absent, Vec3, apply, dot, each, spread, vec3
from tandemlift.parts.contact.walls import NearWalls
from tandemlift.parts.estimation.contact_evidence import (
    ContactDetector,
    Deviations,
    EvidenceState,
    PushReading,
    by_line_of_action,
    heard,
    square_of,
    start_evidence,
    touching_part,
    with_means_of_now,
)
from tandemlift.parts.estimation.contact_map import (
    BeamMatch,
    GuardMatch,
    TouchGeometry,
    beam_of,
    guards_matched,
    picked,
)
from tandemlift.parts.estimation.push_estimate import PushEstimate, PushEstimator
from tandemlift.parts.estimation.tare import SideForces
from tandemlift.parts.estimation.wrench.observation import WholeForce
from tandemlift.parts.mechanics.rigid_body import State, inertia_value
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.sensors_table import SensorsTable

DECISION_TIME = 0.015  # s of evidence, after which the part is reported
RELEASE = 0.5  # of the threshold: below it, there is no contact
QUIET_TIME = 0.1  # s without force, after which a contact is over
AWAY = 0.04  # m by which a part has moved away from a wall when the contact is over
EXPLAINED_TIME = 0.5  # s after a contact, in which joints that disagree are explained by it
FEET_HEIGHT = 0.2  # m above the ground: feet do not touch it in a landing
TINY = 1e-12  # N²
RESIDUAL_BANDWIDTH = 80.0  # rad/s: shows half of a sudden force in 12 ms, and 0.05 N of the noise of mission iris
MEAN_BANDWIDTH = 8.0  # rad/s, of the slow means: pushes and gusts change more slowly than a contact
MARGIN = 0.06  # m: 30 ms at 1 m/s until a contact is detected, and an error of the position


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


class ContactEstimate(NamedTuple):
    """A contact as estimated.

    `part`: 0 for none, else the number of the quadrotor whose guard touches, or −1 for the beam. `force` [N, world
    axes, horizontal] of the wall; `point` [m, world axes] where it began to act; `along` [m, body y]: how far that is
    from the payload's centre; `normal`: unit vector out of the wall, world axes; `rise` [s]: time in which the force
    has risen; `on_map`: 1 if the pilot's map has a wall there, else 0.
    """

    part: Number
    force: Vec3
    point: Vec3
    along: Number
    normal: Vec3
    rise: Number
    on_map: Number


NO_CONTACT = ContactEstimate(0.0, ZERO, ZERO, 0.0, ZERO, 0.0, 0.0)


class ContactState(NamedTuple):
    """Memory: the evidence; the contact; times [s].

    `seen_time`: time with evidence of a contact that begins; `quiet_time`: time for which a contact is
    without force; `over_time`: since the last one.
    """

    evidence: EvidenceState
    contact: ContactEstimate
    seen_time: Number
    quiet_time: Number
    over_time: Number


class KnownSurroundings(NamedTuple):
    """The pilot's knowledge of its surroundings.

    `walls`: the known ones near it, or `Absent`; 1 in flight, except in lift and landing; 1 in a landing; the height
    of the `ground` [m].
    """

    walls: NearWalls | Absent
    aloft: Number
    landing: Number
    ground: Number


@law
def world_forces(s: State, f: SideForces[PerQuadrotor]) -> Vec3:
    """Horizontal forces of sets [N] in world axes."""
    return apply(rotation_from_quaternion(s.attitude), Vec3(f.x, f.y, f.x * 0.0))


@law
def in_world(s: State, x: Number, y: Number) -> Vec3:
    """A horizontal force [N] in world axes, from its parts along body x and y."""
    return apply(rotation_from_quaternion(s.attitude), Vec3(x, y, 0.0))


@law
def rise_time(f: SideForces[Number], slope: SideForces[Number]) -> Number:
    """A force [N] over its slope [N/s], in s."""
    return sqrt(square_of(f) / maximum(square_of(slope), TINY))


@law
def horizontal(f: Vec3) -> Vec3:
    """The direction of a vector in the horizontal plane, a unit vector, or zero for none."""
    size = sqrt(maximum(f.x * f.x + f.y * f.y, TINY))
    return Vec3(f.x / size, f.y / size, 0.0)


@law
def of_part(k: ContactDetector, part: Number, beam: Number, guards: PerQuadrotor) -> Number:
    """The value of a part: that of the beam, or in a set with one for each guard, that of the guard."""
    return where(part < 0.0, beam, picked(k.numbers, part, guards))


@law
def force_on(k: ContactDetector, d: Deviations, part: Number, s: State) -> Vec3:
    """The force on a part [N, world axes]."""
    x, y = of_part(k, part, d.push.x, d.lasting.x), of_part(k, part, d.push.y, d.lasting.y)
    return in_world(s, x, y)


@law
def axis_of(k: ContactDetector, part: Number, along: Number, s: State) -> Vec3:
    """The centre of a guard, or the point `along` the beam's axis [m], in world axes [m]."""
    g = k.geometry
    guard = Vec3(*[picked(k.numbers, part, centres) for centres in g.quadrotors])
    beam = where(part < 0.0, 1.0, 0.0)
    center = chosen(beam, g.payload + Vec3(0.0, along, 0.0), guard)
    return s.position + apply(rotation_from_quaternion(s.attitude), center)


@law
def radius_of(k: ContactDetector, part: Number) -> Number:
    """The radius of a part [m]."""
    return of_part(k, part, k.geometry.radius, k.geometry.guards)


@law
def begun(
    k: ContactDetector,
    m: EvidenceState,
    d: Deviations,
    part: Number,
    guards: GuardMatch,
    beam: BeamMatch,
    s: State,
    y: Number,
) -> ContactEstimate:
    """The contact of a part that begins now; `y`: estimated place of the push on the beam [m]."""
    g, number = k.geometry, k.numbers
    on_beam = where(part < 0.0, 1.0, 0.0)
    of_guard = SideForces(picked(number, part, d.lasting.x), picked(number, part, d.lasting.y))
    slope = SideForces(picked(number, part, m.outside.x.rate), picked(number, part, m.outside.y.rate))
    of_push = rise_time(d.push, SideForces(m.push.x.rate, m.push.y.rate))
    mapped = of_part(k, part, beam.matched, guards.matched)
    off = Vec3(picked(number, part, guards.offset.x), picked(number, part, guards.offset.y), 0.0)
    force = force_on(k, d, part, s)
    normal = horizontal(chosen(mapped, chosen(on_beam, beam.offset, off), force))
    along = where(
        part < 0.0, where(beam.matched > 0.0, beam.along, y), picked(number, part, g.quadrotors.y) - g.payload.y
    )
    rise = where(part < 0.0, of_push, rise_time(of_guard, slope))
    axis, radius = axis_of(k, part, along, s), radius_of(k, part)
    return ContactEstimate(part, force, axis - normal * radius, along, normal, rise, mapped)


@law
def is_over(k: ContactDetector, c: ContactEstimate, quiet_time: Number, s: State) -> Number:
    """1 once a contact has been without force for long enough [s], or its part has moved away from the wall; else 0."""
    moved = dot(c.normal, axis_of(k, c.part, c.along, s) - c.point) - radius_of(k, c.part)
    return maximum(where(quiet_time > QUIET_TIME, 1.0, 0.0), where(moved > AWAY, 1.0, 0.0))


@law(absent=0.0)
def shaken(m: ContactState) -> Number:
    """1 in a contact, shortly after it, and while evidence of one begins, else 0; `m`: memory of the detection.

    Joints may disagree then, and readings of different times differ.
    """
    return where(m.over_time < EXPLAINED_TIME, 1.0, where(m.seen_time > 0.0, 1.0, 0.0))


@law(absent=("k", "m"))
def contact_step(
    k: ContactDetector,
    m: ContactState,
    e: PushEstimator,
    x: PushReading,
    s: State,
    surroundings: KnownSurroundings,
    dt: Number,
) -> tuple[ContactEstimate, ContactState]:
    """(`ContactEstimate`, the new memory) at a sample: `x` the reading of an estimator `e`, `s` the state."""
    before = m.contact
    # the slow means are held in a contact, whose force would become their mean otherwise
    evidence, d = heard(k, m.evidence, e, x, where(before.part == 0.0, 0.0, 1.0), dt)
    guards = guards_matched(surroundings.walls, k.geometry, s, world_forces(s, d.lasting))
    beam = beam_of(surroundings.walls, k.geometry, s, in_world(s, d.push.x, d.push.y))
    aloft = maximum(
        surroundings.aloft, where(s.position.z > surroundings.ground + FEET_HEIGHT, surroundings.landing, 0.0)
    )
    free = where(before.part == 0.0, aloft * x.push.armed, 0.0)
    told = touching_part(k, evidence, d, guards, beam, maximum(x.push.trusted, shaken(m)))
    part, y = by_line_of_action(k.whole, told, x.push.point, k, evidence, (guards, beam))
    part = part * free
    seen_time = (m.seen_time + dt) * where(part == 0.0, 0.0, 1.0)
    begins = where(seen_time > DECISION_TIME, 1.0, 0.0)
    now = chosen(begins, begun(k, evidence, d, part, guards, beam, s, y), before)
    now = now._replace(force=force_on(k, d, now.part, s))
    least = (RELEASE * k.threshold) * (RELEASE * k.threshold)
    quiet_time = (m.quiet_time + dt) * where(dot(now.force, now.force) < least, 1.0, 0.0)
    touches = where(now.part == 0.0, 0.0, aloft) * (1.0 - is_over(k, now, quiet_time, s))
    after = chosen(touches, now, NO_CONTACT)
    return after, ContactState(
        evidence=with_means_of_now(evidence, where(before.part == 0.0, 0.0, 1.0 - touches)),
        contact=after,
        seen_time=seen_time * (1.0 - touches),
        quiet_time=quiet_time * touches,
        over_time=where(touches > 0.0, 0.0, m.over_time + dt),
    )


@law(absent="push")
def explained_push(m: ContactState, push: PushEstimate) -> PushEstimate:
    """The push, trusted although joints disagree while a contact explains it; `m`: memory of the detection."""
    trusted = maximum(push.trusted, shaken(m))
    return push._replace(trusted=trusted, usable=push.force * (trusted * push.armed))


class ContactEstimateChannels(NamedTuple):
    """The contact as estimated; `ContactEstimate` describes it."""

    contact_part: Number
    contact_force_estimate: Vec3
    contact_point_estimate: Vec3
    contact_along_beam: Number
    contact_normal: Vec3
    contact_rise_time: Number
    contact_on_map: Number


@law(absent="contact")
def contact_channels(contact: ContactEstimate) -> ContactEstimateChannels:
    """The channels of an estimated contact."""
    return ContactEstimateChannels(
        contact_part=contact.part,
        contact_force_estimate=contact.force,
        contact_point_estimate=contact.point,
        contact_along_beam=contact.along,
        contact_normal=contact.normal,
        contact_rise_time=contact.rise,
        contact_on_map=contact.on_map,
    )


def start_contact_detection(
    table: ContactTable, vehicle: Vehicle, interval: float, *, joints: bool
) -> tuple[ContactDetector, ContactState]:
    """The detector of contacts, by joint sensors or motion, for the nominal vehicle, and its memory."""
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
        fast=low_pass(RESIDUAL_BANDWIDTH, interval),
        slow_rate=MEAN_BANDWIDTH,
        threshold=table.threshold,
        mass=vehicle.mass,
        geometry=geometry,
        numbers=each(N)(*[float(i + 1) for i in range(N)]),
        whole=Absent() if joints else whole,
    )
    return detector, ContactState(start_evidence(detector), NO_CONTACT, 0.0, 0.0, 1.0 + EXPLAINED_TIME)


def contact_checks(table: ContactTable, guidance: str, sensors: SensorsTable, push: str) -> Iterator[CheckResult]:
    """Check for a detection without interactive guidance or joints; `push`: `pilot.push`."""
    if table.model == "none":
        return
    if guidance != "interactive":
        yield refused('contact.model = "on": must be "none" where pilot.guidance is "scheduled"')
    if sensors.model == "none" or push == "truth":
        yield refused('contact.model = "on": must be "none" where the pilot reads no joints (pilot.push = "truth")')


CONTACT = Part(
    *("contact", "estimators", "contact", ContactTable.acts, start_contact_detection),
    refusals=contact_checks,
    channels=ContactEstimateChannels,
)
