"""The vehicle driven by logged commands: rotors, body and perfect sensors, without pilot, contact and gusts.

The rotors do not depend on the body, so they are simulated first, over a whole log; the body then moves under the
squares of their speeds and the pushes that a force gauge logged. Both are the laws of the compiled engine, as functions
of the numbers of a vehicle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.compiler.machine_code.series import Series
from tandemlift.core.arrays import inverse
from tandemlift.core.caching import LastUsed
from tandemlift.core.law import law
from tandemlift.core.types import Array, Number, PerQuadrotor, PerRotor
from tandemlift.core.vector import (
    ZERO,
    Absent,
    Quat,
    Vec3,
    apply,
    apply_transposed,
    cross,
    each,
    mat3,
    set_of,
    spread,
    vec3,
)
from tandemlift.engines.compiled import advance
from tandemlift.engines.compiled_contact import CompiledPlant
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.engines.models.scene import Scene
from tandemlift.parts.contact.standing import standing_on
from tandemlift.parts.mechanics.push import CentralPush, PushSamples
from tandemlift.parts.mechanics.rigid_body import RigidBody, State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import VehicleTable
from tandemlift.parts.mechanics.wind import WindModel, WindTable, air_drag_from, wind_loads
from tandemlift.parts.rotors.allocation import mixer_of
from tandemlift.parts.rotors.ground_effect import GroundEffect, ground_effect_from, ground_effect_ratio
from tandemlift.parts.rotors.rotor_lag import Lag, lag, lag_step

NO_PUSH = CentralPush(ZERO)
_models = LastUsed["DrivenModels"](4)  # a search forms thousands of predictions, and each log of a set a predictor
AT_REST = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)


class VehicleNumbers(NamedTuple):
    """The numbers of a vehicle that its motion and its joints depend on, by the names of their keys; SI units.

    Those of quadrotors are sets. `inertia` of the payload: moments, `products`: Jxy, Jxz, Jyz, `areas`: its drag areas.
    """

    mass: Number
    center_of_mass: Vec3
    inertia: Vec3
    products: Vec3
    masses: PerQuadrotor
    inertias: Vec3
    thrust_constants: PerQuadrotor
    torques_per_thrust: PerQuadrotor
    drag_force: Vec3
    drag_moment: Vec3
    areas: Vec3


class DrivenBody(NamedTuple):
    """A vehicle in the form that a step needs.

    The body, k of each rotor [N/(rad/s)²], their ground effect, the wind, the point that motion capture follows, from
    the centre of mass [m, body axes], the time step [s], the centre of mass from the payload's origin [m].
    """

    plant: CompiledPlant
    constants: PerRotor
    surface: GroundEffect | Absent
    wind: WindModel | Absent
    point: Vec3
    step: Number
    center: Vec3


class DrivenInputs(NamedTuple):
    """Mean squares of the rotors' speeds [rad²/s²]; a push: force [N, world axes], moment about the payload's origin.

    The moment is in body axes [N m].
    """

    squares: PerRotor
    force: Vec3
    moment: Vec3


class DrivenReadings(NamedTuple):
    """The readings of perfect sensors at the start of a step, in units and frames of the channels `measured_…`."""

    position: Vec3
    velocity: Vec3
    attitude: Quat
    rates: Vec3
    specific_force: Vec3
    joint_force: Vec3
    joint_torque: Vec3


class DrivenRotor(NamedTuple):
    """A rotor: its time constants up and down [s]; its speed [rad/s] is the state."""

    speed: Number
    up: Number
    down: Number


class StepNumbers(NamedTuple):
    """The parameters of a step: the vehicle, the point that the motion measurement follows, the step's length [s]."""

    vehicle: VehicleNumbers
    point: Vec3
    step: Number


class DrivenModels(NamedTuple):
    """Rotors and body as machine code, without and with tangents."""

    rotors: Series
    rotor_tangents: Series
    body: Series
    body_tangents: Series


def vehicle_numbers(table: VehicleTable) -> VehicleNumbers:
    """The numbers of a table."""
    payload, quadrotors = table.payload, table.quadrotors
    cls = each(len(quadrotors))
    return VehicleNumbers(
        mass=payload.mass,
        center_of_mass=vec3(payload.center_of_mass),
        inertia=vec3(payload.moments),
        products=vec3(payload.products),
        masses=cls(*[q.mass for q in quadrotors]),
        inertias=spread([q.inertia for q in quadrotors]),
        thrust_constants=cls(*[q.thrust_constant for q in quadrotors]),
        torques_per_thrust=cls(*[q.torque_per_thrust for q in quadrotors]),
        drag_force=vec3(table.drag.force),
        drag_moment=vec3(table.drag.moment),
        areas=vec3(payload.areas),
    )


def with_vehicle_numbers(table: VehicleTable, n: VehicleNumbers) -> VehicleTable:
    """A table with other numbers, which are not checked and may be symbols."""
    payload = table.payload.model_copy(
        update={
            "mass": n.mass,
            "center_of_mass": tuple(n.center_of_mass),
            "inertia": tuple(n.inertia),
            "products": tuple(n.products),
            "drag_area": tuple(n.areas),
        }
    )
    own = zip(n.masses, zip(*n.inertias, strict=True), n.thrust_constants, n.torques_per_thrust, strict=True)
    names = ("mass", "inertia", "thrust_constant", "torque_per_thrust")
    quadrotors = [
        q.model_copy(update=dict(zip(names, values, strict=True)))
        for q, values in zip(table.quadrotors, own, strict=True)
    ]
    drag = table.drag.model_copy(update={"force": tuple(n.drag_force), "moment": tuple(n.drag_moment)})
    return table.model_copy(update={"payload": payload, "quadrotors": tuple(quadrotors), "drag": drag})


def effect_floor(scene: Scene) -> tuple[float, float] | None:
    """(Height z [m] of a floor with ground effect, that of the vehicle standing on it); None without."""
    if scene.ground.model == "none" or not scene.ground.effect:
        return None
    ground = standing_on(scene.ground, scene.vehicle, scene.plant.mass_scale, scene.mission.step, scene.initial)
    return float(ground.floor.height), float(ground.rests)


def driven_body(
    table: VehicleTable, floor: float | None, air: WindTable, n: VehicleNumbers, point: Vec3, step: Number
) -> DrivenBody:
    """The vehicle of a table with other numbers, in a steady wind, over a floor with ground effect at z = `floor`."""
    vehicle = Vehicle.from_settings(with_vehicle_numbers(table, n))
    J = vehicle.inertia
    body = RigidBody(
        inverse_mass=1.0 / vehicle.mass,
        inertia=mat3(J),
        inverse_inertia=mat3(inverse(J)),
        drag_force=n.drag_force,
        drag_moment=n.drag_moment,
        force=ZERO,
        moment=ZERO,
    )
    plant = CompiledPlant(mixer_of(vehicle), body, parts_layout_from(vehicle), Absent(), Absent())
    surface = ground_effect_from(vehicle, floor)
    steady = WindModel(vec3(air.velocity), Absent(), air_drag_from(vehicle, air.density))
    wind = steady if air.model == "air" else Absent()
    constants = set_of([k for k in n.thrust_constants for _ in range(4)])
    return DrivenBody(plant, constants, surface, wind, point, step, vec3(vehicle.center_of_mass))


@law
def driven_step(b: DrivenBody, s: State, u: DrivenInputs) -> tuple[State, DrivenReadings]:
    """(The state after a step, readings at its start) under its inputs."""
    hand, R = PushSamples(NO_PUSH, NO_PUSH, NO_PUSH), rotation_from_quaternion(s.attitude)
    thrusts = u.squares * b.constants * ground_effect_ratio(b.surface, s)
    moment = u.moment - cross(b.center, apply_transposed(R, u.force))
    plant = b.plant._replace(body=b.plant.body._replace(force=u.force, moment=moment))
    air = wind_loads(b.wind, Absent(), plant.frame, s, ZERO, Absent()).loads
    moved = advance(plant, s, Absent(), Absent(), Absent(), thrusts, air, hand, b.step)
    felt = moved.readings
    return moved.state, DrivenReadings(
        position=s.position + apply(R, b.point),
        velocity=s.velocity + apply(R, cross(s.rates, b.point)),
        attitude=s.attitude,
        rates=s.rates,
        specific_force=felt.specific_force,
        joint_force=felt.joint_force,
        joint_torque=felt.joint_torque,
    )


@law
def rotor_step(step: Number, r: DrivenRotor, command: Number) -> tuple[DrivenRotor, Number]:
    """(The rotor after a step, the mean square of its speed [rad²/s²]) under a commanded speed [rad/s]."""
    one = each(1)
    up, down = _lag_over(step, r.up), _lag_over(step, r.down)
    square, speed = lag_step(up, down, one(r.speed), one(command))
    return DrivenRotor(speed[0], r.up, r.down), square[0]


def _lag_over(step: Number, time_constant: Number) -> Lag:
    return lag([time_constant], step)


def driven_models(table: VehicleTable, floor: float | None, air: WindTable) -> DrivenModels:
    """The machine code of `rotor_step` and `driven_step` for the geometry of a table; made once in a process.

    Parameters of a body's step are `StepNumbers`; `floor` and `air` as for `driven_body`.
    """

    def body(p: StepNumbers) -> DrivenBody:
        return driven_body(table, floor, air, p.vehicle, p.point, p.step)

    def compiled() -> DrivenModels:
        count = 4 * len(table.quadrotors)
        none = DrivenInputs(each(count)(*(0.0,) * count), ZERO, ZERO)
        of_body = body, driven_step, StepNumbers(vehicle_numbers(table), ZERO, 0.0), AT_REST, none
        of_rotor = (lambda step: step), rotor_step, 0.0, DrivenRotor(0.0, 0.0, 0.0), 0.0
        return DrivenModels(*[Series(*own, differentiated=d) for own in (of_rotor, of_body) for d in (False, True)])

    return _models.of((table.model_dump_json(), floor, air.model_dump_json()), compiled)


def whole_vehicle(table: VehicleTable, n: VehicleNumbers) -> dict[str, tuple[Array, str]]:
    """Mass, centre of mass from the payload's origin and inertia about it of the whole, with their units."""
    vehicle = Vehicle.from_settings(with_vehicle_numbers(table, n))
    return {
        "mass": (np.array([vehicle.mass]), "kg"),
        "center_of_mass": (vehicle.center_of_mass, "m"),
        "inertia": (np.diag(vehicle.inertia), "kg m²"),
    }
