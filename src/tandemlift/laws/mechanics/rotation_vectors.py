"""Finite turns of an attitude: by a rotation vector in body axes, and the turn that is left between two attitudes.

A rotation vector is an axis times an angle [rad]. Source: Shuster, A survey of attitude representations, 1993.
"""

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import cos, maximum, sin, sqrt, where
from tandemlift.algebra.vector import Quat, Vec3, dot, hamilton

TINY = 1e-300  # keeps the derivative of a norm finite at 0, where it leaves every value as it is


@law
def quaternion_of_turn(turn: Vec3) -> Quat:
    """The unit quaternion of a rotation vector [rad]; exactly 1 for none."""
    half = turn * 0.5
    angle = sqrt(maximum(dot(half, half), TINY))
    axis = half * (sin(angle) / angle)
    return Quat(cos(angle), axis.x, axis.y, axis.z)


@law
def turned(attitude: Quat, turn: Vec3) -> Quat:
    """An attitude turned by a rotation vector [rad] in its own body axes."""
    return hamilton(attitude, quaternion_of_turn(turn))


@law
def turn_left(start: Quat, end: Quat) -> Vec3:
    """The turn from one attitude to another, in the body axes of `start`: its axis times 2 sin(angle/2) [rad].

    For small angles it is the rotation vector, to the third order; it grows with the angle up to half a turn, and
    always goes the short way round.
    """
    d = hamilton(Quat(start.w, -start.x, -start.y, -start.z), end)
    return Vec3(d.x, d.y, d.z) * where(d.w < 0.0, -2.0, 2.0)


@law
def normalised(q: Quat) -> Quat:
    """q scaled to unit norm."""
    return q * (1.0 / sqrt(maximum(dot(q, q), TINY)))
