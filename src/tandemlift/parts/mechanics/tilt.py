"""Virtual inputs: the force that the position law commands, and the thrust and tilt that produce it."""

from typing import NamedTuple

from tandemlift.core.algebra.law import choice, law
from tandemlift.core.algebra.ops import atan_ratio, cos, maximum, minimum, sin, sqrt, tan, where
from tandemlift.core.algebra.types import Number
from tandemlift.core.algebra.vector import Absent, Vec3
from tandemlift.parts.mechanics.rotation import Euler


class TiltZXY(NamedTuple):
    """The exact inverse for Z-X-Y angles at the actual yaw."""


class TiltPrinted(NamedTuple):
    """The inverse as the paper prints it (that of Z-Y-X angles), at the desired yaw."""


class TiltLimit(NamedTuple):
    """The tangent of the largest angle between the force and the vertical."""

    tangent: Number


@choice(absent="u")
def limit_tilt(limit: TiltLimit | Absent, u: Vec3) -> Vec3:
    """The force (u_x, u_y, u_z) [N, world axes], its horizontal part shortened to stay within a tilt limit."""


@limit_tilt.register(TiltLimit)
def _tilted(limit: TiltLimit, u: Vec3) -> Vec3:
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
