"""The compiled body: one rigid body among wind, floor and walls, moved by a Runge-Kutta step of order four.

Loads of the air are held over a step. Contact (`compiled_contact`) is evaluated in every stage, with the feet's grip
and the nearest walls held.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.arrays import inverse
from tandemlift.core.caching import cached
from tandemlift.core.law import law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Quarters, vec3
from tandemlift.engines.compiled_contact import (
    BodySurroundings,
    CompiledPlant,
    floor_loads,
    grip_after,
    hull_loads_in,
    load_about_center,
    quadrotor_loads,
    struck_by_walls,
    wall_loads,
    with_contact_force,
    with_load,
)
from tandemlift.engines.compiled_structure import divided, shape_at_rest, with_shape
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.engines.models.scene import Scene, floor_from, walls_from
from tandemlift.parts.contact.feet import Floor, FootGrip
from tandemlift.parts.contact.touches import Touches
from tandemlift.parts.contact.walls import NearWalls, Walls
from tandemlift.parts.mechanics.joint_loads import PartLoads, PerfectReadings, perfect_readings, readings_with_load
from tandemlift.parts.mechanics.parts import Acceleration
from tandemlift.parts.mechanics.push import Push, PushSamples
from tandemlift.parts.mechanics.rigid_body import (
    Inertia,
    InitialTable,
    RigidBody,
    State,
    inertia_value,
    motion,
    rk4,
)
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.structure import Deformation, elastic_readings, structure_of
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable, PlantTable
from tandemlift.parts.rotors.allocation import mixer_of, wrench


class BodyStep(NamedTuple):
    """Result of a step of the body: state and deformation after it, readings at its start, grip and touches after.

    `shape` is `Absent` of a rigid body; `touches`: a `Touches`, or `Absent` without floor.
    """

    state: State
    shape: Deformation | Absent
    readings: PerfectReadings
    grip: Quarters[FootGrip] | Absent
    touches: Touches | Absent


@law
def readings_in(
    b: BodySurroundings, s: State, k1: State, air: PartLoads | Absent, thrusts: PerRotor, impulses: PartLoads | Absent
) -> PerfectReadings:
    """Perfect readings in state `s`, whose motion is `k1`, under thrusts [N] and loads of air and impulses on parts."""
    frame, q = b.plant.frame, s.attitude
    floor, hull, walls = floor_loads(b.plant.floor, b, s), hull_loads_in(b, s), wall_loads(b.plant.walls, b, s)
    readings = readings_with_load(
        quadrotor_loads(air), frame, q, perfect_readings(frame, s, Acceleration(k1.velocity, k1.rates), thrusts)
    )
    readings = readings_with_load(quadrotor_loads(floor), frame, q, readings)
    readings = readings_with_load(quadrotor_loads(hull), frame, q, readings)
    readings = readings_with_load(quadrotor_loads(walls), frame, q, readings)
    readings = readings_with_load(quadrotor_loads(impulses), frame, q, readings)
    for loads in (floor, hull, walls, impulses):
        readings = with_contact_force(load_about_center(loads, frame, q), readings)
    return readings


@law
def first_motion(
    plant: CompiledPlant,
    s: State,
    grip: Quarters[FootGrip],
    near: NearWalls,
    thrusts: PerRotor,
    air: PartLoads | Absent,
    hand: PushSamples[Push],
) -> State:
    """The motion at the start of a step."""
    b = BodySurroundings(plant, load_about_center(air, plant.frame, s.attitude), grip, near)
    return motion(b, s, wrench(plant.effect, thrusts), hand.start)


@law
def advance(
    plant: CompiledPlant,
    s: State,
    shape: Deformation | Absent,
    grip: Quarters[FootGrip] | Absent,
    near: NearWalls | Absent,
    thrusts: PerRotor,
    air: PartLoads | Absent,
    hand: PushSamples[Push],
    dt: Number,
) -> BodyStep:
    """One step of dt [s] with rotor thrusts [N] and the air's loads held, and the push continuous.

    Walls strike at its start, before all else. Its touches are left out; `touches.touches_in` gives them.
    """
    b = BodySurroundings(plant, load_about_center(air, plant.frame, s.attitude), grip, near)
    u = wrench(plant.effect, thrusts)
    struck, q = struck_by_walls(plant.walls, b, s, u, hand.start, dt), s.attitude
    body, x = with_shape(shape, b, struck.state, thrusts, air, struck.loads, dt)
    k1 = motion(body, x, u, hand.start)
    rate, bending = divided(k1)
    after, bent = divided(rk4(body, x, k1, u, hand, dt))
    mean = with_load(load_about_center(struck.loads, plant.frame, q), plant.body, q, rate)
    readings = readings_in(b, struck.state, mean, air, thrusts, struck.loads)
    felt = Acceleration(mean.velocity, mean.rates)
    own = struck.state, shape, felt, bending, struck.loads
    readings = elastic_readings(plant.structure, plant.frame, *own, readings)
    return BodyStep(after, bent, readings, grip_after(plant.floor, grip, after), Absent())


@cached
def readings_at_rest(
    plant: CompiledPlant,
    s: State,
    shape: Deformation | Absent,
    grip: Quarters[FootGrip] | Absent,
    near: NearWalls | Absent,
    thrusts: PerRotor,
    hand: PushSamples[Push],
) -> PerfectReadings:
    """Perfect readings in still air in state `s`, deformed as at rest, under rotor thrusts [N]."""
    b = BodySurroundings(plant, Absent(), grip, near)
    k1 = motion(b, s, wrench(plant.effect, thrusts), hand.start)
    readings, felt = readings_in(b, s, k1, Absent(), thrusts, Absent()), Acceleration(k1.velocity, k1.rates)
    still: Any = shape if isinstance(shape, Absent) else shape * 0.0
    return elastic_readings(plant.structure, plant.frame, s, shape, felt, still, Absent(), readings)


@cached
def start_shape(
    body: CompiledPlant,
    state: State,
    grip: Quarters[FootGrip] | Absent,
    near: NearWalls | Absent,
    thrusts: PerRotor,
    hand: PushSamples[Push],
) -> Deformation | Absent:
    """The deformation at rest in a state under rotor thrusts [N]; `Absent` of a rigid body."""
    if isinstance(body.structure, Absent):
        return Absent()
    return shape_at_rest(BodySurroundings(body, Absent(), grip, near), state, thrusts, hand)


@cached
def _inertia(vehicle: Vehicle, plant: PlantTable) -> tuple[Inertia, Inertia]:
    """The true inertia of a vehicle and its inverse."""
    J = vehicle.real_inertia(plant)
    return inertia_value(J), inertia_value(inverse(J))


def start_plant(scene: Scene, vehicle: Vehicle, floor: Floor | Absent, walls: Walls | Absent) -> CompiledPlant:
    """The body of a scene, on a floor and between walls, or `Absent`."""
    body = _body(vehicle, scene.plant, scene.disturbance)
    structure = structure_of(vehicle, scene.mission.step)
    return _plant(mixer_of(vehicle), body, parts_layout_from(vehicle), floor, walls, structure)


_plant = cached(CompiledPlant)


@cached
def _body(vehicle: Vehicle, plant: PlantTable, disturbance: DisturbanceTable) -> RigidBody:
    (inertia, inverse_inertia), off = _inertia(vehicle, plant), plant.center_of_mass_offset
    return RigidBody(
        inverse_mass=1.0 / (vehicle.mass * plant.mass_scale),
        inertia=inertia,
        inverse_inertia=inverse_inertia,
        drag_force=vec3(vehicle.drag.force),
        drag_moment=vec3(vehicle.drag.moment),
        force=vec3(disturbance.force),
        moment=vec3(disturbance.moment),
        center=vec3(off) if any(x != 0.0 for x in off) else Absent(),
    )


def plant_from(scene: Scene, vehicle: Vehicle) -> CompiledPlant:
    """The body of a mission with its floor and its walls, each `Absent` if the mission has none."""
    return start_plant(scene, vehicle, floor_from(scene, vehicle), walls_from(scene, vehicle))


@cached
def start_state(initial: InitialTable) -> State:
    """The state at t = 0."""
    attitude = quaternion_from_euler(vec3(initial.euler))
    return State(vec3(initial.position), vec3(initial.velocity), attitude, vec3(initial.rates))
