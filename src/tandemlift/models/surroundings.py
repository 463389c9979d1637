"""Floor and walls of a mission with their contact parameters, for laws and simulators."""

from __future__ import annotations

from typing import Any

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.vector import Nothing
from tandemlift.laws.contact.floor import Floor, floor, sole_positions, standing_height
from tandemlift.laws.contact.hull import Hull, hull
from tandemlift.laws.contact.spheres import rotor_spheres
from tandemlift.laws.contact.walls import Walls, walls
from tandemlift.settings import Mission
from tandemlift.vehicle import Vehicle


def floor_from(mission: Mission, vehicle: Vehicle) -> Any:
    """The floor of a mission, or `Nothing`."""
    return Nothing() if mission.ground.model == "none" else feet_and_floor_from(mission, vehicle)


def feet_and_floor_from(mission: Mission, vehicle: Vehicle) -> Floor:
    """The floor of a mission and the contact parameters of the feet, even if `ground.model` is "none"."""
    g = mission.ground
    fleet, mass, step = vehicle.quadrotors, vehicle.mass * mission.plant.mass_scale, mission.mission.step
    soles = sole_positions(vehicle.lever_arms, [q.feet_spread for q in fleet], [q.feet_depth for q in fleet])
    shapes = hull_from(mission, vehicle)
    at_zero = floor(soles, mass, vehicle.inertia, step, friction=g.friction, sinkage=g.sinkage, hull=shapes)
    if g.height is not None:
        return at_zero._replace(height=g.height)
    return at_zero._replace(height=mission.initial.position[2] - standing_height(at_zero, mass * GRAVITY))


def hull_from(mission: Mission, vehicle: Vehicle) -> Hull:
    """The shapes of the vehicle's parts that meet the floor besides its feet."""
    fleet = vehicle.quadrotors
    return hull(
        vehicle.lever_arms,
        rotor_hubs_of(vehicle),
        [q.rotor_radius for q in fleet],
        [q.guard_radius for q in fleet],
        vehicle.mass * mission.plant.mass_scale,
        vehicle.inertia,
        mission.mission.step,
        beam=beam_of(vehicle),
        payload=-vehicle.center_of_mass,
    )


def rotor_hubs_of(vehicle: Vehicle) -> list[list[tuple[float, float, float]]]:
    """The hubs of every quadrotor's rotors from its centre of mass [m, body axes]."""
    return [[(x, y, q.rotor_height) for x, y in q.rotors] for q in vehicle.quadrotors]


def beam_of(vehicle: Vehicle) -> tuple[float, float] | None:
    """Length and radius [m] of a payload that is a beam, else None."""
    payload = vehicle.payload
    return (payload.length, payload.radius) if payload.length is not None and payload.radius is not None else None


def walls_from(mission: Mission, vehicle: Vehicle) -> Any:
    """The contact shapes and parameters for a mission's walls, or `Nothing` without walls."""
    return wall_contact_from(mission, vehicle) if mission.all_walls else Nothing()


def wall_contact_from(mission: Mission, vehicle: Vehicle) -> Walls:
    """The contact shapes and parameters for walls, even if the mission has none."""
    fleet, hubs = vehicle.quadrotors, rotor_hubs_of(vehicle)
    guards = [q.guard_radius for q in fleet]
    return walls(
        vehicle.lever_arms,
        guards,
        vehicle.mass * mission.plant.mass_scale,
        vehicle.inertia,
        mission.mission.step,
        friction=mission.ground.friction,
        rotors=rotor_spheres(vehicle.lever_arms, hubs, [q.rotor_radius for q in fleet], guards),
        beam=beam_of(vehicle),
        payload=-vehicle.center_of_mass,
    )
