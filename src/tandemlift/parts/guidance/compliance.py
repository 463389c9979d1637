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

from typing import Generic, NamedTuple

from tandemlift.core.algebra import absolute, chosen, clip, maximum, minimum, sqrt, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, V, low_pass_step
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3
from tandemlift.parts.guidance.admittance import (
    Admittance,
    AdmittanceState,
    admittance_response,
    anchored,
    soft_threshold,
)
from tandemlift.parts.guidance.alternation import Alternation, AlternationState, alternation_step, calmed
from tandemlift.parts.guidance.policy import Policy, with_policy
from tandemlift.parts.guidance.requests import ReferenceVelocity

QUIET_TIME = 2.0  # s without a push, after which the bias is estimated
BIAS_CLIP = 0.3  # of the threshold: the largest deviation from the mean that counts for the bias
BIAS_RATE = 0.5  # 1/s, at which the bias follows the mean, with a lag of two seconds


class DeadBand(NamedTuple, Generic[V]):
    """Threshold [N] above which a push is active, and `release` [N] below which it ends; `dwell` [s] before it starts.

    `bias_rate` [1/s]: of the mean that becomes the bias, while no push was active for `QUIET_TIME`.
    """

    threshold: V
    release: V
    dwell: Number
    bias_rate: Number


class PushFilters(NamedTuple):
    """The filters of a push before and after its dead band."""

    input: LowPass
    output: LowPass
    release_fraction: Number
    dwell: Number
    bias_time_constant: Number

    def dead_band(self, threshold: V) -> DeadBand[V]:
        """The dead band for a threshold [N or N·m]."""
        return DeadBand(threshold, threshold * self.release_fraction, self.dwell, 1.0 / self.bias_time_constant)


class DeadBandState(NamedTuple, Generic[V]):
    """Memory: 1 while a push is active, else 0; times [s] above the threshold, and without an active push; bias.

    The bias follows the `mean` with a lag, and the mean returns to it if a push begins.
    """

    active: V
    above_time: V
    inactive_time: V
    mean: V
    bias: V


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
def is_active(
    active: Number, above_time: Number, force: Number, threshold: Number, release: Number, dwell: Number
) -> Number:
    """1 while a push is active: once it was above the threshold for the dwell, until it is below the release."""
    begins = where(absolute(force) > threshold, where(above_time < dwell, 0.0, 1.0), 0.0)
    return where(active > 0.0, where(absolute(force) < release, 0.0, 1.0), begins)


@elementwise
def time_above(above_time: Number, force: Number, threshold: Number, dt: Number) -> Number:
    """The time for which a push has been above the threshold [s]."""
    return where(absolute(force) > threshold, above_time + dt, 0.0)


@elementwise
def time_inactive(inactive_time: Number, active: Number, dt: Number) -> Number:
    """The time without an active push [s]."""
    return (inactive_time + dt) * (1.0 - active)


@elementwise
def bias_input(force: Number, bound: Number, inactive_time: Number) -> Number:
    """The input of the mean: the force within a bound, once no push was active for `QUIET_TIME`."""
    return where(inactive_time < QUIET_TIME, 0.0, clip(force, -bound, bound))


@elementwise
def unless_active(active: Number, old: Number, new: Number) -> Number:
    """The old value while a push is active, else the new one."""
    return where(active > 0.0, old, new)


@law
def dead_band(k: DeadBand[V], m: DeadBandState[V], force: V, enabled: Number, dt: Number) -> tuple[V, DeadBandState[V]]:
    """(the part of an active force beyond the threshold, the new memory); while `enabled` is 0, no push is active."""
    f = force - m.bias
    above = time_above(m.above_time, f, k.threshold, dt) * enabled
    active = is_active(m.active, above, f, k.threshold, k.release, k.dwell) * enabled
    inactive = time_inactive(m.inactive_time, active, dt) * enabled
    deviation = bias_input(force - m.mean, k.threshold * BIAS_CLIP, inactive)
    # a push that begins resets the mean, so that what came before the dwell does not become bias
    mean = unless_active(active, m.bias, m.mean + deviation * (k.bias_rate * dt))
    bias = m.bias + (mean - m.bias) * (BIAS_RATE * dt)
    return soft_threshold(f, k.threshold) * active, DeadBandState(active, above, inactive, mean, bias)


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
