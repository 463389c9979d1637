"""Attitude: rotation matrix, quaternion, Z-X-Y Euler angles and their rates, rotation vectors.

The last laws turn a force that the position law commands into a thrust and a tilt (the paper's virtual inputs).

R = Rz(ψ) Rx(φ) Ry(θ) maps body axes to world axes. The Euler rates are singular at roll φ = ±90°, not at pitch. A
rotation vector is an axis times an angle [rad]. Source: Shuster, A survey of attitude representations, 1993.
"""

from typing import NamedTuple

from tandemlift.core.algebra import absolute, atan2, atan_ratio, clip, cos, maximum, minimum, sin, sqrt, tan, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent, Mat3, Quat, Vec3, dot, hamilton

PI = 3.141592653589793
TINY = 1e-300  # keeps the derivative of a norm finite at 0, where it leaves every value as it is


class Euler(NamedTuple):
    """Euler angles with the cosines and sines that the laws need, from the attitude without trigonometry."""

    angles: Vec3  # φ, θ, ψ [rad]
    cos_roll: Number
    sin_roll: Number
    cos_pitch: Number
    sin_pitch: Number
    cos_yaw: Number
    sin_yaw: Number
    sec_roll: Number


@elementwise
def wrap_angle(angle: Number) -> Number:
    """The same angle within [−π, π], for angles within [−3π, 3π] [rad]."""
    return angle - where(angle > PI, 2.0 * PI, where(angle < -PI, -2.0 * PI, 0.0))


def heading_from(angle: Number) -> Number:
    """The same angle within [−π, π], for any angle [rad]."""
    return where(absolute(angle) > PI, atan2(sin(angle), cos(angle)), angle)


@law
def rotation_from_euler(angles: Vec3) -> Mat3:
    """R from φ, θ, ψ [rad]."""
    # paper: R_equ
    cf, ct, cp = cos(angles.x), cos(angles.y), cos(angles.z)
    sf, st, sp = sin(angles.x), sin(angles.y), sin(angles.z)
    return Mat3(
        Vec3(ct * cp - sf * st * sp, -cf * sp, st * cp + sf * ct * sp),
        Vec3(ct * sp + sf * st * cp, cf * cp, st * sp - sf * ct * cp),
        Vec3(-cf * st, sf, cf * ct),
    )


@law
def quaternion_from_euler(angles: Vec3) -> Quat:
    """The unit quaternion of Rz(ψ) Rx(φ) Ry(θ), angles in rad."""
    half = angles * 0.5
    roll = Quat(cos(half.x), sin(half.x), 0.0, 0.0)
    pitch = Quat(cos(half.y), 0.0, sin(half.y), 0.0)
    yaw = Quat(cos(half.z), 0.0, 0.0, sin(half.z))
    return hamilton(hamilton(yaw, roll), pitch)


@law
def rotation_from_quaternion(q: Quat) -> Mat3:
    """R of a unit quaternion."""
    return Mat3(
        Vec3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y - q.w * q.z), 2.0 * (q.x * q.z + q.w * q.y)),
        Vec3(2.0 * (q.x * q.y + q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z - q.w * q.x)),
        Vec3(2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y)),
    )


@law
def sine_of_roll(q: Quat) -> Number:
    """sin φ, the third row and second column of R."""
    return 2.0 * (q.y * q.z + q.w * q.x)


@law
def body_z_axis(q: Quat) -> Vec3:
    """The body z axis (the direction of thrust) in world axes: R (0, 0, 1)."""
    return Vec3(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))


@law
def world_z_in_body(q: Quat) -> Vec3:
    """The world's z axis in body axes: Rᵀ (0, 0, 1), the third row of R."""
    return Vec3(2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))


@law
def euler_from_quaternion(q: Quat) -> Euler:
    """Z-X-Y Euler angles of a unit quaternion, φ in [−90°, 90°]. Inverse of R_equ."""
    R12 = 2.0 * (q.x * q.y - q.w * q.z)
    R22 = 1.0 - 2.0 * (q.x * q.x + q.z * q.z)
    R31 = 2.0 * (q.x * q.z - q.w * q.y)
    R33 = 1.0 - 2.0 * (q.x * q.x + q.y * q.y)
    sin_roll = clip(sine_of_roll(q), -1.0, 1.0)
    cos_roll = sqrt(maximum(1.0 - sin_roll * sin_roll, 1e-12))
    sec = 1.0 / cos_roll
    angles = Vec3(atan_ratio(sin_roll, cos_roll), atan2(-R31, R33), atan2(-R12, R22))
    return Euler(angles, cos_roll, sin_roll, R33 * sec, -R31 * sec, R22 * sec, -R12 * sec, sec)


@law
def rates_from_euler_rates(e: Euler, euler_rates: Vec3) -> Vec3:
    """Body rates (p, q, r) from (φ̇, θ̇, ψ̇), rad/s."""
    # paper: omegat_theta_equ
    return Vec3(
        e.cos_pitch * euler_rates.x - e.cos_roll * e.sin_pitch * euler_rates.z,
        euler_rates.y + e.sin_roll * euler_rates.z,
        e.sin_pitch * euler_rates.x + e.cos_roll * e.cos_pitch * euler_rates.z,
    )


@law
def euler_rates_from_rates(e: Euler, rates_body: Vec3) -> Vec3:
    """(φ̇, θ̇, ψ̇) from body rates, rad/s: the inverse of omegat_theta_equ, singular at φ = ±90°."""
    yaw_rate = (e.cos_pitch * rates_body.z - e.sin_pitch * rates_body.x) * e.sec_roll
    return Vec3(e.cos_pitch * rates_body.x + e.sin_pitch * rates_body.z, rates_body.y - e.sin_roll * yaw_rate, yaw_rate)


@law
def quaternion_rate(q: Quat, rates_body: Vec3) -> Quat:
    """q̇ = ½ q (0, ω), ω in body axes [rad/s]."""
    w = rates_body
    return (
        Quat(
            -(q.x * w.x + q.y * w.y + q.z * w.z),
            q.w * w.x + q.y * w.z - q.z * w.y,
            q.w * w.y + q.z * w.x - q.x * w.z,
            q.w * w.z + q.x * w.y - q.y * w.x,
        )
        * 0.5
    )


@law
def quaternion_from_rotation_vector(turn: Vec3) -> Quat:
    """The unit quaternion of a rotation vector [rad]; exactly 1 for the zero vector."""
    half = turn * 0.5
    angle = sqrt(maximum(dot(half, half), TINY))
    axis = half * (sin(angle) / angle)
    return Quat(cos(angle), axis.x, axis.y, axis.z)


@law
def rotated_by(attitude: Quat, turn: Vec3) -> Quat:
    """An attitude rotated by a rotation vector [rad] in its own body axes."""
    return hamilton(attitude, quaternion_from_rotation_vector(turn))


@law
def rotation_between(start: Quat, end: Quat) -> Vec3:
    """The rotation from one attitude to another, in the body axes of `start`: its axis times 2 sin(angle/2) [rad].

    For small angles it is the rotation vector, to the third order. It grows with the angle up to 180°, and
    always takes the shorter way.
    """
    d = hamilton(Quat(start.w, -start.x, -start.y, -start.z), end)
    return Vec3(d.x, d.y, d.z) * where(d.w < 0.0, -2.0, 2.0)


@law
def normalised(q: Quat) -> Quat:
    """q scaled to unit norm."""
    return q * (1.0 / sqrt(maximum(dot(q, q), TINY)))


class TiltZXY(NamedTuple):
    """The exact inverse for Z-X-Y angles at the actual yaw."""


class TiltPrinted(NamedTuple):
    """The inverse as the paper prints it (that of Z-Y-X angles), at the desired yaw."""


class TiltLimit(NamedTuple):
    """The tangent of the largest angle between the force and the vertical."""

    tangent: Number


@law(absent="u")
def limit_tilt(limit: TiltLimit, u: Vec3) -> Vec3:
    """The force (u_x, u_y, u_z) [N, world axes], its horizontal part shortened to stay within a tilt limit."""
    horizontal = sqrt(maximum(u.x * u.x + u.y * u.y, 1e-24))
    fraction = minimum(limit.tangent * maximum(u.z, 0.0) / horizontal, 1.0)
    return Vec3(u.x * fraction, u.y * fraction, u.z)


def tilt_limit(angle: float | None) -> TiltLimit | Absent:
    """The limit of a tilt [rad]; `Absent` for no limit."""
    return Absent() if angle is None else TiltLimit(tan(angle))


@law
def virtual_inputs(e: Euler, thrust: Number) -> Vec3:
    """(u_x, u_y, u_z) = R (0, 0, U₁) [N, world axes]."""
    # paper: vertual_cont_equ
    return (
        Vec3(
            e.sin_pitch * e.cos_yaw + e.sin_roll * e.cos_pitch * e.sin_yaw,
            e.sin_pitch * e.sin_yaw - e.sin_roll * e.cos_pitch * e.cos_yaw,
            e.cos_roll * e.cos_pitch,
        )
        * thrust
    )


@law
def total_thrust(e: Euler, u: Vec3) -> Number:
    """U₁ = u_z / (cos φ cos θ) [N]."""
    # paper: thrus_z_equ
    return u.z / (e.cos_roll * e.cos_pitch)


@choice
def desired_orientation(inverse: TiltZXY | TiltPrinted, u: Vec3, e: Euler, yaw: Number) -> Vec3:
    """(φ_d, θ_d, ψ_d) [rad] that points the thrust along u [N, world axes]; e is the actual attitude, yaw is ψ_d."""


@law
def tilt_angles(first: Number, second: Number, u_z: Number) -> tuple[Number, Number]:
    """(atan(first/u_z), atan(cos(that) · second/u_z)) [rad], without dividing by u_z."""
    h = sqrt(u_z * u_z + first * first)
    return atan_ratio(first, u_z), atan_ratio(second, where(u_z < 0.0, -h, h))


@desired_orientation.register(TiltZXY)
def _zxy(inverse: TiltZXY, u: Vec3, e: Euler, yaw: Number) -> Vec3:
    # paper: equ_des_orient, corrected: φ_d = atan(Q/u_z) first, then θ_d = atan(cos φ_d · A/u_z)
    A = u.x * e.cos_yaw + u.y * e.sin_yaw
    Q = u.x * e.sin_yaw - u.y * e.cos_yaw
    roll, pitch = tilt_angles(Q, A, u.z)
    return Vec3(roll, pitch, yaw)


@desired_orientation.register(TiltPrinted)
def _printed(inverse: TiltPrinted, u: Vec3, e: Euler, yaw: Number) -> Vec3:
    # paper: equ_des_orient, as printed: θ_d = atan(A/u_z) first, then φ_d = atan(cos θ_d · Q/u_z), at ψ_d
    A = u.x * cos(yaw) + u.y * sin(yaw)
    Q = u.x * sin(yaw) - u.y * cos(yaw)
    pitch, roll = tilt_angles(A, Q, u.z)
    return Vec3(roll, pitch, yaw)
