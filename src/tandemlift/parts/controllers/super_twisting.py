"""Super-twisting control: a second-order sliding mode on a linear surface, whose integral finds the disturbance.

Source: Levant, Sliding order and sliding accuracy in sliding mode control, 1993; gains by Levant, Robust exact
differentiation via sliding mode technique, 1998: per axis, with S = ė + λe and a matched disturbance of |δ̇| ≤ L, the
acceleration ẍ_d + λė + v + 1.5 √L |S|^½ sgn S, v̇ = 1.1 L sgn S brings S and Ṡ to zero in finite time, and v to −δ. It
does not cover the attitude cascade.

Within |S| ≤ Φ the square root and the sign are made linear, so that measurement noise is averaged and nothing chatters:
there a natural frequency of √(1.1 L/Φ) and a damping of 0.72 are left. With a smaller Φ it is Levant's law.

Tune first: λ, then √(L/Φ) against the rotors' lag, then L against what changes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tandemlift.core.algebra import absolute, clip, maximum, sqrt
from tandemlift.core.keys import Positive6, key
from tandemlift.core.law import elementwise, law
from tandemlift.core.trajectories import Reference
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, vec3
from tandemlift.parts.controllers.attitude_reference import CommandFilterState
from tandemlift.parts.controllers.cascade import (
    ATTITUDE_FILTER,
    LEVEL,
    TUNED,
    Bandwidth,
    CascadeTable,
    ControllerModel,
    command_from,
    controller_model,
    position_and_attitude,
    tracked_attitude,
    wanted_force,
)
from tandemlift.parts.controllers.interface import Command, Measured, control
from tandemlift.parts.controllers.registry import register
from tandemlift.parts.controllers.sliding_surface import saturate
from tandemlift.parts.mechanics.rotation import euler_from_quaternion, euler_rates_from_rates, limit_tilt, wrap_angle
from tandemlift.parts.mechanics.vehicle import Vehicle

ROOT, SIGN = 1.5, 1.1  # of √L and of L: Levant, 1998


class SuperTwistingSettings(CascadeTable):
    """`[controller]`: settings of super-twisting control, per axis x, y, z, φ, θ, ψ."""

    filter_bandwidth: Bandwidth = key(8.54, "rad/s", ATTITUDE_FILTER, source=TUNED)
    slope: Positive6 = key((5.48, 0.657, 2.5, 3.38, 12.9, 0.249), "1/s", "slope λ of the sliding surface", source=TUNED)
    disturbance_slope: Positive6 = key(
        (1.09, 6.97, 36.1, 2.3, 6.3, 2.78),
        "m/s³, rad/s³",
        "largest slope L of the disturbance, which gives the gains 1.5 √L and 1.1 L",
        source=TUNED,
    )
    boundary_layer: Positive6 = key(
        (0.932, 1.68, 1.13, 0.303, 0.516, 0.363), "m/s, rad/s", "boundary layer Φ", source=TUNED
    )
    integral_limit: Positive6 = key(
        (2.0, 2.0, 2.0, 2.0, 2.0, 0.5), "m/s², rad/s²", "largest magnitude of the integral v", source="chosen"
    )


class TwistingGains(NamedTuple):
    """Gains of one set of axes: λ [1/s], 1.5 √L, 1.1 L of one step, Φ, 1/Φ and the limit of v."""

    slope: Vec3
    root: Vec3
    sign_per_step: Vec3
    width: Vec3
    per_width: Vec3
    limit: Vec3


class SuperTwisting(NamedTuple):
    """Gains: the nominal vehicle, and both surfaces."""

    vehicle: ControllerModel
    position: TwistingGains
    attitude: TwistingGains


class SuperTwistingState(NamedTuple):
    """Memory: that of the attitude reference, and the integrals v of position [m/s²] and attitude [rad/s²]."""

    shaped: CommandFilterState
    position: Vec3
    attitude: Vec3


@elementwise
def signed_root(S: Number, width: Number) -> Number:
    """|S|^½ sgn S, made linear within |S| ≤ Φ."""
    return S / sqrt(maximum(absolute(S), width))


@law
def super_twisting_step(k: TwistingGains, v: Vec3, e: Vec3, de: Vec3) -> tuple[Vec3, Vec3]:
    """(λė + v + 1.5 √L |S|^½ sgn S, the new v) with S = ė + λe: to be added to the reference acceleration."""
    S = de + k.slope * e
    feedback = k.slope * de + v + k.root * signed_root(S, k.width)
    return feedback, clip(v + k.sign_per_step * saturate(S * k.per_width), -k.limit, k.limit)


@control.register(SuperTwisting)
def super_twisting(
    k: SuperTwisting, memory: SuperTwistingState, measured: Measured, reference: Reference
) -> tuple[Command, SuperTwistingState]:
    """The whole controller at one sample."""
    state, target = measured.state, reference.trajectory
    e = euler_from_quaternion(state.attitude)
    position_error, velocity_error = target.position - state.position, target.velocity - state.velocity
    feedback, position = super_twisting_step(k.position, memory.position, position_error, velocity_error)
    u = limit_tilt(k.vehicle.tilt, wanted_force(k.vehicle, feedback, measured, reference))
    tracked, shaped = tracked_attitude(k.vehicle, memory.shaped, e, u, reference)
    attitude_error = wrap_angle(tracked.angles - e.angles)
    rate_error = tracked.rates - euler_rates_from_rates(e, state.rates)
    attitude_feedback, attitude = super_twisting_step(k.attitude, memory.attitude, attitude_error, rate_error)
    angular_acceleration = tracked.accelerations + attitude_feedback
    command = command_from(k.vehicle, e, u, angular_acceleration, tracked.angles, measured)
    return command, SuperTwistingState(shaped, position, attitude)


def twisting_gains(
    step: float, slope: Sequence[float], growth: Sequence[float], width: Sequence[float], limit: Sequence[float]
) -> TwistingGains:
    """The gains of three axes for samples every `step` [s], by λ [1/s], L, Φ and the limit of v."""
    return TwistingGains(
        slope=vec3(slope),
        root=vec3(ROOT * L**0.5 for L in growth),
        sign_per_step=vec3(SIGN * L * step for L in growth),
        width=vec3(width),
        per_width=vec3(1.0 / w for w in width),
        limit=vec3(limit),
    )


@register("super-twisting", SuperTwistingSettings)
def start(s: SuperTwistingSettings, vehicle: Vehicle, step: float) -> tuple[SuperTwisting, SuperTwistingState]:
    """Super-twisting control on linear surfaces, with its integral (Levant)."""
    sixes = position_and_attitude(s.slope, s.disturbance_slope, s.boundary_layer, s.integral_limit)
    position, attitude = (twisting_gains(step, *three) for three in sixes)
    return SuperTwisting(controller_model(s, vehicle, step), position, attitude), SuperTwistingState(LEVEL, ZERO, ZERO)
