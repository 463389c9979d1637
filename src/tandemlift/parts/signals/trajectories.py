"""The reference of the position controller: the admittance's trajectory, with lift and landing.

x_d, y_d = T_r; z_d = (T_r,z + height · q(lift)) (1 − q(land)), with exact derivatives, where q is the quintic
smoothstep 10 s³ − 15 s⁴ + 6 s⁵ on [0, 1].
"""

from typing import NamedTuple

from tandemlift.core.algebra.law import law
from tandemlift.core.algebra.ops import clip
from tandemlift.core.algebra.types import Number
from tandemlift.core.algebra.vector import ZERO, Vec3


class Trajectory(NamedTuple):
    """A point's position [m], velocity [m/s] and acceleration [m/s²], world axes."""

    position: Vec3
    velocity: Vec3
    acceleration: Vec3


class Reference(NamedTuple):
    """The reference to be tracked.

    The centre of mass's trajectory in world axes; the yaw ψ_d [rad], its rate [rad/s] and acceleration [rad/s²]; and
    `lead`: the predicted change of the trajectory's acceleration [m/s²] until the vehicle responds, zero if unknown.
    """

    trajectory: Trajectory
    yaw: Number
    yaw_rate: Number = 0.0
    yaw_acceleration: Number = 0.0
    lead: Vec3 = ZERO


class ScheduledPhases(NamedTuple):
    """Lift to `height` [m] from `lift_start` [s], land from `land_start`; rates are 1/duration [1/s], 0 for never."""

    height: Number
    lift_start: Number
    lift_rate: Number
    land_start: Number
    land_rate: Number


class SmoothStep(NamedTuple):
    """A smooth step from 0 to 1 with its first and second time derivatives."""

    value: Number
    rate: Number
    curvature: Number


@law
def smoothstep(t: Number, start: Number, rate: Number) -> SmoothStep:
    """q((t − start) rate) and its time derivatives [1/s, 1/s²]."""
    s = clip((t - start) * rate, 0.0, 1.0)
    return SmoothStep(
        s * s * s * (10.0 - s * (15.0 - 6.0 * s)),
        30.0 * s * s * (1.0 - s) * (1.0 - s) * rate,
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) * rate * rate,
    )


@law
def reference(p: ScheduledPhases, T: Trajectory, t: Number) -> Trajectory:
    """The desired trajectory of the centre of mass at time t [s], world axes."""
    lift = smoothstep(t, p.lift_start, p.lift_rate)
    land = smoothstep(t, p.land_start, p.land_rate)
    z = T.position.z + p.height * lift.value
    dz = T.velocity.z + p.height * lift.rate
    ddz = T.acceleration.z + p.height * lift.curvature
    up = 1.0 - land.value
    return Trajectory(
        Vec3(T.position.x, T.position.y, z * up),
        Vec3(T.velocity.x, T.velocity.y, dz * up - z * land.rate),
        Vec3(T.acceleration.x, T.acceleration.y, ddz * up - 2.0 * dz * land.rate - z * land.curvature),
    )
