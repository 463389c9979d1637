"""Contact of the compiled body: loads of floor and walls on its parts, with their effect on motion and readings.

What a mission does not have is `Absent`, and costs nothing. What is out of reach for a step (`DistantFloor`,
`DistantWalls`) gives zero loads, added like any other.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.law import choice, law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Quarters, Quat
from tandemlift.parts.contact.feet import Floor, FootGrip, feet_load, grips_after_step
from tandemlift.parts.contact.hull import Hull, HullContact, hull_contact, hull_loads
from tandemlift.parts.contact.impulses import WallImpulses, impulses_of_walls
from tandemlift.parts.contact.walls import Walls, near_wall_contact, near_wall_loads
from tandemlift.parts.mechanics.joint_loads import (
    PartLoad,
    PartLoads,
    PartsLayout,
    PerfectReadings,
    readings_with_load,
    resultant,
    resultant_of_quadrotors,
    without_negative_zero,
)
from tandemlift.parts.mechanics.push import Push
from tandemlift.parts.mechanics.rigid_body import (
    RigidBody,
    State,
    Wrench,
    about_center,
    apply_inertia,
    at_position,
    motion,
    rigid_body_motion,
)
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.structure import Structure
from tandemlift.parts.rotors.allocation import Mixer

NO_LOAD = PartLoad(ZERO, ZERO)


class CompiledPlant(NamedTuple):
    """The true body: effect of the rotor thrusts, mass and inertia, parts, floor and walls, and its modes."""

    effect: Mixer
    body: RigidBody
    frame: PartsLayout
    floor: Any
    walls: Any
    structure: Structure | Absent = Absent()


class BodySurroundings(NamedTuple):
    """The constants of a step: the plant, loads of the air, the feet's grip, the nearest walls."""

    plant: CompiledPlant
    air: PartLoad | Absent
    grip: Any
    near: Any


class DistantFloor(NamedTuple):
    """A floor out of reach for some steps: the same numbers, without force."""

    floor: Floor


class DistantHull(NamedTuple):
    """Rotors, guards and beam out of the floor's reach for a step: the same numbers, without force."""

    hull: Hull | Absent


class DistantWalls(NamedTuple):
    """Walls out of reach for a step: the same numbers, without force."""

    walls: Walls


class ZeroLoad(NamedTuple):
    """The load of parts out of reach: zero, added like any other, so that the flight is bit-identical."""


def without_contact(plant: CompiledPlant) -> CompiledPlant:
    """The same body, with floor and walls out of reach."""
    floor, walls = plant.floor, plant.walls
    return plant._replace(
        floor=floor if isinstance(floor, Absent) else DistantFloor(floor),
        walls=walls if isinstance(walls, Absent) else DistantWalls(walls),
    )


def on_feet_only(plant: CompiledPlant) -> CompiledPlant:
    """The same body, with nothing but its feet within reach of the floor, and walls out of reach."""
    floor, walls = plant.floor, plant.walls
    return plant._replace(
        floor=floor if isinstance(floor, Absent) else floor._replace(hull=DistantHull(floor.hull)),
        walls=walls if isinstance(walls, Absent) else DistantWalls(walls),
    )


@law(absent="floor", instead={DistantFloor: ZeroLoad()})
def floor_loads(floor: Floor, b: BodySurroundings, s: State) -> PartLoad:
    """Loads of the floor on the quadrotors, or `Absent`."""
    return feet_load(floor, b.grip, b.plant.frame, s)


@law(absent="walls", instead={DistantWalls: ZeroLoad()})
def wall_loads(walls: Walls, b: BodySurroundings, s: State) -> PartLoads:
    """Loads of the walls on all parts, or `Absent`."""
    return near_wall_loads(walls, b.near, b.plant.frame, s)


@motion.register(BodySurroundings)
def surrounded_motion(b: BodySurroundings, s: State, u: Wrench, push: Push) -> State:
    """The motion of the body among its surroundings."""
    plant, q = b.plant, s.attitude
    free = with_load(b.air, plant.body, q, rigid_body_motion(plant.body, s, u, push))
    standing = with_load(load_about_center(floor_loads(plant.floor, b, s), plant.frame, q), plant.body, q, free)
    lying = with_load(load_about_center(hull_loads_in(b, s), plant.frame, q), plant.body, q, standing)
    return with_load(load_about_center(wall_loads(plant.walls, b, s), plant.frame, q), plant.body, q, lying)


@choice
def struck_by_walls(
    walls: Walls | DistantWalls | Absent, b: BodySurroundings, s: State, u: Wrench, push: Push, dt: Number
) -> WallImpulses:
    """The `WallImpulses` at the start of a step of dt [s]."""


@struck_by_walls.register(Absent)
@struck_by_walls.register(DistantWalls)
def _not_struck(
    walls: DistantWalls | Absent, b: BodySurroundings, s: State, u: Wrench, push: Push, dt: Number
) -> WallImpulses:
    return WallImpulses(s, Absent(), Absent())


@struck_by_walls.register(Walls)
def _struck(walls: Walls, b: BodySurroundings, s: State, u: Wrench, push: Push, dt: Number) -> WallImpulses:
    plant = b.plant
    free, sprung = motion(b._replace(plant=plant._replace(walls=Absent())), s, u, push), motion(b, s, u, push)
    contact = near_wall_contact(walls, b.near, plant.frame, s)
    return impulses_of_walls(walls, contact, plant.frame, plant.body, s, free, sprung, dt)


@law(absent="floor", instead={DistantFloor: Absent()})
def hull_contact_with(floor: Floor, s: State) -> HullContact | Absent:
    """Contact of rotors, guards and beam with the floor; `Absent` where it is out of reach."""
    return contact_of_hull(floor.hull, floor, s)


@law(absent="hull", instead={DistantHull: Absent()})
def contact_of_hull(hull: Hull, floor: Floor, s: State) -> HullContact:
    """`hull_contact`, or `Absent` without a hull."""
    return hull_contact(hull, floor.friction, floor.height, s, rotation_from_quaternion(s.attitude))


@law(absent="contact")
def loads_of_hull(contact: HullContact, frame: PartsLayout, s: State) -> PartLoads:
    """Loads of a `HullContact` on all parts, or `Absent`."""
    return hull_loads(contact, frame, rotation_from_quaternion(s.attitude))


@law
def hull_loads_in(b: BodySurroundings, s: State) -> PartLoads | Absent:
    """Loads of the floor on rotors, guards and beam, or `Absent` where it is out of reach."""
    return loads_of_hull(hull_contact_with(b.plant.floor, s), b.plant.frame, s)


@choice(absent="load", instead={ZeroLoad: NO_LOAD})
def load_about_center(
    load: PartLoads | PartLoad | ZeroLoad | Absent, frame: PartsLayout, attitude: Quat
) -> PartLoad | Absent:
    """A load about the centre of mass: of everything, of the quadrotors (vectors of sets), or `Absent`."""


@load_about_center.register(PartLoads)
def _of_all_parts(load: PartLoads, frame: PartsLayout, attitude: Quat) -> PartLoad:
    return resultant(frame, attitude, load) + NO_LOAD  # no zero of either sign but +0


@load_about_center.register(PartLoad)
def _of_quadrotors(load: PartLoad, frame: PartsLayout, attitude: Quat) -> PartLoad:
    return resultant_of_quadrotors(frame, attitude, load) + NO_LOAD  # no zero of either sign but +0


@law(absent="rate")
def with_load(load: PartLoad, body: RigidBody, attitude: Quat, rate: State) -> State:
    """The motion with a further load about the position."""
    turned = apply_inertia(body.inverse_inertia, about_center(body.center, attitude, load.force, load.moment))
    velocity = at_position(body.center, attitude, rate.velocity + load.force * body.inverse_mass, turned)
    return State(rate.position, velocity, rate.attitude, rate.rates + turned)


@law(absent="loads", instead={PartLoad: "loads", ZeroLoad: "loads"})
def quadrotor_loads(loads: PartLoads) -> PartLoad:
    """The part of loads that acts on the quadrotors, or `Absent`."""
    return loads.quadrotors


@readings_with_load.register(ZeroLoad)
def _unloaded(load: ZeroLoad, frame: PartsLayout, attitude: Quat, readings: PerfectReadings) -> PerfectReadings:
    return PerfectReadings(
        readings.specific_force,
        without_negative_zero(readings.joint_force),
        without_negative_zero(readings.joint_torque),
        readings.contact_force,
    )


@law(absent="readings")
def with_contact_force(load: PartLoad, readings: PerfectReadings) -> PerfectReadings:
    """`readings`, with the force of a contact about the centre of mass."""
    return PerfectReadings(
        readings.specific_force, readings.joint_force, readings.joint_torque, readings.contact_force + load.force
    )


@law(absent="grip", instead={DistantFloor: "grip"})
def grip_after(floor: Floor, grip: Quarters[FootGrip], s: State) -> Quarters[FootGrip]:
    """The feet's grip at the end of a step."""
    return grips_after_step(floor, grip, s)
