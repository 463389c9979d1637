"""Cascaded PID as in autopilots: position P → velocity PID → attitude P → rate PID.

Source: the multicopter cascade of PX4 (Meier, Honegger and Pollefeys, PX4, ICRA 2015, and its documentation);
anti-windup by back-calculation and derivative filter: Åström and Hägglund, Advanced PID Control, 2006, sections 3.3
and 3.5. Every stage is fed forward from the reference, so the feedback corrects only what remains.

The velocity integral is limited, and reduced by what the tilt limit takes off the force (back-calculation); the rate
integral is limited. No guarantee beyond that of a well-tuned cascade: each stage some three times as fast
as the one around it.

Tune from the inside: rates, attitude, velocity, position; integrals last.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import clip
from tandemlift.core.keys import NonNegative3, Positive3, Triple, key
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
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
    tracked_attitude,
    wanted_force,
)
from tandemlift.parts.controllers.interface import Command, Measured, control
from tandemlift.parts.controllers.registry import register
from tandemlift.parts.mechanics.rotation import euler_from_quaternion, limit_tilt, rates_from_euler_rates, wrap_angle
from tandemlift.parts.mechanics.vehicle import Vehicle


class PIDSettings(CascadeTable):
    """`[controller]`: settings of the cascaded PID: x, y, z in world axes; roll, pitch, yaw; rates in body axes."""

    filter_bandwidth: Bandwidth = key(13.5, "rad/s", ATTITUDE_FILTER, source=TUNED)
    position_p: Positive3 = key((4.36, 0.765, 2.26), "1/s", "desired velocity over the position error", source=TUNED)
    velocity_p: Positive3 = key((3.09, 3.11, 18.1), "1/s", "desired acceleration over the velocity error", source=TUNED)
    velocity_i: NonNegative3 = key((0.414, 0.279, 2.04), "1/s²", "integral gain of the velocity error", source=TUNED)
    velocity_d: NonNegative3 = key((0.0628, 0.039, 0.0138), "1", "derivative gain of the velocity error", source=TUNED)
    velocity_i_limit: NonNegative3 = key(
        (2.0, 2.0, 2.0), "m/s²", "largest acceleration from the velocity integral", source="chosen"
    )
    attitude_p: Positive3 = key((3.45, 0.173, 2.43), "1/s", "desired rates over the attitude error", source=TUNED)
    rate_p: Positive3 = key(
        (7.94, 20.5, 3.87), "1/s", "desired angular acceleration over the error of the rates", source=TUNED
    )
    rate_i: NonNegative3 = key((0.904, 1.93, 0.0707), "1/s²", "integral gain of the error of the rates", source=TUNED)
    rate_d: NonNegative3 = key((0.0191, 0.178, 0.0439), "1", "derivative gain of the error of the rates", source=TUNED)
    rate_i_limit: NonNegative3 = key(
        (2.0, 2.0, 0.3), "rad/s²", "largest angular acceleration from the integral of the rates", source="chosen"
    )
    derivative_bandwidth: Bandwidth = key(
        254.0, "rad/s", "bandwidth of the low-pass filter in both derivatives", source=TUNED
    )
    tracking: Bandwidth = key(
        2.0,
        "1/s",
        "anti-windup: rate at which the velocity integral follows what the tilt limit takes off (back-calculation)",
        source="chosen",
    )


class PIDGains(NamedTuple):
    """A PID of three axes; `integral` is of one step, `limit` is of what it adds up to."""

    proportional: Vec3
    integral: Vec3
    derivative: Vec3
    limit: Vec3
    smoothing: LowPass


class PIDStageState(NamedTuple):
    """Memory of a PID: the integral term, and the filtered error."""

    integral: Vec3
    error: LowPassState[Vec3]


class PID(NamedTuple):
    """Gains: the nominal vehicle, and the stages; `tracking` is of one step, over the mass."""

    vehicle: ControllerModel
    position: Vec3
    velocity: PIDGains
    attitude: Vec3
    rates: PIDGains
    tracking: Number


class PIDState(NamedTuple):
    """Memory: that of the attitude reference and of both PIDs."""

    shaped: CommandFilterState
    velocity: PIDStageState
    rates: PIDStageState


@law
def pid_step(k: PIDGains, memory: PIDStageState, error: Vec3) -> tuple[Vec3, PIDStageState]:
    """(P + I + D of an error, the new memory)."""
    integral = clip(memory.integral + error * k.integral, -k.limit, k.limit)
    smoothed = low_pass_step(k.smoothing, memory.error, error)
    return error * k.proportional + integral + smoothed.rate * k.derivative, PIDStageState(integral, smoothed)


@law
def back_calculated(memory: PIDStageState, excess: Vec3) -> PIDStageState:
    """The memory with its integral reduced by an excess (anti-windup by back-calculation)."""
    return PIDStageState(memory.integral - excess, memory.error)


@control.register(PID)
def pid(k: PID, memory: PIDState, measured: Measured, reference: Reference) -> tuple[Command, PIDState]:
    """The whole controller at one sample."""
    state, target = measured.state, reference.trajectory
    e = euler_from_quaternion(state.attitude)
    velocity_error = target.velocity + (target.position - state.position) * k.position - state.velocity
    feedback, velocity = pid_step(k.velocity, memory.velocity, velocity_error)
    force = wanted_force(k.vehicle, feedback, measured, reference)
    u = limit_tilt(k.vehicle.tilt, force)
    # the force that the tilt limit takes off must not wind the integral up
    velocity = back_calculated(velocity, (force - u) * k.tracking)
    tracked, shaped = tracked_attitude(k.vehicle, memory.shaped, e, u, reference)
    angle_rates = tracked.rates + wrap_angle(tracked.angles - e.angles) * k.attitude
    rate_feedback, rates = pid_step(k.rates, memory.rates, rates_from_euler_rates(e, angle_rates) - state.rates)
    angular_acceleration = tracked.accelerations + rate_feedback
    command = command_from(k.vehicle, e, u, angular_acceleration, tracked.angles, measured)
    return command, PIDState(shaped, velocity, rates)


@register("pid", PIDSettings)
def start(s: PIDSettings, vehicle: Vehicle, step: float) -> tuple[PID, PIDState]:
    """Cascaded PID: position P, velocity PID, attitude P, rate PID, with anti-windup."""
    smoothing = low_pass(s.derivative_bandwidth, step)

    def stage(p: Triple, i: Triple, d: Triple, limit: Triple) -> PIDGains:
        return PIDGains(vec3(p), vec3(i) * step, vec3(d), vec3(limit), smoothing)

    rest = PIDStageState(ZERO, LowPassState(ZERO, ZERO))
    gains = PID(
        vehicle=controller_model(s, vehicle, step),
        position=vec3(s.position_p),
        velocity=stage(s.velocity_p, s.velocity_i, s.velocity_d, s.velocity_i_limit),
        attitude=vec3(s.attitude_p),
        rates=stage(s.rate_p, s.rate_i, s.rate_d, s.rate_i_limit),
        tracking=s.tracking * step / vehicle.mass,
    )
    return gains, PIDState(LEVEL, rest, rest)
