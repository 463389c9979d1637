"""Geometric tracking control on SE(3): the attitude error is formed of rotation matrices, not of Euler angles.

Source: Lee, Leok and McClamroch, Geometric tracking control of a quadrotor UAV on SE(3), CDC 2010:

    f = A · R e₃,   A = m (ẍ_d + k_x e + k_v ė + g e₃),   b₃ = A/|A|,   b₂ ∥ b₃ × b₁d,   b₁ = b₂ × b₃,
    e_R = ½ (R_dᵀR − RᵀR_d)^∨,   e_Ω = Ω − RᵀR_d Ω_d,
    M = −k_R e_R − k_Ω e_Ω + Ω × JΩ − J (Ω^ RᵀR_d Ω_d − RᵀR_d Ω̇_d).

Here e = desired − actual in position, as everywhere; k_R and k_Ω multiply the inertia, because a beam's differs between
axes by a factor of 50. A passes a command filter before R_d is formed, which gives Ω_d and Ω̇_d without differences. The
first axis b₁d points along the reference yaw, which makes R_d that of the Z-X-Y angles.

Without filter and limits the tracking error vanishes exponentially, from attitudes within 90° of the desired one, and
attitude errors do from almost everywhere (proven there with one k_R for all axes).

Tune first: k_R and k_Ω against the rotors' lag, then k_x and k_v.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import atan2, atan_ratio, cos, maximum, sin, sqrt
from tandemlift.core.keys import Positive3, key
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.trajectories import Reference
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import ZERO, Mat3, Vec3, apply_transposed, cross, dot, vec3
from tandemlift.parts.controllers.cascade import (
    TUNED,
    Bandwidth,
    CascadeTable,
    ControllerModel,
    controller_model,
    wanted_force,
    wanted_moment,
)
from tandemlift.parts.controllers.interface import Command, Measured, control
from tandemlift.parts.controllers.registry import register
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.mechanics.rotation import limit_tilt, rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

MIN_UPWARD = 0.1  # of the weight: smallest upward component of the force that R_d points along


class GeometricSettings(CascadeTable):
    """`[controller]`: settings of geometric tracking control: position in world axes, attitude in body axes."""

    filter_bandwidth: Bandwidth = key(
        14.0, "rad/s", "bandwidth of the command filter of the desired force", source=TUNED
    )
    position_stiffness: Positive3 = key((5.35, 2.83, 40.0), "1/s²", "k_x/m, along x, y, z", source=TUNED)
    position_damping: Positive3 = key((3.34, 2.75, 20.5), "1/s", "k_v/m, along x, y, z", source=TUNED)
    attitude_stiffness: Positive3 = key((24.9, 26.8, 5.41), "1/s²", "k_R/J, about body x, y, z", source=TUNED)
    attitude_damping: Positive3 = key((14.3, 19.6, 2.57), "1/s", "k_Ω/J, about body x, y, z", source=TUNED)


class Geometric(NamedTuple):
    """Gains: the nominal vehicle, the four gains, the filter of A; `min_upward`: smallest A_z [N]."""

    vehicle: ControllerModel
    position_stiffness: Vec3
    position_damping: Vec3
    attitude_stiffness: Vec3
    attitude_damping: Vec3
    filter: LowPass
    bandwidth: Number
    min_upward: Number


class Derivatives(NamedTuple):
    """A vector with its first and second derivative over time."""

    value: Vec3
    rate: Vec3
    acceleration: Vec3


class AttitudeTrajectory(NamedTuple):
    """An attitude R_d, its rates Ω_d [rad/s] and Ω̇_d [rad/s²], both in its own axes. `columns`: R_dᵀ."""

    columns: Mat3
    rates: Vec3
    accelerations: Vec3


@law
def unit_vector(a: Derivatives) -> Derivatives:
    """The unit vector along a, with its derivatives."""
    inverse = 1.0 / sqrt(maximum(dot(a.value, a.value), 1e-12))
    b = a.value * inverse
    growth = dot(b, a.rate)
    rate = (a.rate - b * growth) * inverse
    more = dot(rate, a.rate) + dot(b, a.acceleration)
    return Derivatives(b, rate, (a.acceleration - b * more - rate * (2.0 * growth)) * inverse)


@law
def cross_product(a: Derivatives, b: Derivatives) -> Derivatives:
    """a × b, with its derivatives."""
    rate = cross(a.rate, b.value) + cross(a.value, b.rate)
    twice = cross(a.rate, b.rate) * 2.0
    return Derivatives(
        cross(a.value, b.value), rate, cross(a.acceleration, b.value) + twice + cross(a.value, b.acceleration)
    )


@law
def heading_vector(yaw: Number, rate: Number, acceleration: Number) -> Derivatives:
    """b₁d = (cos ψ, sin ψ, 0), with its derivatives."""
    c, s = cos(yaw), sin(yaw)
    ahead, aside = Vec3(c, s, 0.0), Vec3(-s, c, 0.0)
    return Derivatives(ahead, aside * rate, aside * acceleration - ahead * (rate * rate))


@law
def attitude_from_force(force: Derivatives, b1d: Derivatives) -> AttitudeTrajectory:
    """R_d whose third axis is along the force and whose second is normal to b₁d, with Ω_d and Ω̇_d."""
    b3 = unit_vector(force)
    b2 = unit_vector(cross_product(b3, b1d))
    b1 = cross_product(b2, b3)
    rates = Vec3(dot(b3.value, b2.rate), dot(b1.value, b3.rate), dot(b2.value, b1.rate))  # Ṙ = R Ω^
    accelerations = Vec3(
        dot(b3.rate, b2.rate) + dot(b3.value, b2.acceleration),
        dot(b1.rate, b3.rate) + dot(b1.value, b3.acceleration),
        dot(b2.rate, b1.rate) + dot(b2.value, b1.acceleration),
    )
    return AttitudeTrajectory(Mat3(b1.value, b2.value, b3.value), rates, accelerations)


@law
def attitude_error(R: Mat3, columns: Mat3) -> Vec3:
    """e_R = ½ (R_dᵀR − RᵀR_d)^∨, from R and R_dᵀ: for a rotation by α about an axis n, n sin α."""
    x, y, z = Vec3(R.x.x, R.y.x, R.z.x), Vec3(R.x.y, R.y.y, R.z.y), Vec3(R.x.z, R.y.z, R.z.z)
    d = columns
    return Vec3(dot(d.z, y) - dot(d.y, z), dot(d.x, z) - dot(d.z, x), dot(d.y, x) - dot(d.x, y)) * 0.5


@law
def zxy_angles(columns: Mat3) -> Vec3:
    """The Z-X-Y angles [rad] of R_d, for the record: the law does not use them."""
    b1, b2, b3 = columns.x, columns.y, columns.z
    roll = atan_ratio(b2.z, sqrt(maximum(b2.x * b2.x + b2.y * b2.y, 1e-12)))
    return Vec3(roll, atan2(-b1.z, b3.z), atan2(-b2.x, b2.y))


@law
def wanted_angular_acceleration(k: Geometric, R: Mat3, rates: Vec3, desired: AttitudeTrajectory) -> Vec3:
    """The commanded angular acceleration [rad/s², body axes] for an attitude error."""
    desired_rates = apply_transposed(R, apply_transposed(desired.columns, desired.rates))  # RᵀR_d Ω_d
    feedforward = apply_transposed(R, apply_transposed(desired.columns, desired.accelerations))
    feedback = k.attitude_stiffness * attitude_error(R, desired.columns) + k.attitude_damping * (rates - desired_rates)
    return feedforward - cross(rates, desired_rates) - feedback


@law
def filtered_force(k: Geometric, memory: LowPassState[Vec3], u: Vec3) -> tuple[Derivatives, LowPassState[Vec3]]:
    """(the filtered force [N] with its derivatives, the new memory)."""
    w, up = k.bandwidth, Vec3(u.x, u.y, maximum(u.z, k.min_upward))
    acceleration = (up - memory.value) * (w * w) - memory.rate * (2.0 * w)
    return Derivatives(memory.value, memory.rate, acceleration), low_pass_step(k.filter, memory, up)


@control.register(Geometric)
def geometric(
    k: Geometric, memory: LowPassState[Vec3], measured: Measured, reference: Reference
) -> tuple[Command, LowPassState[Vec3]]:
    """The whole controller at one sample."""
    state, target = measured.state, reference.trajectory
    position_error, velocity_error = target.position - state.position, target.velocity - state.velocity
    feedback = k.position_stiffness * position_error + k.position_damping * velocity_error
    u = limit_tilt(k.vehicle.tilt, wanted_force(k.vehicle, feedback, measured, reference))
    force, memory = filtered_force(k, memory, u)
    b1d = heading_vector(reference.yaw, reference.yaw_rate, reference.yaw_acceleration)
    desired, R = attitude_from_force(force, b1d), rotation_from_quaternion(state.attitude)
    moment = wanted_moment(k.vehicle, wanted_angular_acceleration(k, R, state.rates, desired), measured)
    # the thrust follows u at once, along the actual axis; only the attitude waits for the filter
    return Command(Wrench(dot(u, Vec3(R.x.z, R.y.z, R.z.z)), moment), zxy_angles(desired.columns)), memory


@register("geometric", GeometricSettings)
def start(s: GeometricSettings, vehicle: Vehicle, step: float) -> tuple[Geometric, LowPassState[Vec3]]:
    """Geometric tracking control on SE(3), on rotation matrices (Lee, Leok and McClamroch)."""
    weight = vehicle.mass * GRAVITY
    gains = Geometric(
        vehicle=controller_model(s, vehicle, step),
        position_stiffness=vec3(s.position_stiffness),
        position_damping=vec3(s.position_damping),
        attitude_stiffness=vec3(s.attitude_stiffness),
        attitude_damping=vec3(s.attitude_damping),
        filter=low_pass(s.filter_bandwidth, step),
        bandwidth=s.filter_bandwidth,
        min_upward=MIN_UPWARD * weight,
    )
    return gains, LowPassState(Vec3(0.0, 0.0, weight), ZERO)
