"""How the vehicle turns under a hand: the yaw axis of the compliance, within the rotors' small yaw authority.

J ψ̈ + min(C |ψ̇|, U) sgn ψ̇ = M with M the moment beyond the threshold. With J the vehicle's own inertia the rotors give
no more than the damping, at most U: what the person adds beyond turns the vehicle faster, and never asks for more.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice
from tandemlift.algebra.ops import clip, where
from tandemlift.laws.guidance.compliance import DeadBand, DeadBandState, dead_band
from tandemlift.laws.mechanics.rotation import wrap_angle
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step


class YawCompliance(NamedTuple):
    """Low-pass on the moment, dead-band [N·m], low-pass after it, 1/J [1/(kg·m²)], C [N·m·s], U [N·m].

    `max_lead_angle` [rad]: how far the reference may lead the vehicle, so that it waits for one that cannot turn.
    """

    input_filter: LowPass
    band: DeadBand
    output_filter: LowPass
    inverse_inertia: Any
    damping: Any
    most: Any
    max_lead_angle: Any


class YawState(NamedTuple):
    """Memory: the moment [N·m] behind each low-pass, the dead-band's; ψ_r [rad], its rate and acceleration."""

    heard: LowPassState
    hearing: DeadBandState
    eased: LowPassState
    angle: Any
    rate: Any
    acceleration: Any


class FixedHeading(NamedTuple):
    """The heading is held at an angle [rad], whatever the moment.

    Once a rotor is lost, the reference is at most `max_lead_angle` [rad] from the vehicle, which may have to turn.
    """

    angle: Any
    max_lead_angle: Any


class HeadingReference(NamedTuple):
    """The heading's reference: ψ_d [rad], its rate [rad/s] and acceleration [rad/s²]."""

    angle: Any
    rate: Any
    acceleration: Any


@choice
def yaw_step(k: Any, m: Any, moment: Any, yaw: Any, orders: Any, lost: Any, dt: Any) -> Any:
    """(course, the new memory) under a moment about the vertical [N·m] at an actual yaw [rad]; see `phases.Orders`.

    `lost` is 1 once a rotor is lost, else 0.
    """


@yaw_step.register(FixedHeading)
def _held(k, m, moment, yaw, orders, lost, dt):
    near = wrap_angle(yaw + clip(wrap_angle(k.angle - yaw), -k.max_lead_angle, k.max_lead_angle))
    return HeadingReference(where(lost > 0.0, near, k.angle), 0.0, 0.0), m


@yaw_step.register(YawCompliance)
def _turning(k, m, moment, yaw, orders, lost, dt):
    heard = low_pass_step(k.input_filter, m.heard, moment)
    beyond, hearing = dead_band(k.band, m.hearing, heard.value, orders.listening, dt)
    eased = low_pass_step(k.output_filter, m.eased, beyond)
    acceleration = (eased.value - clip(k.damping * m.rate, -k.most, k.most)) * k.inverse_inertia
    ahead = wrap_angle(m.angle + m.rate * dt + acceleration * (0.5 * dt * dt) - yaw)
    most, off = k.max_lead_angle * (1.0 - orders.grounded), 1.0 - orders.grounded
    angle = wrap_angle(yaw + clip(ahead, -most, most))
    after = YawState(heard, hearing, eased, angle, (m.rate + acceleration * dt) * off, acceleration)
    return HeadingReference(m.angle, m.rate, acceleration), after
