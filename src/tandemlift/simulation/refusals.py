"""The present reasons for refusing a lift or a landing, or not following a push, as numbers: see `core.refusals`.

The law uses the pilot's memory after its last sample, and is no part of a step. Mission modules contain it too.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tandemlift.core.algebra import absolute, atan2, maximum, minimum, selected, sqrt, where
from tandemlift.core.faults import FAULTS
from tandemlift.core.law import choice, law
from tandemlift.core.phases import CONTACT, GUIDED, HOLD, IDLE, LAND, LIFT, LIMITED, STOPPED
from tandemlift.core.refusals import NUMBER_OF, REQUESTS, Refusals, refusal_of
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import dot, total
from tandemlift.parts.guidance.admittance import AdmittanceState
from tandemlift.parts.guidance.compliance import Compliance, ComplianceState
from tandemlift.parts.guidance.contact_hold import ContactReaction, ContactReactionState
from tandemlift.parts.guidance.fault_detection import HOLDS
from tandemlift.parts.guidance.hand_guidance import HandGuidance, HandGuidanceState
from tandemlift.parts.guidance.scheduled_guidance import ScheduledGuidance
from tandemlift.parts.guidance.supervision import Supervision, SupervisionState
from tandemlift.parts.mechanics.rotation import body_z_axis
from tandemlift.parts.rotors.rotor_faults import efficiency_at

ROUNDING = 6755399441055744.0  # 1.5·2⁵²: a number that is added and subtracted again becomes a whole one
HUNDREDTHS, TENTHS = 100.0, 10.0
LIMITED_ALARM = float(next(fault.alarm for fault in FAULTS if fault.key == "limited"))
DEGREE, PERCENT = 180.0 / math.pi, 100.0


class ReasonNumbers(NamedTuple):
    """The number of a reason, or 0; the value and the limit in its text, rounded as they are shown."""

    number: Number
    value: Number
    limit: Number


class RefusalNumbers(NamedTuple):
    """The reasons of a pilot against a lift, against a landing, and for not following a push."""

    lift: ReasonNumbers
    land: ReasonNumbers
    push: ReasonNumbers


NONE = ReasonNumbers(0.0, 0.0, 0.0)


@law
def rounded(x: Number, parts: Number) -> Number:
    """A number of moderate size, rounded to a fraction of 1."""
    return ((x * parts + ROUNDING) - ROUNDING) / parts


def reason(key: str, value: Number = 0.0, limit: Number = 0.0, parts: float = HUNDREDTHS) -> ReasonNumbers:
    """A reason with its value and its limit."""
    return ReasonNumbers(NUMBER_OF[key], rounded(value, parts), rounded(limit, parts))


def by_value(number: Number, cases: dict[float, ReasonNumbers], other: ReasonNumbers) -> ReasonNumbers:
    """The reason of the case that a number equals, or the other one."""
    found = other
    for case, answer in cases.items():
        found = selected(number == case, answer, found)
    return found


@choice
def refusal_numbers(
    guidance: ScheduledGuidance | HandGuidance, memory: AdmittanceState | HandGuidanceState, t: Number
) -> RefusalNumbers:
    """`RefusalNumbers` of a guidance with its memory after the last sample, at time t [s]."""


@refusal_numbers.register(ScheduledGuidance)
def _by_schedule(g: ScheduledGuidance, m: AdmittanceState, t: Number) -> RefusalNumbers:
    return RefusalNumbers(reason("scheduled"), reason("scheduled"), NONE)


@refusal_numbers.register(HandGuidance)
def _by_hand(g: HandGuidance, m: HandGuidanceState, t: Number) -> RefusalNumbers:
    phase, once = m.phase.phase, where(m.phase.land_rate > 0.0, g.phasing.always_running, 0.0)
    grounded = selected(once > 0.0, reason("once"), lift_check(g.supervision, m.supervision, t))
    landing, stopped = reason("landing"), reason("stopped")
    return RefusalNumbers(
        lift=by_value(phase, {IDLE: grounded, LAND: landing, STOPPED: stopped}, reason("in_air")),
        land=by_value(phase, {IDLE: reason("landed"), STOPPED: stopped}, NONE),
        push=by_value(
            phase,
            {
                IDLE: reason("on_ground"),
                LIFT: reason("lifting"),
                LAND: landing,
                STOPPED: stopped,
                HOLD: why_it_holds(g.supervision, m.supervision),
                GUIDED: below_threshold(g.compliance, m.compliance),
                CONTACT: touching_part(g.contact, m.contact),
                LIMITED: reason("limited", LIMITED_ALARM + m.following.reason),
            },
            NONE,
        ),
    )


@law(absent=NONE)
def lift_check(k: Supervision, m: SupervisionState, t: Number) -> ReasonNumbers:
    """`ReasonNumbers` of the check that fails before a lift; `k`: the supervision."""
    c, state = k.checks, m.state
    available = total(k.limits * efficiency_at(k.known, t))
    hover = (k.mass + m.payload - k.payload) * GRAVITY / maximum(available, 1e-9)
    speed, rates = sqrt(dot(state.velocity, state.velocity)), sqrt(dot(state.rates, state.rates))
    moves, turns = reason("rest", speed, c.speed), reason("turning", rates, c.rates)
    numbers = {
        "hover": reason("hover", PERCENT * hover, PERCENT * c.thrust_fraction, TENTHS),
        "level": reason(
            "level", DEGREE * tilt_of(body_z_axis(state.attitude).z), DEGREE * tilt_of(c.min_upright), TENTHS
        ),
        "rest": selected(speed > c.speed, moves, turns),
        "sensors": failed_sensor(k, m),
    }
    failed = ("imu", "motion", "rotors")
    cases = {NUMBER_OF[key]: reason(key) for key in failed} | {NUMBER_OF[key]: one for key, one in numbers.items()}
    return by_value(m.lift_check, cases, NONE)


@law
def tilt_of(upright: Number) -> Number:
    """The angle [rad] whose cosine is given."""
    return atan2(sqrt(maximum(1.0 - upright * upright, 0.0)), upright)


@law
def failed_sensor(k: Supervision, m: SupervisionState) -> ReasonNumbers:
    """The sensor that has failed, or the time without a failed one."""
    recovering = reason("recovering", m.fault_free_time, k.recovery_time)
    over = selected(m.reaction > 0.0, recovering, reason("unknown_sensor"))
    return selected(m.fault > 0.0, reason("sensors", m.fault), over)


@law(absent=reason("disabled"))
def why_it_holds(k: Supervision, m: SupervisionState) -> ReasonNumbers:
    """`ReasonNumbers` of a vehicle in the air that does not follow pushes; `k`: the supervision."""
    tared = {NUMBER_OF[key]: reason(key) for key in ("tare", "joints")}
    cases = {**tared, NUMBER_OF["payload"]: reason("payload", m.payload)}
    check = by_value(m.failed_guidance_check, cases, reason("disabled"))
    return selected(m.reaction >= HOLDS, reason("fault", m.alarm), check)


@law(absent=NONE)
def touching_part(k: ContactReaction, m: ContactReactionState) -> ReasonNumbers:
    """`ReasonNumbers` of the part that touches a wall; `k`: the reaction to contacts."""
    return selected(m.part < 0.0, reason("beam_touches"), reason("guard_touches", m.part))


@law
def below_threshold(k: Compliance, m: ComplianceState) -> ReasonNumbers:
    """1 if the push is too weak along every axis; push and threshold of the axis that is nearest to its threshold."""
    found, nearest = NONE, 1.0
    for push, bias, limit in zip(m.filtered.value, m.band.bias, k.band.threshold, strict=True):
        missing = 1.0 - absolute(push - bias) / maximum(limit, 1e-9)
        found = selected(missing < nearest, reason("weak", absolute(push - bias), limit), found)
        nearest = minimum(missing, nearest)
    return selected(total(m.band.active) > 0.0, NONE, selected(nearest > 0.0, found, NONE))


def refusals_of(
    guidance: ScheduledGuidance | HandGuidance, memory: AdmittanceState | HandGuidanceState, t: float
) -> Refusals:
    """The refusals of a pilot in words; arguments as for `refusal_numbers`."""
    found = refusal_numbers(guidance, memory, t)
    return Refusals(*[refusal_of(request, *numbers) for request, numbers in zip(REQUESTS, found, strict=True)])
