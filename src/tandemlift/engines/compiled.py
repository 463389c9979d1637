"""The compiled body: one rigid body among wind, floor and walls, moved by a Runge-Kutta step of order four.

Loads of the air are held over a step. Contact is evaluated in every stage, with the feet's grip and the nearest walls
held. What is absent is `Nothing`, and costs nothing.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tandemlift.algebra.law import choice, law
from tandemlift.algebra.vector import ZERO, Nothing, vec3
from tandemlift.laws.mechanics.body import RigidBody, State, motion, rigid_body_motion, rk4
from tandemlift.laws.mechanics.contact import Floor, floor_load, grip_after
from tandemlift.laws.mechanics.inertia import apply_inertia, inertia_value
from tandemlift.laws.mechanics.loads import (
    PartLoad,
    PartLoads,
    PartsLayout,
    PerfectReadings,
    perfect_readings,
    resultant,
    resultant_of_quadrotors,
    with_load,
    without_negative_zero,
)
from tandemlift.laws.mechanics.parts import Acceleration
from tandemlift.laws.mechanics.push import PushSamples
from tandemlift.laws.mechanics.rotation import quaternion_from_euler
from tandemlift.laws.mechanics.walls import Walls, wall_loads
from tandemlift.laws.rotors.allocation import Mixer, mixer_from, wrench
from tandemlift.models.parts_layout import parts_layout_from
from tandemlift.settings import Mission, VehicleTable
from tandemlift.vehicle import Vehicle

NO_LOAD = PartLoad(ZERO, ZERO)


class CompiledPlant(NamedTuple):
    """The body as it really is: what rotor thrusts do to it, how it moves, its parts, the floor and the walls."""

    effect: Mixer
    body: RigidBody
    frame: PartsLayout
    floor: Any
    walls: Any


class BodySurroundings(NamedTuple):
    """The body during a step: its state at the start, the air's loads, the feet's grip, the nearest walls."""

    plant: CompiledPlant
    air: Any
    grip: Any
    near: Any


class BodyStep(NamedTuple):
    """What a step of the body comes to: the state after it, what was felt at its start, the feet's grip after it."""

    state: State
    felt: PerfectReadings
    grip: Any


class DistantFloor(NamedTuple):
    """A floor out of reach for some steps: the same numbers, and no force."""

    floor: Floor


class DistantWalls(NamedTuple):
    """Walls out of reach for a step: the same numbers, and no force."""

    walls: Walls


class ZeroLoad(NamedTuple):
    """The load of what is out of reach: zero, and added like any other, so that no bit of a flight depends on it."""


def untouched(plant: CompiledPlant) -> CompiledPlant:
    """The same body where nothing can touch floor or walls."""
    floor, walls = plant.floor, plant.walls
    return plant._replace(
        floor=floor if isinstance(floor, Nothing) else DistantFloor(floor),
        walls=walls if isinstance(walls, Nothing) else DistantWalls(walls),
    )


@choice(absent="floor")
def of_floor(floor: Any, b: BodySurroundings, s: State) -> Any:
    """Loads of the floor on the quadrotors, or `Nothing`."""


@of_floor.register(DistantFloor)
def _out_of_reach(floor, b, s):
    return ZeroLoad()


@of_floor.register(Floor)
def _floor(floor, b, s):
    return floor_load(floor, b.grip, b.plant.frame, s)


@choice(absent="walls")
def of_walls(walls: Any, b: BodySurroundings, s: State) -> Any:
    """Loads of the walls on all parts, or `Nothing`."""


@of_walls.register(DistantWalls)
def _walls_out_of_reach(walls, b, s):
    return ZeroLoad()


@of_walls.register(Walls)
def _walls(walls, b, s):
    return wall_loads(walls, b.near, b.plant.frame, s)


@choice(absent="load")
def summed(load: Any, frame: PartsLayout, attitude: Any) -> Any:
    """A load about the centre of mass: of everything, of the quadrotors (vectors of sets), or `Nothing`."""


@summed.register(PartLoads)
def _of_all(load, frame, attitude):
    return resultant(frame, attitude, load) + NO_LOAD  # no zero of either sign but +0


@summed.register(PartLoad)
def _of_quadrotors(load, frame, attitude):
    return resultant_of_quadrotors(frame, attitude, load) + NO_LOAD  # no zero of either sign but +0


@summed.register(ZeroLoad)
def _no_contact(load, frame, attitude):
    return NO_LOAD


@choice(absent="rate")
def moved_by(load: Any, body: RigidBody, rate: State) -> Any:
    """The motion under a further load about the centre of mass."""


@moved_by.register(PartLoad)
def _pressed(load, body, rate):
    turned = apply_inertia(body.inverse_inertia, load.moment)
    return State(rate.position, rate.velocity + load.force * body.inverse_mass, rate.attitude, rate.rates + turned)


@motion.register(BodySurroundings)
def surrounded_motion(b, s, u, push):
    """The motion of the body among its surroundings."""
    plant, q = b.plant, s.attitude
    free = moved_by(b.air, plant.body, rigid_body_motion(plant.body, s, u, push))
    standing = moved_by(summed(of_floor(plant.floor, b, s), plant.frame, q), plant.body, free)
    return moved_by(summed(of_walls(plant.walls, b, s), plant.frame, q), plant.body, standing)


@choice(absent="loads")
def on_quadrotors(loads: Any) -> Any:
    """The part of loads that acts on the quadrotors, or `Nothing`."""


@on_quadrotors.register(PartLoads)
def _on_each(loads):
    return loads.quadrotors


@on_quadrotors.register(PartLoad)
def _on_each_alone(loads):
    return loads


@on_quadrotors.register(ZeroLoad)
def _on_none_yet(loads):
    return loads


@with_load.register(ZeroLoad)
def _unloaded(load, frame, attitude, felt):
    return PerfectReadings(
        felt.specific_force,
        without_negative_zero(felt.joint_force),
        without_negative_zero(felt.joint_torque),
        felt.contact_force,
    )


@choice(absent="felt")
def touched_by(load: Any, felt: PerfectReadings) -> Any:
    """`felt`, with the force of a contact about the centre of mass."""


@touched_by.register(PartLoad)
def _touched(load, felt):
    return PerfectReadings(felt.specific_force, felt.joint_force, felt.joint_torque, felt.contact_force + load.force)


@law
def readings_in(b: BodySurroundings, s: State, k1: State, air: Any, thrusts: Any) -> PerfectReadings:
    """What is felt in state `s`, whose motion is `k1`, under thrusts [N] and the air's loads on the parts."""
    frame, q = b.plant.frame, s.attitude
    floor, walls = of_floor(b.plant.floor, b, s), of_walls(b.plant.walls, b, s)
    felt = with_load(
        on_quadrotors(air), frame, q, perfect_readings(frame, s, Acceleration(k1.velocity, k1.rates), thrusts)
    )
    felt = with_load(on_quadrotors(floor), frame, q, felt)
    felt = with_load(on_quadrotors(walls), frame, q, felt)
    return touched_by(summed(walls, frame, q), touched_by(summed(floor, frame, q), felt))


@choice(absent="grip")
def gripping(floor: Any, grip: Any, s: State) -> Any:
    """The feet's grip at the end of a step."""


@gripping.register(DistantFloor)
def _in_the_air(floor, grip, s):
    return grip


@gripping.register(Floor)
def _feet(floor, grip, s):
    return grip_after(floor, grip, s)


@law
def first_motion(
    plant: CompiledPlant, s: State, grip: Any, near: Any, thrusts: Any, air: Any, hand: PushSamples
) -> State:
    """The motion at the start of a step."""
    b = BodySurroundings(plant, summed(air, plant.frame, s.attitude), grip, near)
    return motion(b, s, wrench(plant.effect, thrusts), hand.start)


@law
def advance(
    plant: CompiledPlant, s: State, grip: Any, near: Any, thrusts: Any, air: Any, hand: PushSamples, dt: Any
) -> BodyStep:
    """One step of dt [s] with rotor thrusts [N] and the air's loads held, and the push continuous."""
    b, u = BodySurroundings(plant, summed(air, plant.frame, s.attitude), grip, near), wrench(plant.effect, thrusts)
    k1 = motion(b, s, u, hand.start)
    after = rk4(b, s, k1, u, hand, dt)
    return BodyStep(after, readings_in(b, s, k1, air, thrusts), gripping(plant.floor, grip, after))


def readings_at_rest(
    plant: CompiledPlant, s: State, grip: Any, near: Any, thrusts: Any, hand: PushSamples
) -> PerfectReadings:
    """What is felt in still air in state `s` under rotor thrusts [N]."""
    b, air = BodySurroundings(plant, Nothing(), grip, near), Nothing()
    return readings_in(b, s, motion(b, s, wrench(plant.effect, thrusts), hand.start), air, thrusts)


@lru_cache(maxsize=64)
def _effect(vehicle: VehicleTable) -> Mixer:
    return mixer_from(Vehicle.from_settings(vehicle).effect)


def start_plant(mission: Mission, vehicle: Vehicle, floor: Any, walls: Any) -> CompiledPlant:
    """The body of a mission, on a floor and between walls, or `Nothing`."""
    scale = np.diag(np.sqrt(mission.plant.inertia_scale))
    J = scale @ vehicle.inertia @ scale
    body = RigidBody(
        inverse_mass=1.0 / (vehicle.mass * mission.plant.mass_scale),
        inertia=inertia_value(J),
        inverse_inertia=inertia_value(np.linalg.inv(J)),
        drag_force=vec3(vehicle.drag.force),
        drag_moment=vec3(vehicle.drag.moment),
        force=vec3(mission.disturbance.force),
        moment=vec3(mission.disturbance.moment),
    )
    return CompiledPlant(_effect(mission.vehicle), body, parts_layout_from(vehicle), floor, walls)


def start_state(mission: Mission) -> State:
    """The state of a mission at t = 0."""
    initial = mission.initial
    attitude = quaternion_from_euler(vec3(initial.euler))
    return State(vec3(initial.position), vec3(initial.velocity), attitude, vec3(initial.rates))
