"""Vehicles at places among walls, and what the laws say of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from law_values import BEAM, paper_vehicle, quadrotor
from scipy.optimize import lsq_linear

from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.wall_geometry import Wall, wall
from tandemlift.parts.contact.walls import Walls, near_wall_loads, nearest_with, no_walls_near, walls
from tandemlift.parts.mechanics.joint_loads import PartLoads, PartsLayout
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle

LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
LENGTH, RADIUS, GUARD = 2.0, 0.05, 0.375
STEP = 0.001
PARTS = (Vec3, Vec3, Quat, Vec3)  # of a state


def walls_of(
    vehicle: Vehicle, friction: float = 0.4, guard: float = GUARD, radius: float | None = RADIUS, **more: Any
) -> Walls:
    """Walls about spheres of a radius in place of the quadrotors, and a beam of a radius or none."""
    spheres = {"guard_radius": guard, "arm": 1e-3, "rotor_radius": 1e-3}  # rotors are in their guard
    beam = {"length": LENGTH, "radius": radius, "inertia": vehicle.payload.moments}
    shaped = Vehicle(
        vehicle.payload.model_copy(update=beam), [q.model_copy(update=spheres) for q in vehicle.quadrotors]
    )
    return walls(shaped, vehicle.mass, STEP, friction, **more)


def found(w: Walls, table: Any, frame: PartsLayout, s: State) -> Any:
    """What is near, of all walls."""
    near = no_walls_near(w)
    for one in table:
        near = nearest_with(w, one, near, frame, s)
    return near


def pressed(w: Walls, table: Any, vehicle: Vehicle, s: State) -> PartLoads:
    frame = parts_layout_from(vehicle)
    return near_wall_loads(w, found(w, table, frame, s), frame, s)


def polygon(points: Any, top: float = 9.0) -> list[Wall]:
    return [wall(a, b, top) for a, b in zip(points, [*points[1:], points[0]], strict=True)]


def at(position: Any, velocity: Any = (0.0, 0.0, 0.0), attitude: Quat = LEVEL, rates: Vec3 = ZERO) -> State:
    return State(vec3(position), vec3(velocity), attitude, rates)


def one_quadrotor() -> Vehicle:
    """A quadrotor with its payload at its centre of mass: a sphere to the walls."""
    return Vehicle(BEAM, [quadrotor((0.0, 0.0, 0.0))])


SINGLE, PAIR = one_quadrotor(), paper_vehicle()
FLAT = Vehicle(BEAM, [quadrotor((0.0, 1.0, 0.0)), quadrotor((0.0, -1.0, 0.0))])  # all centres at one height


def random_wall(rng: np.random.Generator, size: float = 1.0) -> Wall:
    return wall(*rng.uniform(-size, size, (2, 2)), rng.uniform(-size, size))


def nearest(p: np.ndarray, columns: Any, bounds: Any) -> float:
    """The least |p + columns x| with x within bounds."""
    low, high = np.transpose(bounds)
    return float(np.sqrt(2.0 * lsq_linear(np.transpose(columns), -p, (low, high), method="bvls", tol=1e-14).cost))
