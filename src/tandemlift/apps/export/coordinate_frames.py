"""Frames of an exported flight: their names, and transformation of vectors, for all samples at once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Mat3, Quat, Vec3, apply, apply_transposed
from tandemlift.parts.mechanics.rotation import euler_from_quaternion, quaternion_from_euler, rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

WORLD, BASE, ALIGNED, PAYLOAD = "world", "base_link", "base_world", "payload"


class Frame(NamedTuple):
    """A frame: its name, parent, origin and axes."""

    name: str
    parent: str
    origin: str
    axes: str


FRAMES = (
    Frame(WORLD, "", "the mission's", "inertial, z up"),
    Frame(BASE, WORLD, "centre of mass of the vehicle", "body: x forward, y left along the beam, z up (ROS REP 103)"),
    Frame(ALIGNED, WORLD, "centre of mass of the vehicle", "as `world`: for forces in world axes"),
    Frame(PAYLOAD, BASE, "the payload's origin, the middle of a beam", "body"),
    Frame("joint_1", BASE, "joint of that quadrotor on the payload; `joint_2` and so on likewise", "body"),
)


def fixed(vehicle: Vehicle) -> Iterator[tuple[str, Array]]:
    """The frames that are fixed in `base_link`, with their origins (3) [m], body axes."""
    yield PAYLOAD, 0.0 + vehicle.origin
    for i, quadrotor in enumerate(vehicle.quadrotors, 1):
        yield joint(i), vehicle.origin + np.array(quadrotor.joint_position)


def joint(number: int) -> str:
    """The frame at the joint of a quadrotor, from 1."""
    return f"joint_{number}"


def _rotation(attitude: Array) -> Mat3:
    """R of quaternions (T, 4), as a matrix of arrays (T); those of another norm, as sensors give them, are scaled."""
    with np.errstate(invalid="ignore"):
        return rotation_from_quaternion(Quat(*(attitude / np.linalg.norm(attitude, axis=1, keepdims=True)).T))


def to_world(attitude: Array, vectors: Array) -> Array:
    """Vectors (T, 3) of body axes in world axes, by the attitude (T, 4), quaternions w, x, y, z."""
    return np.stack(apply(_rotation(attitude), Vec3(*vectors.T)), axis=1)


def to_body(attitude: Array, vectors: Array) -> Array:
    """Vectors (T, 3) of world axes in body axes, by the attitude (T, 4), quaternions w, x, y, z."""
    return np.stack(apply_transposed(_rotation(attitude), Vec3(*vectors.T)), axis=1)


def quaternions(euler: Array) -> Array:
    """Quaternions w, x, y, z (T, 4) of roll, pitch, yaw (T, 3) [rad]."""
    return np.stack(quaternion_from_euler(Vec3(*euler.T)), axis=1)


def eulers(attitude: Array) -> Array:
    """Roll, pitch, yaw (T, 3) [rad] of quaternions w, x, y, z (T, 4)."""
    return np.stack(euler_from_quaternion(Quat(*attitude.T)).angles, axis=1)
