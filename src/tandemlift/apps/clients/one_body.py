"""Quadrotors on one rigid body: the inner loops that they share, and one demand in place of several."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tandemlift import Vehicle
from tandemlift.apps.clients.cascade import Demand, InnerLoops, LoopGains
from tandemlift.apps.clients.setpoints import Vector

MARGIN = 0.1  # of the distance of quadrotors: targets that are nearer give no direction; chosen


def vector(values: np.ndarray) -> Vector:
    """Three numbers."""
    x, y, z = values.tolist()
    return x, y, z


def tilt(quaternion: Sequence[float]) -> float:
    """The angle of the body's z axis to the vertical [rad]."""
    _, x, y, _ = quaternion
    return math.acos(max(-1.0, 1.0 - 2.0 * (x * x + y * y)))


class LoopGroup:
    """Quadrotors that share inner loops and an allocation: all of a vehicle, or one.

    Attributes:
        members: their numbers.
        inner: their loops of attitude and rates.
        rotors: the place of their rotors among all.
    """

    def __init__(self, vehicle: Vehicle, gains: LoopGains, members: range, most: float) -> None:
        self.members, self.rotors = members, slice(4 * members.start, 4 * members.stop)
        self._effect = vehicle.effect[:, self.rotors].copy()
        if len(members) == 1:  # moments about its own centre, where its own sensors are
            x, y, _ = vehicle.lever_arms[members.start]
            self._effect[1:3] += [[-y], [x]]
        inertia = vehicle.inertia.diagonal() * len(members) / vehicle.count
        self.inner = InnerLoops(gains, vector(inertia), vector(np.abs(self._effect[1:]).sum(axis=1) * (0.5 * most)))
        self._inverses = dict[tuple[bool, ...], np.ndarray]()

    def thrusts(self, wrench: Sequence[float], turning: tuple[bool, ...], most: np.ndarray) -> np.ndarray:
        """Thrusts of least squares that give a wrench, within their limits, if quadrotors may turn their rotors or not.

        Moments come before lift, as in crazyflie-firmware, power_distribution.
        """
        if turning not in self._inverses:
            self._inverses[turning] = np.linalg.pinv(self._effect * np.repeat(turning, 4))
        thrusts, most = self._inverses[turning] @ wrench, most * np.repeat(turning, 4)
        over = max(float(np.max(thrusts - most, initial=0.0, where=most > 0.0)), 0.0)
        return np.clip(thrusts - over, 0.0, most)


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
    return Demand(thrust, roll, pitch, _yaw_through(aims, yaw) if len(aims) > 1 else yaw)


def _yaw_through(aims: Sequence[tuple[Sequence[float], Vector]], otherwise: float) -> float:
    """The yaw with which points of the body are nearest to their targets, in the plane (least squares).

    It is `otherwise` [rad] where targets are together, or lie such that no yaw is nearer.
    """
    arms, targets = (np.array(points)[:, :2] for points in zip(*aims, strict=True))
    (a, b), (x, y) = (arms - arms.mean(axis=0)).T, (targets - targets.mean(axis=0)).T
    sine, cosine = float(a @ y - b @ x), float(a @ x + b @ y)
    return math.atan2(sine, cosine) if math.hypot(sine, cosine) > MARGIN * float(a @ a + b @ b) else otherwise
