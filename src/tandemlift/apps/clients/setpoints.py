"""Setpoints that a client sends, and the state that it reads: SI units; world z up, body x ahead, y left, z up.

A quaternion is (w, x, y, z), body to world. Roll, pitch and yaw are about x, y and z, right-handed: R = Rz(yaw)
Ry(pitch) Rx(roll), so a positive pitch lowers the nose. Protocols with other signs convert at their border.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)


class QuadrotorState(NamedTuple):
    """The state of one quadrotor at its own centre of mass.

    Attributes:
        time: since the start of the flight [s].
        position: [m, world].
        velocity: [m/s, world].
        quaternion: of the attitude, body to world.
        rates: [rad/s, body].
        specific_force: what its accelerometer measures: (0, 0, 9.81) at rest [m/s², body].
        thrusts: commanded to its four rotors [N].
    """

    time: float
    position: Vector
    velocity: Vector
    quaternion: Quaternion
    rates: Vector
    specific_force: Vector
    thrusts: tuple[float, ...]

    @property
    def euler(self) -> Vector:
        """Roll, pitch and yaw [rad]."""
        return euler_of(self.quaternion)


class EstimateError(NamedTuple):
    """The error of a quadrotor's own estimate: a rotation [rad, body], rates [rad/s, body], a position [m, world]."""

    rotation: Vector = ZERO
    rates: Vector = ZERO
    position: Vector = ZERO

    def of(self, s: QuadrotorState) -> QuadrotorState:
        """The estimate of a state; the rotation is small."""
        w, x, y, z = s.quaternion
        a, b, c = (0.5 * angle for angle in self.rotation)
        q = (w - x * a - y * b - z * c, x + w * a + y * c - z * b, y + w * b + z * a - x * c, z + w * c + x * b - y * a)
        size = math.hypot(*q)
        return s._replace(
            position=plus(s.position, self.position),
            quaternion=(q[0] / size, q[1] / size, q[2] / size, q[3] / size),
            rates=plus(s.rates, self.rates),
        )


class AttitudeSetpoint(NamedTuple):
    """Roll and pitch [rad], a thrust of this quadrotor [N], and a yaw [rad] or, if that is None, its rate [rad/s].

    With a `height` [m, world] that is held instead of the thrust.
    """

    roll: float
    pitch: float
    thrust: float
    yaw: float | None = None
    yaw_rate: float = 0.0
    height: float | None = None


class RateSetpoint(NamedTuple):
    """Rates [rad/s, body] and a thrust of this quadrotor [N]."""

    rates: Vector
    thrust: float


class VelocitySetpoint(NamedTuple):
    """A velocity [m/s], in world axes or, with `heading`, along the quadrotor's heading; yaw or its rate as above.

    With a `height` [m, world] that is held instead of the vertical velocity.
    """

    velocity: Vector
    yaw: float | None = None
    yaw_rate: float = 0.0
    height: float | None = None
    heading: bool = False


class PositionSetpoint(NamedTuple):
    """A position [m, world] and a yaw [rad], or None to keep the yaw."""

    position: Vector
    yaw: float | None = None


class FullStateSetpoint(NamedTuple):
    """A point of a trajectory: position [m], velocity [m/s] and acceleration [m/s²] in world axes, and yaw [rad]."""

    position: Vector
    velocity: Vector
    acceleration: Vector
    yaw: float = 0.0


class Stop(NamedTuple):
    """The rotors stand still."""


Setpoint = AttitudeSetpoint | RateSetpoint | VelocitySetpoint | PositionSetpoint | FullStateSetpoint | Stop


def plus(a: Vector, b: Vector) -> Vector:
    """The sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def euler_of(q: Quaternion) -> Vector:
    """Roll, pitch and yaw of a unit quaternion [rad]."""
    w, x, y, z = q
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))
    return roll, pitch, math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def mean_attitude(states: Sequence[QuadrotorState]) -> QuadrotorState:
    """The first of some states that differ little, with the mean of all quaternions and rates."""
    w, x, y, z = (sum(along) for along in zip(*(s.quaternion for s in states), strict=True))
    p, q, r = (sum(along) / len(states) for along in zip(*(s.rates for s in states), strict=True))
    size = math.hypot(w, x, y, z)
    return states[0]._replace(quaternion=(w / size, x / size, y / size, z / size), rates=(p, q, r))


def is_finite(setpoint: Setpoint) -> bool:
    """Whether all numbers of a setpoint are finite."""
    numbers = (n for value in setpoint if value is not None for n in (value if isinstance(value, tuple) else (value,)))
    return all(map(math.isfinite, numbers))
