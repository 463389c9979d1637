"""The places of all parts of a flight at any time: the vehicle, its path, the push, the walls and the floor."""

from __future__ import annotations

from typing import Any

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.types import GRAVITY, Array
from tandemlift.core.vector import Quat
from tandemlift.engines.models.visuals import vehicle_shapes
from tandemlift.flight.record import Flight
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion, world_z_in_body
from tandemlift.parts.mechanics.vehicle import Vehicle

ARROW, STUB = 0.9, 0.18  # m, length of the arrow for the strongest push of the flight, and for the faintest
RATIO, SHARE = 0.03, 0.0015  # fractions of the strongest push, and of the weight: a push below is not drawn


class FlightStage:
    """A flight as it is drawn.

    Attributes:
        time: of the samples that can be drawn [s].
        name: of the flight.
        path: of the centre of mass at these times (T, 3) [m].
        floor: height z of the floor [m].
        vehicle: the vehicle of the flight.
        reach: largest distance of a part of the vehicle from its centre of mass [m].
        walls: tables of the mission's walls.

    Raises:
        InputError: the flight has no sample that can be drawn.
    """

    def __init__(self, flight: Flight) -> None:
        # a diverged flight may end with NaN, or with quaternions that are not unit ones
        unit = np.abs(np.linalg.norm(flight["attitude"], axis=1) - 1.0) < 0.01
        sound = unit & (np.abs(flight["position"]) < 1e4).all(axis=1)
        if not sound.any():
            raise InputError(f"flight {flight.name!r} has no sample that can be drawn")
        self.name, self.time = flight.name, flight.time[sound]
        self.path, self._attitudes = flight["position"][sound], _continuous(flight["attitude"][sound])
        self._pushes, self._moments = flight["push_force"][sound], flight["push_moment"][sound]
        self._strongest = float(np.linalg.norm(self._pushes, axis=1).max())
        self.vehicle = Vehicle.from_mission(flight.mission)
        self._faintest = max(RATIO * self._strongest, SHARE * GRAVITY * self.vehicle.mass)
        self.reach = max(float(np.linalg.norm(s.position)) + max(s.size) / 2.0 for s in vehicle_shapes(self.vehicle))
        self.floor = self._floor_of(flight.mission, self.vehicle)
        self.walls = flight.walls

    def _floor_of(self, mission: dict[str, Any], vehicle: Vehicle) -> float:
        """Height of the floor [m]; where the mission gives none, that of the lowest foot."""
        ground = mission.get("ground", {})
        standing = ground.get("model", "none") != "none"
        if standing and ground.get("height") is not None:
            return float(ground["height"])
        shown = slice(0, 1) if standing else slice(None)
        unit = self._attitudes[shown] / np.linalg.norm(self._attitudes[shown], axis=1)[:, None]
        up = np.stack(world_z_in_body(Quat(*unit.T)), axis=1)
        return float((self.path[shown, 2, None] + up @ vehicle.soles.reshape(-1, 3).T).min())

    def _at(self, time: float, values: Array) -> Array:
        """Values (n) of a channel (T, n), interpolated at a time [s]."""
        return np.array([np.interp(time, self.time, column) for column in values.T])

    def rotation(self, time: float) -> Array:
        """The vehicle's rotation (3 × 3) from body to world axes at a time [s]."""
        return _rotation(self._at(time, self._attitudes))

    def position(self, time: float) -> Array:
        """Position of the centre of mass (3) [m] at a time [s]."""
        return self._at(time, self.path)

    @property
    def strongest_push_time(self) -> float:
        """Time of the strongest push, or the end of a flight without a push to show [s]."""
        strength = np.linalg.norm(self._pushes, axis=1)
        return float(self.time[strength.argmax() if self.is_push_shown(self._strongest) else -1])

    def checked_time(self, what: str, time: float) -> float:
        """The given time [s], if it lies within the flight.

        Raises:
            InputError: it lies outside of the flight; the message calls it `what`.
        """
        if not self.time[0] <= time <= self.time[-1]:
            raise InputError(f"{what} {time:g} s is outside of the flight, {self.time[0]:g} s to {self.time[-1]:g} s")
        return time

    def push(self, time: float) -> Array:
        """The person's force (3) [N] at a time [s]."""
        return self._at(time, self._pushes)

    def is_push_shown(self, strength: float) -> bool:
        """Whether a push of this strength [N] is large enough to be drawn."""
        return strength > self._faintest

    def arrow(self, time: float) -> tuple[Array, Array] | None:
        """Start (3) and tip (3) [m] of the arrow that shows the push at a time [s]; None without a push to show."""
        force = self.push(time)
        size = float(np.linalg.norm(force))
        if not self.is_push_shown(size):
            return None
        R = self.rotation(time)
        # the point nearest to the centre of mass on the force's line of action
        arm = np.cross(R.T @ force, self._at(time, self._moments)) / size**2
        start = self.position(time) + R @ arm
        return start, start + max(ARROW * size / self._strongest, STUB) * force / size


def _rotation(attitude: Array) -> Array:
    """R (3 × 3) of a quaternion w, x, y, z."""
    return np.array(rotation_from_quaternion(Quat(*map(float, attitude / np.linalg.norm(attitude)))))


def _continuous(attitudes: Array) -> Array:
    """Quaternions (T, 4) with signs such that they are continuous over time."""
    turned = (attitudes[1:] * attitudes[:-1]).sum(axis=1) < 0.0
    return attitudes * np.where(np.concatenate([[0], np.cumsum(turned)]) % 2, -1.0, 1.0)[:, None]
