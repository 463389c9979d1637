"""What quadrotors on one rigid body have in common: its rotation, and one demand in place of several."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tandemlift.apps.clients.cascade import Demand
from tandemlift.apps.clients.setpoints import Vector


def vector(values: np.ndarray) -> Vector:
    """Three numbers."""
    x, y, z = values.tolist()
    return x, y, z


def rotation(quaternion: np.ndarray) -> np.ndarray:
    """The rotation matrix (3 × 3), body to world, of a unit quaternion (w, x, y, z)."""
    w, x, y, z = quaternion.tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def tilt(quaternion: Sequence[float]) -> float:
    """The angle of the body's z axis to the vertical [rad]."""
    _, x, y, _ = quaternion
    return math.acos(max(-1.0, 1.0 - 2.0 * (x * x + y * y)))


def together(demands: Sequence[Demand], arms: Sequence[Sequence[float]]) -> Demand:
    """One demand on the body: all thrusts; rates if all ask for rates, else the mean attitude; `arms`: of each [m]."""
    thrust = sum(d.thrust for d in demands)
    rates = [d.rates for d in demands if d.rates is not None]
    if len(rates) == len(demands):
        x, y, z = (sum(along) / len(rates) for along in zip(*rates, strict=True))
        return Demand(thrust, rates=(x, y, z))
    level = [d for d in demands if d.rates is None]
    roll, pitch = sum(d.roll for d in level) / len(level), sum(d.pitch for d in level) / len(level)
    yaw = math.atan2(sum(math.sin(d.yaw) for d in level), sum(math.cos(d.yaw) for d in level))
    aims = [(arm, d.target) for arm, d in zip(arms, demands, strict=True) if d.target is not None]
    return Demand(thrust, roll, pitch, _yaw_through(aims) if len(aims) > 1 else yaw)


def _yaw_through(aims: Sequence[tuple[Sequence[float], Vector]]) -> float:
    """The yaw with which points of the body are nearest to their targets, in the plane (least squares)."""
    arms, targets = (np.array(points)[:, :2] for points in zip(*aims, strict=True))
    (a, b), (x, y) = (arms - arms.mean(axis=0)).T, (targets - targets.mean(axis=0)).T
    return math.atan2(float(a @ y - b @ x), float(a @ x + b @ y))
