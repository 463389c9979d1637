"""The compliance about the yaw axis, within the small yaw authority of the rotors.

J ψ̈ + min(C |ψ̇|, U) sgn ψ̇ = M with M the moment beyond the threshold. With J the inertia of the vehicle, the rotors
only need to give the damping, at most U: a larger moment rotates the vehicle faster without more thrust.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from tandemlift.core.algebra import clip, where
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import NonNegative, Positive, Table, Tilt, key
from tandemlift.core.law import choice
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass_step
from tandemlift.core.part import Part
from tandemlift.core.trajectories import PhasesTable
from tandemlift.core.types import Number, filled, number
from tandemlift.core.vector import Absent
from tandemlift.parts.guidance.dead_band import DeadBand, DeadBandState, PushFilters, dead_band
from tandemlift.parts.guidance.phases import PhaseOutput
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.rotation import heading_from, wrap_angle
from tandemlift.parts.mechanics.vehicle import Vehicle


class YawTable(
    Table, acts='compliance.yaw.model = "compliant"', keys_act={"threshold": 'also estimator.confirmation = "motion"'}
):
    """`[compliance.yaw]`: rotation of the vehicle by a push beside the centre of mass."""

    model: Literal["held", "compliant"] = key(
        "held",
        None,
        "whether a push beside the centre rotates the vehicle",
        choices={
            "held": "the heading is held",
            "compliant": "an admittance about the vertical responds to the push's moment",
        },
    )
    inertia: Positive | None = key(
        None,
        "kg m²",
        "virtual moment of inertia",
        unset="the vehicle's own, which needs the smallest moments of the rotors",
        example=3.3,
    )
    damping: Positive = key(1.6, "N m s", "virtual damping", source="chosen")
    threshold: NonNegative = key(0.15, "N m", "moments up to this are ignored", source="chosen")
    max_moment: Positive = key(
        0.9, "N m", "largest moment of the virtual damping", source="chosen: within the moment that the rotors have"
    )
    max_lead_angle: Tilt = key(
        0.35, "rad", "largest angle by which the reference heading may be ahead of the vehicle's", source="chosen"
    )


class YawCompliance(NamedTuple):
    """Low-pass on the moment, dead-band [N·m], low-pass after it, 1/J [1/(kg·m²)], C [N·m·s], U [N·m].

    `max_lead_angle` [rad]: largest lead of the reference, which waits while the vehicle cannot rotate.
    """

    input_filter: LowPass
    band: DeadBand[Number]
    output_filter: LowPass
    inverse_inertia: Number
    damping: Number
    max_moment: Number
    max_lead_angle: Number


class YawState(NamedTuple):
    """Memory: the moment [N·m] after each low-pass, the dead-band's; ψ_r [rad], its rate and acceleration."""

    filtered: LowPassState[Number]
    band: DeadBandState[Number]
    output: LowPassState[Number]
    angle: Number
    rate: Number
    acceleration: Number


class FixedHeading(NamedTuple):
    """A constant heading [rad], whatever the moment.

    Once a rotor has failed, the reference is at most `max_lead_angle` [rad] from the vehicle, which may have to rotate.
    """

    angle: Number
    max_lead_angle: Number


class HeadingReference(NamedTuple):
    """The heading's reference: ψ_d [rad], its rate [rad/s] and acceleration [rad/s²]."""

    angle: Number
    rate: Number
    acceleration: Number


@choice
def yaw_step(
    k: FixedHeading | YawCompliance,
    m: YawState | Absent,
    moment: Number,
    yaw: Number,
    phase: PhaseOutput,
    rotor_failed: Number,
    dt: Number,
) -> tuple[HeadingReference, YawState | Absent]:
    """(`HeadingReference`, the new memory) under a moment about the vertical [N·m] at the vehicle's yaw [rad].

    `rotor_failed` is 1 once a rotor has failed, else 0.
    """


@yaw_step.register(FixedHeading)
def _fixed(
    k: FixedHeading, m: Absent, moment: Number, yaw: Number, phase: PhaseOutput, rotor_failed: Number, dt: Number
) -> tuple[HeadingReference, Absent]:
    near = wrap_angle(yaw + clip(wrap_angle(k.angle - yaw), -k.max_lead_angle, k.max_lead_angle))
    return HeadingReference(where(rotor_failed > 0.0, near, k.angle), 0.0, 0.0), m


@yaw_step.register(YawCompliance)
def _turning(
    k: YawCompliance, m: YawState, moment: Number, yaw: Number, phase: PhaseOutput, rotor_failed: Number, dt: Number
) -> tuple[HeadingReference, YawState]:
    filtered = low_pass_step(k.input_filter, m.filtered, moment)
    beyond, band = dead_band(k.band, m.band, filtered.value, phase.responding, dt)
    output = low_pass_step(k.output_filter, m.output, beyond)
    acceleration = (output.value - clip(k.damping * m.rate, -k.max_moment, k.max_moment)) * k.inverse_inertia
    # the lead is limited after the step, so the reference waits for a vehicle that cannot rotate
    ahead = wrap_angle(m.angle + m.rate * dt + acceleration * (0.5 * dt * dt) - yaw)
    airborne = 1.0 - phase.grounded
    lead = k.max_lead_angle * airborne
    after = YawState(
        filtered=filtered,
        band=band,
        output=output,
        angle=wrap_angle(yaw + clip(ahead, -lead, lead)),
        rate=(m.rate + acceleration * dt) * airborne,
        acceleration=acceleration,
    )
    return HeadingReference(m.angle, m.rate, acceleration), after


NO_MOMENT = LowPassState(0.0, 0.0)


def start_heading(
    table: YawTable, push_filters: PushFilters, vehicle: Vehicle, initial: InitialTable, phases: PhasesTable
) -> tuple[YawCompliance, YawState] | tuple[FixedHeading, Absent]:
    """The compliance about the yaw axis from the first heading, and its memory."""
    push, heading = push_filters, heading_from(0.0 if phases.rotors == "always" else initial.euler[2])
    if table.model == "held":
        return FixedHeading(heading, table.max_lead_angle), Absent()
    turning = filled(
        YawCompliance,
        table,
        input_filter=push.input,
        band=push.dead_band(table.threshold),
        output_filter=push.output,
        inverse_inertia=1.0 / (number(vehicle.inertia[2, 2]) if table.inertia is None else table.inertia),
    )
    quiet = DeadBandState(active=0.0, above_time=0.0, inactive_time=0.0, mean=0.0, bias=0.0)
    return turning, YawState(NO_MOMENT, quiet, NO_MOMENT, heading, 0.0, 0.0)


def yaw_checks(table: YawTable, vehicle: Vehicle, guidance: str, step: float) -> Iterator[CheckResult]:
    """Check for a sampled admittance about the yaw axis that is unstable; `guidance`: `pilot.guidance`."""
    J = float(vehicle.inertia[2, 2]) if table.inertia is None else table.inertia
    most = 2.0 * J / step  # ψ̇ is multiplied by 1 − C h/J in a step
    if (table.model, guidance) == ("compliant", "interactive") and table.damping > most * (1.0 + 1e-12):
        yield refused(
            f"compliance.yaw.damping = {table.damping:g}: must be at most 2*inertia/step = {most:.6g} N m s with "
            f"inertia {J:g} kg m² (compliance.yaw.inertia, or the vehicle's) and step {step:g} s, or the admittance is "
            "unstable"
        )


HEADING = Part("heading", "guidance", "compliance.yaw", "", start_heading, refusals=yaw_checks)
