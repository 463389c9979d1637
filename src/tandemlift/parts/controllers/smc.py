"""Conventional sliding mode control: a linear surface, switched in a boundary layer.

Source: Slotine and Li, Applied Nonlinear Control, 1991, section 7.2, per axis: S = ė + λe, the acceleration
ẍ_d + λė + K sat(S/Φ). With |δ| < K the layer |S| ≤ Φ is reached within (|S₀| − Φ)/(K − |δ|); in it, the error stays
below Φ/λ, and a constant disturbance δ leaves the offset Φδ/(Kλ). It does not cover the attitude cascade.

Tune first: λ (the bandwidth on the surface), then K/Φ (that of reaching it) against the rotors' lag, then K itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tandemlift.core.keys import Positive6, key
from tandemlift.core.law import law
from tandemlift.core.trajectories import Reference
from tandemlift.core.vector import Vec3, vec3
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


class SMCSettings(CascadeTable):
    """`[controller]`: settings of conventional sliding mode control, per axis x, y, z, φ, θ, ψ."""

    filter_bandwidth: Bandwidth = key(13.6, "rad/s", ATTITUDE_FILTER, source=TUNED)
    slope: Positive6 = key((1.57, 3.2, 1.61, 2.09, 4.93, 0.225), "1/s", "slope λ of the sliding surface", source=TUNED)
    gain: Positive6 = key((2.02, 1.31, 9.67, 5.4, 2.24, 1.42), "m/s², rad/s²", "switching gain K", source=TUNED)
    boundary_layer: Positive6 = key(
        (1.07, 1.87, 0.465, 1.27, 0.649, 0.122), "m/s, rad/s", "boundary layer Φ", source=TUNED
    )


class LinearSurface(NamedTuple):
    """Gains of one set of axes: λ [1/s], K [m/s² or rad/s²] and 1/Φ."""

    slope: Vec3
    gain: Vec3
    per_width: Vec3


class SMC(NamedTuple):
    """Gains: the nominal vehicle, and both surfaces."""

    vehicle: ControllerModel
    position: LinearSurface
    attitude: LinearSurface


@law
def switched_acceleration(k: LinearSurface, e: Vec3, de: Vec3) -> Vec3:
    """λė + K sat(S/Φ) with S = ė + λe, to be added to the reference acceleration."""
    return k.slope * de + k.gain * saturate((de + k.slope * e) * k.per_width)


@control.register(SMC)
def smc(
    k: SMC, memory: CommandFilterState, measured: Measured, reference: Reference
) -> tuple[Command, CommandFilterState]:
    """The whole controller at one sample."""
    state, target = measured.state, reference.trajectory
    e = euler_from_quaternion(state.attitude)
    feedback = switched_acceleration(k.position, target.position - state.position, target.velocity - state.velocity)
    u = limit_tilt(k.vehicle.tilt, wanted_force(k.vehicle, feedback, measured, reference))
    tracked, memory = tracked_attitude(k.vehicle, memory, e, u, reference)
    attitude_error = wrap_angle(tracked.angles - e.angles)
    rate_error = tracked.rates - euler_rates_from_rates(e, state.rates)
    angular_acceleration = tracked.accelerations + switched_acceleration(k.attitude, attitude_error, rate_error)
    return command_from(k.vehicle, e, u, angular_acceleration, tracked.angles, measured), memory


def linear_surface(slope: Sequence[float], gain: Sequence[float], width: Sequence[float]) -> LinearSurface:
    """The gains of three axes by λ [1/s], K and Φ."""
    return LinearSurface(vec3(slope), vec3(gain), vec3(1.0 / w for w in width))


@register("smc", SMCSettings)
def start(s: SMCSettings, vehicle: Vehicle, step: float) -> tuple[SMC, CommandFilterState]:
    """Conventional sliding mode control: linear surfaces with a boundary layer (Slotine and Li)."""
    position, attitude = (linear_surface(*three) for three in position_and_attitude(s.slope, s.gain, s.boundary_layer))
    return SMC(controller_model(s, vehicle, step), position, attitude), LEVEL
