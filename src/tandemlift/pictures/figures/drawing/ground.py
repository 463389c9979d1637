"""The floor under a flight: where it is, and how high the soles of the feet are over it."""

from __future__ import annotations

from tandemlift.core.types import GRAVITY, Array
from tandemlift.flight.record import Flight
from tandemlift.parts.contact.feet import floor, standing_height
from tandemlift.parts.contact.ground_table import GroundTable
from tandemlift.parts.contact.hull import hull
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.figures.drawing.vehicle import body_to_world, true_mass


def floor_height(flight: Flight) -> float | None:
    """Height z of the floor [m], or None where there is none.

    A mission that does not give it means the height at which the vehicle stands on it at the start.
    """
    ground = GroundTable.model_validate(flight.mission.get("ground", {}))
    if ground.model == "none" or ground.height is not None:
        return ground.height if ground.model != "none" else None
    vehicle, mission, mass = Vehicle.from_mission(flight.mission), flight.mission, true_mass(flight)
    step, friction = mission["mission"]["step"], ground.friction
    shapes = hull(**vehicle.hull_shapes, mass=mass, inertia=vehicle.inertia, step=step)
    at_zero = floor(vehicle.soles, mass, vehicle.inertia, step, friction=friction, sinkage=ground.sinkage, hull=shapes)
    return mission["initial"]["position"][2] - standing_height(at_zero, mass * GRAVITY)


def clearance(flight: Flight, height: float) -> Array:
    """The height of the lowest sole (T) over a floor at a height [m]."""
    soles = Vehicle.from_mission(flight.mission).soles.reshape(-1, 3)
    below = body_to_world(flight["attitude"])[:, 2] @ soles.T
    return flight["position"][:, 2] + below.min(axis=1) - height
