"""The parts of the vehicle: one quadrotor, the payload, the joints between them, and the quadrotors' places.

Forces F_i and couples τ_i are the load of quadrotor i on the payload, reduced to the quadrotor's centre of mass; F_i in
world axes, τ_i, rates and lever arms d_i (payload centre to quadrotor) in body axes, which all parts share.
"""

from typing import NamedTuple

from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import Mat3, Vec3, apply, apply_transposed, cross
from tandemlift.parts.mechanics.rigid_body import UP, Inertia, apply_inertia, gyroscopic


class Point(NamedTuple):
    """Motion of a point of the vehicle, world axes: position [m], velocity [m/s], acceleration [m/s²]."""

    position: Vec3
    velocity: Vec3
    acceleration: Vec3


class Acceleration(NamedTuple):
    """Linear acceleration [m/s², world axes] and angular acceleration [rad/s², body axes]."""

    linear: Vec3
    angular: Vec3


class Joint(NamedTuple):
    """Load of a quadrotor on the payload: force [N, world axes] and couple [N·m, body axes]."""

    force: Vec3
    couple: Vec3


@law
def point_on_body(origin: Point, R: Mat3, rates: Vec3, angular: Vec3, d: Vec3) -> Point:
    """Motion of the point at d (body axes) from `origin` on a rigid body, `rates` and `angular` in body axes.

    Erratum: the paper prints ω × d in world axes without R.
    """
    # paper: kinematic_equ
    return Point(
        origin.position + apply(R, d),
        origin.velocity + apply(R, cross(rates, d)),
        origin.acceleration + apply(R, cross(angular, d) + cross(rates, cross(rates, d))),
    )


@law
def quadrotor_acceleration(
    mass: Number, J: Vec3, z_axis: Vec3, thrust: Number, torque: Vec3, rates: Vec3, joint: Joint
) -> Acceleration:
    """Acceleration of one quadrotor under the reaction of its joint. `z_axis`: R (0, 0, 1)."""
    # paper: trans_rot_quad_equ
    linear = (z_axis * thrust - joint.force) / mass - UP * GRAVITY
    angular = torque + gyroscopic(J, rates) - joint.couple
    return Acceleration(linear, angular / J)


@law
def joint_wrench(
    mass: Number, J: Inertia, z_axis: Vec3, thrust: Number, torque: Vec3, rates: Vec3, a: Acceleration
) -> Joint:
    """trans_rot_quad_equ solved for F_i and τ_i, given the quadrotor's acceleration."""
    force = z_axis * thrust - (a.linear + UP * GRAVITY) * mass
    couple = torque + gyroscopic(J, rates) - apply_inertia(J, a.angular)
    return Joint(force, couple)


@law
def joint_on_payload(R: Mat3, d: Vec3, joint: Joint) -> Joint:
    """The joint's force, and its moment about the payload's centre: τ_i + d_i × RᵀF_i.

    Erratum: the paper prints d_i × F_i with F_i in world axes.
    """
    # paper: trans_rot_payload_equ
    return Joint(joint.force, joint.couple + cross(d, apply_transposed(R, joint.force)))


@law
def payload_acceleration(mass: Number, J: Vec3, rates: Vec3, total: Joint) -> Acceleration:
    """Acceleration of the payload under the sum of `joint_on_payload` over its quadrotors."""
    # paper: trans_rot_payload_equ
    return Acceleration(total.force / mass - UP * GRAVITY, (total.couple + gyroscopic(J, rates)) / J)
