"""The vehicle that flew: its masses, its attitudes as rotation matrices, and its outline as lines."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.types import GRAVITY, Array
from tandemlift.core.vector import Quat
from tandemlift.flight.record import Flight
from tandemlift.parts.contact.surroundings import floor_height_of
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle, mixer


def body_to_world(attitude: Array) -> Array:
    """R (…, 3, 3) from body axes to world axes, of unit quaternions w, x, y, z (…, 4)."""
    rows = rotation_from_quaternion(Quat(*np.moveaxis(attitude, -1, 0)))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def true_mass(flight: Flight) -> float:
    """Mass [kg] of the vehicle that flew."""
    return Vehicle.from_mission(flight.mission).mass * flight.mission.get("plant", {}).get("mass_scale", 1.0)


def true_weight(flight: Flight) -> float:
    """Weight [N] of the vehicle that flew."""
    return true_mass(flight) * GRAVITY


def true_payload_mass(flight: Flight) -> float:
    """Mass [kg] of the real payload, which has the whole difference from the pilot's model."""
    return true_mass(flight) - sum(q.mass for q in Vehicle.from_mission(flight.mission).quadrotors)


CORNERS = 24  # of the polygon that stands for a rotor's disc


class Skeleton(NamedTuple):
    """Points of a vehicle [m]: `struts` (N, 2, 3), `arms` (4N, 2, 3), `rotors` (4N, corners, 3).

    `beam` (n, 3): the payload's `outline`; a single point if it has no shape.
    """

    beam: Array
    struts: Array
    arms: Array
    rotors: Array

    def placed(self, position: Array, attitude: Array) -> Skeleton:
        """The skeleton with its centre of mass at a position (3) [m, world] and a unit quaternion w, x, y, z (4)."""
        R = body_to_world(attitude)
        return Skeleton(*(points @ R.T + position for points in self))

    def width(self, points: float) -> float:
        """Width of the payload's lines [points]: as given for the axis of a beam, thinner for the edges of a body."""
        return points if len(self.beam) <= 2 else 0.3 * points

    @property
    def points(self) -> Array:
        """All points (n, 3) [m]."""
        points = np.concatenate([part.reshape(-1, 3) for part in self])
        return points[np.isfinite(points).all(axis=1)]


def skeleton(vehicle: Vehicle) -> Skeleton:
    """The skeleton of a vehicle, in body axes about the system's centre of mass."""
    origin, outline = vehicle.origin, vehicle.payload.outline
    low, high = np.nanmin(outline, axis=0), np.nanmax(outline, axis=0)
    struts, arms, rotors = [], [], []
    turn = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(CORNERS)])
    for quadrotor, center in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        nearest = origin + np.clip(quadrotor.position, low, high)
        struts.append([nearest, center])
        _, roll, pitch, _ = mixer(quadrotor)
        for hub in center + np.column_stack([-pitch, roll, np.zeros(4)]):  # a rotor's levers are where it stands
            arms.append([center, hub])
            rotors.append(hub + quadrotor.rotor_radius * circle)
    return Skeleton(origin + outline, np.array(struts), np.array(arms), np.array(rotors))


def floor_height(flight: Flight) -> float | None:
    """Height z of the floor [m], or None where there is none."""
    return floor_height_of(Vehicle.from_mission(flight.mission), flight.mission)
