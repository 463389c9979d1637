"""The reaction to a contact: the reference moves away from the wall by a gap, and may move along it but not into it.

At the touch, the plane through the vehicle's centre of mass, normal to the wall's normal, becomes a boundary. While the
contact lasts, and for a time after it, the reference stays on its outer side: velocity and acceleration into the wall
are zero, and motion along the wall is unchanged. The reference then slowly moves away until a gap is reached. The
disturbance observer does not adapt to a wall, and the force of a wall on the beam is no push.

A timer counts up in contact and down without; it leads to a landing.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, maximum, minimum, sqrt, where
from tandemlift.core.law import choice, law
from tandemlift.core.part import Part
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3, apply_transposed, cross, dot
from tandemlift.parts.estimation.contact_detection import NO_CONTACT, ContactEstimate, ContactTable
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.guidance.compliance import ComplianceState, moved_towards, within
from tandemlift.parts.guidance.guidance import LoadOfWall, PilotInput
from tandemlift.parts.guidance.phases import PhaseBounds
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

LEAVING_SPEED = 0.1  # m/s, of the reference towards the gap
LEAD = 0.25  # m, largest lead of the reference along a wall, whose friction holds the vehicle back
SAME_WALL = 0.7  # least cosine between the normals of two touches of one wall
BEAM = 65.0  # number of the beam in the code of a contact: after that of the last possible quadrotor
DIAGONAL = 0.38268  # sin 22.5°: above it, a direction has a component along an axis
DIRECTIONS, PLACES, HALF_PLACES = 9.0, 8192.0, 4096.0  # in the code of a contact
HAND_RATE = 40.0  # N/s and N m/s: the fastest change of a push while a contact is near
TINY = 1e-12  # m²
ROUNDING = 6755399441055744.0  # 1.5 · 2^52: adding and subtracting it rounds to a whole number


class ContactReaction(NamedTuple):
    """The parameters: the `gap` to a wall [m]; times [s] after which a contact is over, and leads to a landing.

    `whole`: `InPush` where the push has the force of a wall on any part in it, not only of that on the beam.
    """

    gap: Number
    recovery_time: Number
    hold_timeout: Number
    whole: InPush | Absent = Absent()


class InPush(NamedTuple):
    """An observed push has the force of any wall in it."""


class HandWrench(NamedTuple):
    """A push: force [N, world axes] and moment about the system's centre of mass [N·m, body axes]."""

    force: Vec3
    moment: Vec3


class ContactReactionState(NamedTuple):
    """Memory: 1 while the boundary holds; the part that touched; the contact's code; the push as used at last.

    The boundary's `normal`, its place along that (`level` [m]), and its `lever` [m]: distance by which the part that
    touched leaves the wall per yaw angle. `free_time` [s]: since the last touch. `held_time` [s]: in contact, less the
    time without.
    """

    holding: Number
    normal: Vec3
    level: Number
    lever: Number
    part: Number
    free_time: Number
    held_time: Number
    code: Number
    push: HandWrench


class Boundary(NamedTuple):
    """The bounds of the guidance by a contact.

    `push`: the person's, without that of a wall; `on`: 1 while the boundary holds. Its `normal`, its place along
    that (`level`) and the least one of the reference [m], its `lever` (see `ContactReactionState`); the vehicle's
    `position` [m]; the load of the `wall`; 1 to `land`; the contact's `code`, for events; 1 while the beam touches.
    """

    push: HandWrench
    on: Number
    normal: Vec3
    level: Number
    least: Number
    lever: Number
    position: Vec3
    wall: LoadOfWall
    land: Number
    code: Number
    on_beam: Number


@choice(absent=NO_CONTACT)
def contact_of(sensed: object) -> ContactEstimate:
    """`ContactEstimate` from readings and estimates."""


@law
def side_of(x: Number) -> Number:
    """0, 1 or 2 for a component of a direction along −, neither, or +."""
    return where(x > DIAGONAL, 2.0, where(x < -DIAGONAL, 0.0, 1.0))


@law
def code_of(part: Number, normal: Vec3, along: Number) -> Number:
    """Part, direction of the wall and place on the beam [cm] in a whole number; `simulation.touches` reads it."""
    counted = where(part < 0.0, BEAM, part)
    direction = side_of(-normal.x) * 3.0 + side_of(-normal.y)
    place = maximum(minimum(along * 100.0, 4000.0), -4000.0) + HALF_PLACES
    return (counted * DIRECTIONS + direction) * PLACES + ((place + ROUNDING) - ROUNDING)


@law(absent="c")
def as_felt(whole: InPush, c: ContactEstimate) -> ContactEstimate:
    """The contact as if of the beam, whose force is in the push."""
    return c._replace(part=where(c.part == 0.0, 0.0, -1.0))


@law(absent=("k", "m"))
def react_to_contact(
    k: ContactReaction, m: ContactReactionState, pilot_input: PilotInput, aloft: Number, dt: Number
) -> tuple[Boundary, ContactReactionState]:
    """(`Boundary`, the new memory) at a sample; `aloft` is 1 in flight, except in lift and landing."""
    c, state = contact_of(pilot_input.sensed), pilot_input.state
    touching = where(c.part == 0.0, 0.0, aloft)
    begins = touching * where(dot(c.normal, m.normal) * m.holding > SAME_WALL, 0.0, 1.0)
    normal = chosen(begins, c.normal, m.normal)
    here = dot(normal, state.position)
    level = where(begins > 0.0, here, where(touching > 0.0, maximum(m.level, here), m.level))
    free_time = (m.free_time + dt) * (1.0 - touching)
    holding = maximum(touching, where(free_time < k.recovery_time, m.holding, 0.0)) * aloft
    # it counts down, too, so that a vehicle that bounces on a wall lands as one that stays there
    held_time = where(holding > 0.0, m.held_time + dt, maximum(m.held_time - dt, 0.0))
    other = begins * where(c.part == m.part, 1.0 - m.holding, 1.0)
    code = where(other > 0.0, code_of(c.part, c.normal, c.along), m.code) * holding
    arm = c.point - state.position
    lever = where(begins > 0.0, c.normal.y * arm.x - c.normal.x * arm.y, m.lever)
    part = where(touching > 0.0, c.part, m.part)
    land = where(held_time > k.hold_timeout, 1.0, 0.0)
    push = slower(m.push, pilot_input.push, pilot_input.moment, dt)
    felt = as_felt(k.whole, c)
    on_beam = where(felt.part < 0.0, touching, 0.0)
    boundary = Boundary(
        push, holding, normal, level, level + k.gap, lever, state.position, load_at(felt, state), land, code, on_beam
    )
    return boundary, ContactReactionState(holding, normal, level, lever, part, free_time, held_time, code, push)


@within.register(Boundary)
def outward(b: Boundary, v: Vec3) -> Vec3:
    """A vector without its part into the wall."""
    return v - b.normal * (minimum(dot(b.normal, v), 0.0) * b.on)


@law(absent="m")
def kept_out(b: Boundary, m: ComplianceState, dt: Number) -> ComplianceState:
    """The reference on the outer side of a boundary."""
    place = dot(b.normal, m.position)
    least = minimum(b.least, maximum(place, b.level) + LEAVING_SPEED * dt)
    inside = maximum(least - place, 0.0) * b.on
    ahead = m.position - b.position
    along = Vec3(ahead.x, ahead.y, 0.0) - b.normal * dot(b.normal, ahead)
    size = sqrt(maximum(dot(along, along), TINY))
    excess = maximum(size - LEAD, 0.0) * b.on / size
    return m._replace(
        position=m.position + b.normal * inside - along * excess,
        velocity=outward(b, m.velocity),
        acceleration=outward(b, m.acceleration),
    )


@law(absent="moment")
def turning_out(b: Boundary, moment: Number) -> Number:
    """The moment about the vertical that may rotate the vehicle [N·m]: none that rotates the part into the wall."""
    return where(b.on * b.lever * moment < 0.0, 0.0, moment)


@law
def slower(m: HandWrench, force: Vec3, moment: Vec3, dt: Number) -> HandWrench:
    """A push that follows the measured one only as fast as a hand changes it, to exclude impacts on a wall."""
    step = HAND_RATE * dt
    return HandWrench(moved_towards(m.force, force, step), moved_towards(m.moment, moment, step))


@law(absent="pilot_input")
def without_wall(b: Boundary, pilot_input: PilotInput) -> PilotInput:
    """The pilot's input without the wall's part of the push; while the beam touches, without any part out of it."""
    force = b.push.force - b.normal * (maximum(dot(b.normal, b.push.force), 0.0) * b.on_beam)
    return pilot_input._replace(
        push=chosen(b.on, force, pilot_input.push), moment=chosen(b.on, b.push.moment, pilot_input.moment)
    )


@law(absent="bounds")
def bounded_by(b: Boundary, bounds: PhaseBounds) -> PhaseBounds:
    """The bounds of the phases, with those of a contact."""
    return bounds._replace(land=maximum(bounds.land, b.land), contact=b.on)


@law(absent=Absent())
def load_of_wall(b: Boundary) -> LoadOfWall:
    """The load of the wall on a guard that touches; that on the beam is a part of the measured push already."""
    return b.wall


@law
def load_at(c: ContactEstimate, state: State) -> LoadOfWall:
    """The load of the wall as estimated."""
    force = c.force * where(c.part > 0.0, 1.0, 0.0)
    moment = apply_transposed(rotation_from_quaternion(state.attitude), cross(c.point - state.position, force))
    return LoadOfWall(force, moment, where(c.part == 0.0, 0.0, 1.0))


@law(absent=0.0)
def contact_code(b: Boundary) -> Number:
    """The code of the contact that holds, or 0."""
    return b.code


def start_reaction() -> ContactReactionState:
    """The memory before the first step."""
    return ContactReactionState(0.0, ZERO, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, HandWrench(ZERO, ZERO))


def start_contact_hold(table: ContactTable, estimator: EstimatorTable) -> tuple[ContactReaction, ContactReactionState]:
    """The reaction to contacts before the first sample, and its memory."""
    whole = Absent() if estimator.wrench == "joints" else InPush()
    return ContactReaction(table.gap, table.recovery_time, table.hold_timeout, whole), start_reaction()


CONTACT_HOLD = Part("contact", "guidance", "contact", ContactTable.acts, start_contact_hold)
