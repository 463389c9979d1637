"""Floor and walls of a mission with their contact parameters, for laws and simulators."""

from __future__ import annotations

from typing import Any

from tandemlift.core.caching import cached
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import Absent
from tandemlift.engines.models.scene import Scene
from tandemlift.parts.contact.feet import Floor, floor, standing_height
from tandemlift.parts.contact.ground_table import GroundTable
from tandemlift.parts.contact.hull import hull
from tandemlift.parts.contact.spheres import rotor_spheres
from tandemlift.parts.contact.walls import Walls, walls
from tandemlift.parts.mechanics.vehicle import Vehicle


def floor_from(scene: Scene, vehicle: Vehicle) -> Any:
    """The floor of a scene, or `Absent`."""
    return Absent() if scene.ground.model == "none" else feet_and_floor_from(scene, vehicle)


def feet_and_floor_from(scene: Scene, vehicle: Vehicle) -> Floor:
    """The floor of a scene, its feet and its hull, even if `ground.model` is "none"."""
    start = scene.initial.position[2] if scene.ground.height is None else 0.0
    return _floor(vehicle, scene.ground, scene.plant.mass_scale, scene.mission.step, start)


@cached
def _floor(vehicle: Vehicle, g: GroundTable, mass_scale: float, step: float, start: float) -> Floor:
    """The floor under a vehicle; unless its height is given, the vehicle stands on it with its centre at `start`."""
    mass = vehicle.mass * mass_scale
    shapes = hull(**vehicle.hull_shapes, mass=mass, inertia=vehicle.inertia, step=step)
    at_zero = floor(vehicle.soles, mass, vehicle.inertia, step, friction=g.friction, sinkage=g.sinkage, hull=shapes)
    if g.height is not None:
        return at_zero._replace(height=g.height)
    return at_zero._replace(height=start - standing_height(at_zero, mass * GRAVITY))


def walls_from(scene: Scene, vehicle: Vehicle) -> Walls | Absent:
    """The contact shapes and parameters for a mission's walls, or `Absent` without walls."""
    return wall_contact_from(scene, vehicle) if scene.all_walls else Absent()


def wall_contact_from(scene: Scene, vehicle: Vehicle) -> Walls:
    """The contact shapes and parameters for walls, even if the mission has none."""
    return _walls(vehicle, scene.ground.friction, scene.plant.mass_scale, scene.mission.step)


@cached
def _walls(vehicle: Vehicle, friction: float, mass_scale: float, step: float) -> Walls:
    fleet, hubs = vehicle.quadrotors, vehicle.rotor_hubs
    guards = [q.guard_radius for q in fleet]
    return walls(
        vehicle.lever_arms,
        guards,
        vehicle.mass * mass_scale,
        vehicle.inertia,
        step,
        friction=friction,
        rotors=rotor_spheres(vehicle.lever_arms, hubs, [q.rotor_radius for q in fleet], guards),
        beam=vehicle.beam,
        bodies=vehicle.payload.hulls,
        payload=vehicle.origin,
    )
