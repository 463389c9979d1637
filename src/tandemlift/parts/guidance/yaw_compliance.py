"""The compliance about the yaw axis, within the small yaw authority of the rotors.

J ψ̈ + min(C |ψ̇|, U) sgn ψ̇ = M with M the moment beyond the threshold. With J the inertia of the vehicle, the rotors
only need to give the damping, at most U: a larger moment of the person turns the vehicle faster and needs no more.
"""

from typing import Any, NamedTuple

from tandemlift.core.algebra.law import choice
from tandemlift.core.algebra.ops import clip, where
from tandemlift.parts.compliance.compliance import DeadBand, DeadBandState, dead_band
from tandemlift.parts.guidance.phases import PhaseOutput
from tandemlift.parts.mechanics.rotation import wrap_angle
from tandemlift.parts.signals.low_pass import LowPass, LowPassState, low_pass_step


class YawCompliance(NamedTuple):
    """Low-pass on the moment, dead-band [N·m], low-pass after it, 1/J [1/(kg·m²)], C [N·m·s], U [N·m].

    `max_lead_angle` [rad]: by which the reference may lead the vehicle, so that it waits while the vehicle cannot turn.
    """

    input_filter: LowPass
    band: DeadBand
    output_filter: LowPass
    inverse_inertia: Any
    damping: Any
    max_moment: Any
    max_lead_angle: Any


class YawState(NamedTuple):
    """Memory: the moment [N·m] after each low-pass, the dead-band's; ψ_r [rad], its rate and acceleration."""

    filtered: LowPassState
    band: DeadBandState
    output: LowPassState
    angle: Any
    rate: Any
    acceleration: Any


class FixedHeading(NamedTuple):
    """A constant heading [rad], whatever the moment.

    Once a rotor has failed, the reference is at most `max_lead_angle` [rad] from the vehicle, which may have to turn.
    """

    angle: Any
    max_lead_angle: Any


class HeadingReference(NamedTuple):
    """The heading's reference: ψ_d [rad], its rate [rad/s] and acceleration [rad/s²]."""

    angle: Any
    rate: Any
    acceleration: Any


@choice
def yaw_step(k: Any, m: Any, moment: Any, yaw: Any, phase: PhaseOutput, rotor_failed: Any, dt: Any) -> Any:
    """(`HeadingReference`, the new memory) under a moment about the vertical [N·m] at the vehicle's yaw [rad].

    `rotor_failed` is 1 once a rotor has failed, else 0.
    """


@yaw_step.register(FixedHeading)
def _fixed(k: FixedHeading, m: Any, moment: Any, yaw: Any, phase: PhaseOutput, rotor_failed: Any, dt: Any) -> Any:
    near = wrap_angle(yaw + clip(wrap_angle(k.angle - yaw), -k.max_lead_angle, k.max_lead_angle))
    return HeadingReference(where(rotor_failed > 0.0, near, k.angle), 0.0, 0.0), m


@yaw_step.register(YawCompliance)
def _turning(
    k: YawCompliance, m: YawState, moment: Any, yaw: Any, phase: PhaseOutput, rotor_failed: Any, dt: Any
) -> Any:
    filtered = low_pass_step(k.input_filter, m.filtered, moment)
    beyond, band = dead_band(k.band, m.band, filtered.value, phase.responding, dt)
    output = low_pass_step(k.output_filter, m.output, beyond)
    acceleration = (output.value - clip(k.damping * m.rate, -k.max_moment, k.max_moment)) * k.inverse_inertia
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
