"""Compliance to a person's push: from the measured push to a trajectory that the vehicle can follow.

measured push → low-pass → less of what alternates → less its bias → soft dead-band with hysteresis and dwell →
low-pass → admittance → limits

Per world axis, M a + C v + K (p − p_d) = F with F the push beyond the threshold. Both low-passes are of second order,
so the rate of the acceleration is known too, and the reference can lead by the response time of the vehicle. Speed,
acceleration and jerk are bounded, also by the thrust that is left; every start and stop is smooth. While nobody pushes,
a slow mean of the measured push becomes its bias.

Passivity: `parts.guidance.energy_tank`. Yaw: `parts.guidance.yaw_compliance`.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, clip, maximum, minimum, sqrt
from tandemlift.core.keys import TRIAL, Bandwidth, Delay, Fraction, NonNegative, Positive, Positive3, Table, Tilt, key
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.part import Started
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3
from tandemlift.parts.guidance.admittance import (
    Admittance,
    AdmittanceState,
    AdmittanceTable,
    admittance_from,
    admittance_response,
    anchored,
)
from tandemlift.parts.guidance.alternation import Alternation, AlternationState, alternation_step, calmed
from tandemlift.parts.guidance.dead_band import DeadBand, DeadBandState, PushFilters, dead_band
from tandemlift.parts.guidance.energy_tank import TankTable
from tandemlift.parts.guidance.following import FollowingTable
from tandemlift.parts.guidance.policy import Policy, PolicyTable, with_policy
from tandemlift.parts.guidance.requests import ReferenceVelocity
from tandemlift.parts.guidance.yaw_compliance import YawTable
from tandemlift.parts.mechanics.vehicle import Vehicle


class MotionLimits(NamedTuple):
    """Largest speed along and against each axis [m/s], acceleration [m/s²], jerk [m/s³]; gain of the braking [1/s]."""

    speed: Vec3
    speed_back: Vec3
    acceleration: Vec3
    jerk: Vec3
    braking_gain: Number


class AssumedPayload(NamedTuple):
    """The payload of the pilot's model: what is identified beyond its `mass` [kg] is accelerated, too."""

    mass: Number


class Compliance(NamedTuple):
    """Low-pass of the push, dead-band, low-pass after it, M, C, K and T_d, limits.

    `force_lead` [s]: lead time of the push that the controller compensates. `reference_lead` [s]: lead time of the
    reference's acceleration; each one number, or one for each axis. `payload`: the assumed one, or `Absent`.
    `policy`: of the damping, or `Absent`.
    """

    input_filter: LowPass
    band: DeadBand[Vec3]
    output_filter: LowPass
    admittance: Admittance
    limits: MotionLimits
    force_lead: Number | Vec3
    reference_lead: Number | Vec3
    payload: AssumedPayload | Absent
    policy: Policy | Absent
    alternation: Alternation


class ComplianceState(NamedTuple):
    """Memory: the push [N] after the first low-pass, as it is and as it is followed; the dead-band's; the force [N]
    after the second low-pass; T_r, and T_d.
    """

    measured: LowPassState[Vec3]
    alternation: AlternationState
    filtered: LowPassState[Vec3]
    band: DeadBandState[Vec3]
    output: LowPassState[Vec3]
    position: Vec3
    velocity: Vec3
    acceleration: Vec3
    jerk: Vec3
    anchor: Vec3


@elementwise
def speed_limited(acceleration: Number, velocity: Number, speed: Number, speed_back: Number, gain: Number) -> Number:
    """An acceleration that keeps the speed within its limit in each direction, by braking towards it."""
    return clip(acceleration, -gain * (speed_back + velocity), gain * (speed - velocity))


@elementwise
def moved_towards(value: Number, target: Number, step: Number) -> Number:
    """A value moved towards its target by at most a step."""
    return value + clip(target - value, -step, step)


@law
def with_horizontal_limit(a: Vec3, limit: Number) -> Vec3:
    """An acceleration whose horizontal part is at most `limit` [m/s²]."""
    size = sqrt(maximum(a.x * a.x + a.y * a.y, 1e-24))
    factor = minimum(limit / size, 1.0)
    return Vec3(a.x * factor, a.y * factor, a.z)


@law
def limited_response(k: Compliance, m: ComplianceState, force: Vec3, damping: Number) -> Vec3:
    """The admittance's response [m/s²] to a force beyond the threshold, within the limit along each axis."""
    a = k.admittance
    damped = a._replace(damping=a.damping + Vec3(damping, damping, damping))
    response = admittance_response(damped, AdmittanceState(m.position, m.velocity, m.anchor), force)
    return clip(response.acceleration, -k.limits.acceleration, k.limits.acceleration)


@law(absent="response")
def led_by(lead: ReferenceVelocity, k: MotionLimits, velocity: Vec3, enabled: Number, response: Vec3) -> Vec3:
    """The acceleration [m/s²] towards a velocity that a caller gives while pushes may be followed, or the response."""
    towards = clip((lead.velocity - velocity) * k.braking_gain, -k.acceleration, k.acceleration)
    return chosen(lead.given * enabled, towards, response)


@choice(absent="acceleration")
def within(boundary: object, acceleration: Vec3) -> Vec3:
    """An acceleration of the reference [m/s²] that keeps it within a boundary."""


@law
def compliance_step(
    k: Compliance,
    m: ComplianceState,
    push: Vec3,
    enabled: Number,
    damping: Number,
    horizontal: Number,
    boundary: object,
    dt: Number,
    lead: ReferenceVelocity | Absent,
    eased: Vec3 | Absent,
) -> ComplianceState:
    """The memory after a step.

    Args:
        k: the compliance.
        m: its memory.
        push: as measured [N, world axes].
        enabled: 1 while the vehicle follows pushes, else 0.
        damping: to be added to C [N·s/m].
        horizontal: the largest horizontal acceleration that the rotors can still give [m/s²].
        boundary: which the reference must not cross, or `Absent`.
        dt: of the step [s].
        lead: a velocity of the reference in place of the response to the push, or `Absent`.
        eased: the force by which a policy changes the damping [N, world axes], or `Absent`.
    """
    measured = low_pass_step(k.input_filter, m.measured, push)
    holds = k.admittance.damping * m.velocity
    alternation = alternation_step(k.alternation, m.alternation, measured, holds, dt)
    filtered = calmed(k.alternation, alternation, measured)
    beyond, band = dead_band(k.band, m.band, filtered.value, enabled, dt)
    output = low_pass_step(k.output_filter, m.output, beyond)
    response = limited_response(k, m, with_policy(eased, output.value), damping)
    free = led_by(lead, k.limits, m.velocity, enabled, response)
    bounded = speed_limited(free, m.velocity, k.limits.speed, k.limits.speed_back, k.limits.braking_gain)
    target = within(boundary, with_horizontal_limit(bounded, horizontal))
    # the jerk is limited last, so that no other limit makes the acceleration jump
    acceleration = moved_towards(m.acceleration, target, k.limits.jerk * dt)
    position = m.position + m.velocity * dt + acceleration * (0.5 * dt * dt)
    velocity = m.velocity + acceleration * dt
    return ComplianceState(
        measured=measured,
        alternation=alternation,
        filtered=filtered,
        band=band,
        output=output,
        position=position,
        velocity=velocity,
        acceleration=acceleration,
        jerk=(acceleration - m.acceleration) * (1.0 / dt),
        anchor=anchored(m.anchor, position, velocity, output.value, k.admittance.hold_after_release),
    )


@law
def with_speed(k: Compliance, speed: Vec3, speed_back: Vec3) -> Compliance:
    """A compliance with other largest speeds along and against each axis [m/s]."""
    return k._replace(limits=k.limits._replace(speed=speed, speed_back=speed_back))


@law
def compensated_push(k: Compliance, m: ComplianceState) -> Vec3:
    """The push that the controller compensates [N, world axes]: the filtered one, by its lead time ahead."""
    return m.filtered.value + m.filtered.rate * k.force_lead


def start_compliance(position: Vec3, alternation: AlternationState) -> ComplianceState:
    """The memory before the first sample, without a push, at a position [m]; `alternation`: that of the push."""
    no_push = LowPassState(ZERO, ZERO)
    return ComplianceState(
        measured=no_push,
        alternation=alternation,
        filtered=no_push,
        band=DeadBandState(active=ZERO, above_time=ZERO, inactive_time=ZERO, mean=ZERO, bias=ZERO),
        output=no_push,
        position=position,
        velocity=ZERO,
        acceleration=ZERO,
        jerk=ZERO,
        anchor=position,
    )


# ---- The table, and the start


class ComplianceTable(Table, acts='pilot.guidance = "interactive"'):
    """`[compliance]`: interactive guidance, around mass, damping, stiffness and threshold of `[admittance]`.

    It applies where `pilot.guidance = "interactive"`: measured push → low-pass → dead band → low-pass → admittance →
    limits.
    Accelerations are limited as well by the thrust that weight and disturbance leave to the rotors.
    """

    input_bandwidth: Bandwidth = key(
        36.0, "rad/s", "bandwidth of the second-order low-pass filter on the measured push", source=TRIAL
    )
    output_bandwidth: Bandwidth = key(
        60.0, "rad/s", "bandwidth of the second-order low-pass filter after the dead band", source=TRIAL
    )
    release_fraction: Fraction = key(
        0.67, "1", "a push ends below this fraction of the threshold", source="chosen: a hysteresis of a third"
    )
    dwell: NonNegative = key(
        0.016, "s", "time for which a force must exceed the threshold before it counts as a push", source="chosen"
    )
    bias_time_constant: Positive = key(
        20.0,
        "s",
        "time constant with which the mean of the measured push is learned as a bias while nobody pushes",
        source="chosen: slow against any push",
    )
    max_speed: Positive3 = key(
        (2.0, 2.0, 1.0), "m/s", "largest speed of the reference along each axis", source="chosen"
    )
    max_acceleration: Positive3 = key((3.0, 3.0, 3.0), "m/s²", "largest acceleration of the reference", source="chosen")
    max_jerk: Positive3 = key((15.0, 15.0, 15.0), "m/s³", "largest jerk of the reference", source="chosen")
    braking_gain: Positive = key(4.0, "1/s", "braking gain b: acceleration ≤ b · (max_speed − speed)", source="chosen")
    max_tilt: Tilt = key(
        0.5, "rad", "largest tilt for accelerations", source="chosen: 29°, where hover needs 14 % more thrust"
    )
    thrust_fraction: Fraction = key(
        0.9, "1", "fraction of the largest thrust that accelerations may use", source="chosen: leaves 10 % for control"
    )
    force_lead: Delay = key(
        0.11, "s", "lead time of the compensated push, against the delay of filters and rotors", source=TRIAL
    )
    moment_lead: Delay = key(0.06, "s", "lead time of the compensated push's moment", source=TRIAL)
    reference_lead: Delay = key(0.11, "s", "lead time of the reference's acceleration", source=TRIAL)
    vertical_force_lead: Delay | None = key(
        None, "s", "force_lead along z, where no tilt delays the thrust", unset="that of x and y", example=0.05
    )
    vertical_reference_lead: Delay | None = key(
        None, "s", "reference_lead along z", unset="that of x and y", example=0.03
    )
    alternation_share: Positive = key(
        0.25,
        "1",
        "share of the vehicle's least horizontal agility for which a push that alternates may ask; beyond it, less of "
        "its fast part is followed and compensated; 1000 for no limit",
        source="chosen: shakes of 4 N from 0.5 to 10 Hz",
    )
    mass_feedforward: bool = key(
        False, None, "whether the mass that a tare identifies is accelerated, too, with the reference", source="off"
    )
    touchdown_depth: NonNegative = key(
        0.03, "m", "depth below the ground at which a landing's reference ends, so that the feet press", source="chosen"
    )
    min_height: NonNegative = key(
        0.1,
        "m",
        "height above the ground of the lift, below which a push moves the reference no further down; "
        "where there is a floor",
        source="chosen: far above the depth of a landing",
    )
    spin_up_time: NonNegative = key(0.3, "s", "time from the start of the rotors to the lift", source="chosen")
    max_descent_speed: Positive = key(0.3, "m/s", "largest speed of a landing", source="chosen")
    following: FollowingTable = FollowingTable()
    yaw: YawTable = YawTable()
    tank: TankTable = TankTable()
    policy: PolicyTable = PolicyTable()


def push_filters(compliance: ComplianceTable, step: float) -> PushFilters:
    """The filters of a push, sampled every `step` [s]."""
    c = compliance
    before, after = low_pass(c.input_bandwidth, step), low_pass(c.output_bandwidth, step)
    return PushFilters(before, after, c.release_fraction, c.dwell, c.bias_time_constant)


def compliance_from(
    started: Started,
    compliance: ComplianceTable,
    admittance: AdmittanceTable,
    push_filters: PushFilters,
    vehicle: Vehicle,
    alternation: Alternation,
) -> Compliance:
    """The compliance around an admittance."""
    c, speed, parts = compliance, vec3(compliance.max_speed), started("compliance")[0]
    return Compliance(
        input_filter=push_filters.input,
        band=push_filters.dead_band(vec3(admittance.threshold)),
        output_filter=push_filters.output,
        admittance=admittance_from(admittance),
        limits=MotionLimits(speed, speed, vec3(c.max_acceleration), vec3(c.max_jerk), c.braking_gain),
        force_lead=_lead(c.force_lead, c.vertical_force_lead),
        reference_lead=_lead(c.reference_lead, c.vertical_reference_lead),
        payload=AssumedPayload(vehicle.payload.mass) if c.mass_feedforward else Absent(),
        alternation=alternation,
        **parts,
    )


def _lead(lead: float, vertical: float | None) -> float | Vec3:
    """A lead time [s], or one for each axis."""
    return lead if vertical is None else Vec3(lead, lead, vertical)
