"""Redundant measurements are compared over a window: attitude, position and velocity, each with its integrated rate.

The rotation by gyroscope and by attitude, the displacement by velocity and by position, the change of velocity by
accelerometer and by velocity must agree. With ε the difference between two of them from one motion sample to the next,
d ← λ d + ε forgets over the window τ = T / (1 − λ): a jump shows in full, a constant error b as b τ.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, maximum, where
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import Quat, Vec3, apply, dot
from tandemlift.parts.mechanics.rigid_body import UP
from tandemlift.parts.mechanics.rotation import rotated_by, rotation_between, rotation_from_quaternion
from tandemlift.parts.sensors.readings import ImuReading, MotionReading


class Inconsistency(NamedTuple):
    """Memory of the differences of redundant measurements: attitude [rad, body axes], position [m], velocity [m/s].

    It also holds the values to compare with the next motion sample: the integrals of the rates, the velocity and the
    acceleration since the last one.
    """

    attitude: Vec3
    position: Vec3
    velocity: Vec3
    integrated_attitude: Quat
    integrated_position: Vec3
    integrated_velocity: Vec3


@law
def inconsistency_after(
    forgetting: Number, m: Inconsistency, imu: ImuReading, v: MotionReading, invalid: Number, dt: Number
) -> Inconsistency:
    """The differences after a step of dt [s]; `forgetting` is 1 − λ.

    While a measurement is `invalid` (1), nothing is compared.
    """
    attitude, position = rotated_by(m.integrated_attitude, imu.rates * dt), m.integrated_position + v.velocity * dt
    acceleration = apply(rotation_from_quaternion(v.attitude), imu.specific_force) - UP * GRAVITY
    velocity = m.integrated_velocity + acceleration * dt
    restart = maximum(v.fresh, invalid)
    keep = (1.0 - forgetting * v.fresh) * (1.0 - invalid)
    compared = v.fresh * (1.0 - invalid)
    return Inconsistency(
        attitude=m.attitude * keep + rotation_between(attitude, v.attitude) * compared,
        position=m.position * keep + (v.position - position) * compared,
        velocity=m.velocity * keep + (v.velocity - velocity) * compared,
        integrated_attitude=chosen(restart, v.attitude, attitude),
        integrated_position=chosen(restart, v.position, position),
        integrated_velocity=chosen(restart, v.velocity, velocity),
    )


@law
def exceeds(difference: Vec3, tolerance: Number) -> Number:
    """1 if a difference is larger than the tolerance, else 0."""
    return where(dot(difference, difference) > tolerance * tolerance, 1.0, 0.0)
