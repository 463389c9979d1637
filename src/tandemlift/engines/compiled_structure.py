"""How a step moves the compiled body: rigid, or with the elastic modes of its structure, by one Runge-Kutta step."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.law import choice, law
from tandemlift.core.types import Number, PerQuadrotor, PerRotor
from tandemlift.core.vector import Absent, Quat, apply
from tandemlift.engines.compiled_contact import (
    BodySurroundings,
    ZeroLoad,
    floor_loads,
    hull_loads_in,
    surrounded_motion,
    wall_loads,
    with_load,
)
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartLoads, quadrotor_wrenches
from tandemlift.parts.mechanics.push import Push, PushSamples
from tandemlift.parts.mechanics.rigid_body import State, Wrench, motion
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.structure import (
    Deformation,
    ElasticState,
    Structure,
    modal_acceleration,
    turned_thrusts,
    with_work_of_loads,
    work_of_push,
    work_on_modes_of_each,
)


@with_work_of_loads.register(ZeroLoad)
def _of_none(loads: ZeroLoad, k: Structure, attitude: Quat, work: Any) -> Any:
    return type(work)(*[f + 0.0 for f in work])


class ElasticBody(NamedTuple):
    """The constants of a step of an elastic body: its surroundings, thrusts [N], modal forces of rotors and air."""

    around: BodySurroundings
    thrusts: PerQuadrotor
    work: Any


@law
def elastic_body(b: BodySurroundings, s: State, thrusts: PerRotor, air: PartLoads | Absent) -> ElasticBody:
    """The constants of a step under rotor thrusts [N] and loads of the air, both held."""
    k: Any = b.plant.structure
    rotors: Any = quadrotor_wrenches(b.plant.frame, thrusts)
    none = rotors.thrust * 0.0
    along_z = rotors.moment._replace(x=none, y=none, z=rotors.thrust)
    work = work_on_modes_of_each(k.quadrotors, along_z, rotors.moment)
    return ElasticBody(b, rotors.thrust, with_work_of_loads(air, k, s.attitude, work))


@law
def modal_forces(b: ElasticBody, s: State, push: Push) -> Any:
    """The modal forces of everything that acts on the body in a state."""
    k: Any = b.around.plant.structure
    work = b.work + work_of_push(push, k, s.attitude)
    for loads in (floor_loads(b.around.plant.floor, b.around, s), hull_loads_in(b.around, s)):
        work = with_work_of_loads(loads, k, s.attitude, work)
    return with_work_of_loads(wall_loads(b.around.plant.walls, b.around, s), k, s.attitude, work)


@motion.register(ElasticBody)
def elastic_motion(b: ElasticBody, s: ElasticState, u: Wrench, push: Push) -> ElasticState:
    """The motion of the mean axes, and of every mode."""
    plant, q = b.around.plant, s.body.attitude
    k: Any = plant.structure
    turned = turned_thrusts(k, plant.frame, plant.body.inverse_mass, b.thrusts, s.shape.coordinates)
    load = PartLoad(apply(rotation_from_quaternion(q), turned.force), turned.moment)
    rate = with_load(load, plant.body, q, surrounded_motion(b.around, s.body, u, push))
    return ElasticState(
        rate, Deformation(s.shape.rates, modal_acceleration(k, s.shape, modal_forces(b, s.body, push) + turned.work))
    )


@law(absent=("b", "s"))
def with_shape(
    shape: Deformation,
    b: BodySurroundings,
    s: State,
    thrusts: PerRotor,
    air: PartLoads | Absent,
    struck: PartLoads | Absent,
    dt: Number,
) -> tuple[ElasticBody, ElasticState]:
    """(The body of a step of dt [s], its state), once mean loads of walls that `struck` it have kicked the modes."""
    kick = with_work_of_loads(struck, b.plant.structure, s.attitude, shape.rates * 0.0)
    return elastic_body(b, s, thrusts, air), ElasticState(s, shape._replace(rates=shape.rates + kick * dt))


@choice
def divided(s: State | ElasticState) -> tuple[State, Deformation | Absent]:
    """The state of the body, or its rate, and that of its deformation."""


@divided.register(State)
def _rigid(s: State) -> tuple[State, Absent]:
    return s, Absent()


@divided.register(ElasticState)
def _elastic(s: ElasticState) -> tuple[State, Deformation]:
    return s.body, s.shape


@law
def shape_at_rest(b: BodySurroundings, s: State, thrusts: PerRotor, hand: PushSamples[Push]) -> Deformation:
    """The deformation at rest under thrusts [N], in still air."""
    k: Any = b.plant.structure
    work = modal_forces(elastic_body(b, s, thrusts, Absent()), s, hand.start)
    return Deformation(type(work)(*[f / w for f, w in zip(work, k.stiffness, strict=True)]), work * 0.0)
