"""Distances of a logged flight from the walls, and where the person holds the payload."""

from __future__ import annotations

import numpy as np

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.parts.contact.surroundings import WallDistances, wall_distances
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.vehicle import body_to_world


def clearances(flight: Flight) -> WallDistances:
    """Distance of guards and payload from the nearest wall."""
    vehicle = Vehicle.from_mission(flight.mission)
    return wall_distances(vehicle, flight.walls, flight["position"], flight["attitude"])


def grips(flight: Flight) -> Array | None:
    """The place at which the person of [person] holds the payload (T, 3) [m, world axes], or None without one."""
    person = flight.mission.get("person", {"model": "none"})
    if person["model"] in ("none", "virtual-hand"):
        return None
    along = 0.0 if person["model"] == "two-hands" else person["grip"]
    arm = np.array([0.0, along, 0.0]) + Vehicle.from_mission(flight.mission).origin
    return flight["position"] + body_to_world(flight["attitude"]) @ arm
