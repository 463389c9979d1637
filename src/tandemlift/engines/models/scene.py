"""The view of a mission for an engine: the body, its start, and its surroundings, without the pilot."""

from __future__ import annotations

from typing import Any, Protocol

from tandemlift.core.caching import cached
from tandemlift.core.vector import Absent
from tandemlift.parts.contact.corridor import WallTable
from tandemlift.parts.contact.feet import Floor
from tandemlift.parts.contact.standing import GroundTable, floor_under
from tandemlift.parts.contact.walls import Walls, walls
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable, PlantTable, VehicleTable


class Timing(Protocol):
    """Name of the flight, and its time step [s]."""

    name: str
    step: float


class Scene(Protocol):
    """The tables of a mission that an engine reads; every `Mission` is one."""

    vehicle: VehicleTable
    initial: InitialTable
    plant: PlantTable
    disturbance: DisturbanceTable
    ground: GroundTable

    @property
    def mission(self) -> Timing:
        """Name and step."""

    @property
    def all_walls(self) -> tuple[WallTable, ...]:
        """Every wall."""


def floor_from(scene: Scene, vehicle: Vehicle) -> Any:
    """The floor of a scene, or `Absent`."""
    return Absent() if scene.ground.model == "none" else feet_and_floor_from(scene, vehicle)


def feet_and_floor_from(scene: Scene, vehicle: Vehicle) -> Floor:
    """The floor of a scene, its feet and its hull, even if `ground.model` is "none"."""
    start = scene.initial.position[2] if scene.ground.height is None else 0.0
    return floor_under(vehicle, scene.ground, scene.plant.mass_scale, scene.mission.step, start)


def walls_from(scene: Scene, vehicle: Vehicle) -> Walls | Absent:
    """The contact shapes and parameters for a mission's walls, or `Absent` without walls."""
    return wall_contact_from(scene, vehicle) if scene.all_walls else Absent()


def wall_contact_from(scene: Scene, vehicle: Vehicle) -> Walls:
    """The contact shapes and parameters for walls, even if the mission has none."""
    return _walls(vehicle, scene.ground.friction, scene.plant.mass_scale, scene.mission.step)


@cached
def _walls(vehicle: Vehicle, friction: float, mass_scale: float, step: float) -> Walls:
    return walls(vehicle, vehicle.mass * mass_scale, step, friction)
