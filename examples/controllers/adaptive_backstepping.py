"""Adaptive backstepping on position, PD on attitude.

With e₁ = x − x_d and e₂ = ė₁ + c₁ e₁, the acceleration u and a constant unknown one δ, so that
ẍ = u + δ along each axis,

    u = ẍ_d − c₁ ė₁ − c₂ e₂ − e₁ − δ̂,    δ̂' = γ e₂, held within a limit (projection),

make V = (e₁² + e₂² + (δ − δ̂)²/γ)/2 fall by V̇ = −c₁ e₁² − c₂ e₂²: the errors vanish, for any γ.
Attitude, rotors and the pilot's own observer are not in the proof. M. Krstić, I. Kanellakopoulos
and P. Kokotović, Nonlinear and Adaptive Control Design, Wiley, 1995, chapters 3 and 4.

    tandemlift compare iris --controllers nftsmc,pid,examples/controllers/adaptive_backstepping.py
"""

from typing import NamedTuple

import tandemlift.parts.controllers as tc
from tandemlift.core.algebra import Number, Vec3, clip, law, vec3
from tandemlift.core.keys import Positive, Positive3, key


class Settings(tc.CascadeTable):
    """`[controller]`: one number for all axes, or three."""

    position_decay: Positive3 = key((1.5, 1.5, 4.0), "1/s", "decay c₁ of the position error")
    backstepping_decay: Positive3 = key(
        (1.5, 1.5, 4.0), "1/s", "decay c₂ of the backstepping error"
    )
    adaptation: Positive3 = key((0.5, 0.5, 2.0), "1/s²", "rate γ of the adaptation")
    limit: Positive = key(2.0, "m/s²", "largest acceleration δ̂ that is adapted to")
    attitude_bandwidth: Positive3 = key(
        (6.0, 6.0, 3.0), "rad/s", "bandwidth of the attitude loop, critically damped"
    )


class Gains(NamedTuple):
    """The parameters of the law; `step` [s]."""

    vehicle: tc.ControllerModel
    c1: Vec3
    c2: Vec3
    adaptation: Vec3
    limit: Number
    attitude: Vec3
    step: Number


class Memory(NamedTuple):
    """The memory of the attitude reference, and δ̂ [m/s²]."""

    shaped: tc.CommandFilterState
    estimate: Vec3


@law
def backstepping(k: Gains, estimate: Vec3, e1: Vec3, de1: Vec3) -> tuple[Vec3, Vec3]:
    """(u − ẍ_d, δ̂') for the error e₁ and its rate."""
    e2 = de1 + k.c1 * e1
    return -(k.c1 * de1) - k.c2 * e2 - e1 - estimate, k.adaptation * e2


@tc.control.register(Gains)
def adaptive_backstepping(k, memory, measured, reference):
    """A thrust and three moments from the measured state and the reference."""
    state, desired, w = measured.state, reference.trajectory, k.attitude
    e1, de1 = state.position - desired.position, state.velocity - desired.velocity
    feedback, rate = backstepping(k, memory.estimate, e1, de1)
    estimate = clip(memory.estimate + rate * k.step, -k.limit, k.limit)
    force = tc.limit_tilt(k.vehicle.tilt, tc.wanted_force(k.vehicle, feedback, measured, reference))
    angles = tc.euler_from_quaternion(state.attitude)
    tilt, shaped = tc.tracked_attitude(k.vehicle, memory.shaped, angles, force, reference)
    error = tc.wrap_angle(tilt.angles - angles.angles)
    rate_error = tilt.rates - tc.euler_rates_from_rates(angles, state.rates)
    alpha = tilt.accelerations + error * w * w + rate_error * w * 2.0
    command = tc.command_from(k.vehicle, angles, force, alpha, tilt.angles, measured)
    return command, Memory(shaped, estimate)


@tc.register("adaptive-backstepping", Settings)
def start(s, vehicle, step):
    """Adaptive backstepping on position, PD on attitude."""
    gains = Gains(
        tc.controller_model(s, vehicle, step),
        vec3(s.position_decay),
        vec3(s.backstepping_decay),
        vec3(s.adaptation),
        s.limit,
        vec3(s.attitude_bandwidth),
        step,
    )
    return gains, Memory(tc.LEVEL, vec3([0.0, 0.0, 0.0]))
