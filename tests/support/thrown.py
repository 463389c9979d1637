"""Vehicles without thrust, thrown on a floor and among walls: motion by machine code, energy by NumPy."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from law_values import record
from machine_code import Loop
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.compiler.machine_code.machine import QUICK
from tandemlift.core.caching import LastUsed
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Absent, Quat, each, total, vec3
from tandemlift.engines.compiled import advance, plant_from
from tandemlift.engines.compiled_contact import CompiledPlant, hull_contact_with
from tandemlift.engines.touches import wall_contact_with
from tandemlift.missions import Mission
from tandemlift.parts.contact.feet import start_foot_grip
from tandemlift.parts.contact.wall_geometry import wall
from tandemlift.parts.contact.walls import nearest_with, no_walls_near
from tandemlift.parts.mechanics.push import CentralPush, PushSamples
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle

NO_PUSH = PushSamples(*[CentralPush(ZERO)] * 3)
START = State(vec3([0.0, 0.0, 2.0]), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)


class Thrown(NamedTuple):
    """What a step passes to the next."""

    state: State
    grip: Any


class World(NamedTuple):
    """What stays: the body with floor and walls, all walls, and nothing near."""

    plant: CompiledPlant
    table: Any
    nowhere: Any


class Given(NamedTuple):
    """The length of a step [s]."""

    step: Any


class StepSample(NamedTuple):
    """State and grip at the start of a step; sums of the normal forces of the floor on the hull, and of walls [N]."""

    state: State
    grip: Any
    hull: Any
    walls: Any


@law
def near_now(world: World, s: State) -> Any:
    near = world.nowhere
    for one in world.table:
        near = nearest_with(world.plant.walls, one, near, world.plant.frame, s)
    return near


def pressure(contact: Any) -> Any:
    """The sum of all normal forces of a contact [N]."""
    if hasattr(contact, "normal"):
        return total(contact.normal) if isinstance(contact.normal, tuple) else contact.normal
    return sum(pressure(part) for part in contact) if isinstance(contact, tuple) else 0.0


def step_of(world: World, x: Thrown, given: Given) -> Any:
    plant, s = world.plant, x.state
    near, rotors = near_now(world, s), 4 * len(plant.frame.mass)
    still = each(rotors)(*[0.0] * rotors)
    moved = advance(plant, s, Absent(), x.grip, near, still, Absent(), NO_PUSH, given.step)
    on_hull, on_walls = hull_contact_with(plant.floor, s), wall_contact_with(plant.walls, near, plant.frame, s)
    return StepSample(s, x.grip, pressure(on_hull), pressure(on_walls)), Thrown(moved.state, moved.grip)


class ThrownFlight:
    """A flight of a vehicle without thrust, one row a step, and its energies by NumPy.

    Attributes:
        hull, walls: the sum of normal forces of the floor on everything but feet, and of walls [N].
    """

    def __init__(self, rows: np.ndarray, plant: CompiledPlant, mass: float, inertia: np.ndarray) -> None:
        self.plant, self.mass, self.inertia = plant, mass, inertia
        self.position, self.velocity, attitude, self.rates = np.split(rows[:, :13], [3, 6, 10], axis=1)
        self.R = Rotation.from_quat(attitude, scalar_first=True).as_matrix()
        self.anchors = rows[:, 13:-2].reshape(len(rows), 4, 3, -1)[:, :, :2]
        self.hull, self.walls = rows[:, -2], rows[:, -1]

    @property
    def kinetic(self) -> np.ndarray:
        turning = np.einsum("ti,ij,tj->t", self.rates, self.inertia, self.rates)
        return 0.5 * self.mass * (self.velocity**2).sum(1) + 0.5 * turning

    @property
    def feet(self) -> np.ndarray:
        """Energy of the feet's springs [J]."""
        floor = self.plant.floor
        places = self.position[:, None, :, None] + np.einsum("tab,jbn->tjan", self.R, np.array(floor.feet))
        depth = np.maximum(floor.radius + floor.height - places[:, :, 2], 0.0)
        stretch = places[:, :, :2] - self.anchors
        springs = floor.stiffness * (depth**2).sum((1, 2))
        return 0.5 * (springs + floor.tangential_stiffness * (stretch**2).sum((1, 2, 3)))

    @property
    def depths(self) -> np.ndarray:
        """How deep every rotor, guard and end of the beam is in the floor [m]: its lowest point, found by its rim."""
        floor, found = self.plant.floor, []
        for shape in (floor.hull.rotors, floor.hull.guards, floor.hull.beam):
            centers = self.position[:, :, None] + np.einsum("tab,bn->tan", self.R, np.array(shape.center))
            r, c = np.array(shape.radius), np.array(shape.half_thickness)
            half = np.stack([r, r, c])  # of an ellipsoid whose matrix is R diag(half²) Rᵀ
            below = np.sqrt(np.einsum("tb,bn->tn", self.R[:, 2] ** 2, half**2))
            found.append(floor.height - centers[:, 2] + below)
        return np.hstack(found)

    @property
    def energy(self) -> np.ndarray:
        """Kinetic, of weight and of all springs on the floor [J]; those of walls are left out."""
        springs = 0.5 * self.plant.floor.hull.stiffness * (np.maximum(self.depths, 0.0) ** 2).sum(1)
        return self.kinetic + self.mass * GRAVITY * self.position[:, 2] + self.feet + springs


class Arena:
    """A floor, and walls if there are any, on which the vehicle of a mission is thrown."""

    def __init__(self, mission: Mission) -> None:
        self.mission, vehicle = mission, Vehicle.from_settings(mission.vehicle)
        self.plant, self.mass, self.inertia = plant_from(mission, vehicle), vehicle.mass, vehicle.inertia
        table = [wall(w.start, w.end, w.top) for w in mission.all_walls]
        nowhere = no_walls_near(self.plant.walls) if table else Absent()
        self._world = World(self.plant, record("Table", table) if table else Absent(), nowhere)
        self._loop = Loop(step_of, self._world, self._begun(START), Given(0.001), QUICK)

    def _begun(self, start: State) -> Thrown:
        return Thrown(start, start_foot_grip(self.plant.floor, start))

    def throw(self, start: State, duration: float, step: float = 0.001) -> ThrownFlight:
        """The flight from a state on."""
        given = np.full((round(duration / step) + 1, 1), step)
        return ThrownFlight(self._loop(self._world, self._begun(start), given), self.plant, self.mass, self.inertia)


ARENAS = LastUsed[Arena](2)  # of megabytes each


def arena(mission: str = "iris", *changes: tuple[str, Any]) -> Arena:
    """The arena of a mission with changes; the last ones are kept."""
    level = {"ground.height": 0.0, "pushes": [], "initial.position": [0.0, 0.0, 1.0]}
    return ARENAS.of(repr((mission, changes)), lambda: Arena(tl.load_mission(mission, level | dict(changes))))


def random_throw(rng: np.random.Generator, speed: float, height: tuple[float, float]) -> State:
    """Any attitude, at a height [m], with a speed about `speed` [m/s] and rates to match."""
    q = rng.standard_normal(4)
    return State(
        vec3([0.0, 0.0, rng.uniform(*height)]),
        vec3(speed * rng.standard_normal(3)),
        Quat(*map(float, q / np.linalg.norm(q))),
        vec3(speed * rng.standard_normal(3)),
    )
