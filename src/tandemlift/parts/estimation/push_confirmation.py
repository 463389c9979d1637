"""Confirmation of a measured push by the rest of the vehicle, so that the pilot follows no sensor error and no wind.

With F̂ the push by joints and accelerometer (`push_estimate`), f_i the force of quadrotor i on the payload, m_i its
mass and s_i its specific force, r = Σ (f_i + m_i s_i) − T e_z is the force on the quadrotors besides their modelled
thrust T. The whole external force on the vehicle is F̂ + r. `confirmed_part` confirms F̂ by r, per body axis; about the
vertical the same holds for the moments, without wind. Without limits of the rotors, T is unknown, and nothing is
rejected.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import maximum, minimum, sqrt, where
from tandemlift.core.arrays import array
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.part import Part
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import ZERO, Absent, Mat3, Vec3, apply, apply_transposed, cross, each, vec3
from tandemlift.parts.estimation.confirmed_part import TINY, Zero, compared
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.push_estimate import (
    PushEstimate,
    PushEstimator,
    PushEstimatorState,
    relative_acceleration,
)
from tandemlift.parts.estimation.wind_compensation import subtracted_wind
from tandemlift.parts.mechanics.joint_loads import scaled, sum_over_set, translated
from tandemlift.parts.mechanics.rigid_body import UP, apply_inertia, gyroscopic, inertia_value
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import Mixer, mixer_from, wrench
from tandemlift.parts.rotors.rotor_lag import Lag, lag, lag_step
from tandemlift.parts.sensors.readings import ImuReading

BANDWIDTH = 10.0  # rad/s, of the low-pass on r, which may be slow because a push does not change r
REST_THRUST = 1e-3  # N
NO_WIND = 1e-9  # a ratio ρ by which r explains nothing


class RotorModel(NamedTuple):
    """The pilot's model of the rotors: their wrench, k [N/(rad/s)²] and 1/k, and lags, each a set."""

    effect: Mixer
    constant: PerRotor
    per_constant: PerRotor
    up: Lag
    down: Lag


class PushConfirmation(NamedTuple):
    """A `RotorModel`, or `Absent`; tolerances and ratio ρ per body axis; the vehicle's inertia; the low-pass on r.

    `tolerance` [N], `moment_tolerance` about z [N·m], `inertia` [kg·m²].
    """

    rotors: RotorModel | Absent
    tolerance: Vec3
    moment_tolerance: Number
    ratio: Vec3
    inertia: Mat3 | Vec3
    low_pass: LowPass


class ConfirmationState(NamedTuple):
    """Memory: speeds of the rotors as modelled [rad/s]; r [N] and its moment about z [N·m], low-passed; their zeros."""

    speeds: PerRotor | Absent
    rest: LowPassState[Vec3]
    turning: LowPassState[Number]
    force_zero: Zero[Vec3]
    turning_zero: Zero[Number]


class SampledPush(NamedTuple):
    """The source of an estimated push: the reading of the IMU, the estimator, and its memory after the sample."""

    imu: ImuReading
    estimator: PushEstimator
    memory: PushEstimatorState


@law
def on_quadrotors(k: PushEstimator, imu: ImuReading, angular: Vec3) -> Vec3:
    """Σ (f_i + m_i s_i) [N, body axes]: the rotors' thrust and the external force on the quadrotors."""
    turn = relative_acceleration(k.quadrotors, imu.rates, angular)
    return sum_over_set(imu.joint_force + scaled(translated(imu.specific_force, turn), k.quadrotor_mass))


@law
def about_vertical(e: PushEstimator, moment: Vec3, force: Vec3) -> Number:
    """The moment of a push about the system's centre of mass, along body z [N·m], from that about the payload's."""
    return moment.z - cross(e.system, force).z


@elementwise
def speed_at(thrust: Number, per_constant: Number) -> Number:
    """The speed of a rotor [rad/s] with a thrust [N] in the steady state; its slope at rest is 0, not infinite."""
    return sqrt(maximum(thrust, REST_THRUST) * per_constant)


@law(absent=(ZERO, 0.0, "memory"))
def outside_load(
    rotors: RotorModel, memory: PerRotor, commands: PerRotor, quadrotors: Vec3, turning: Number
) -> tuple[Vec3, Number, PerRotor]:
    """(Force [N, body axes] and moment about z [N·m] of the load besides the push, modelled speeds of rotors [rad/s]).

    `commands`: the last thrusts [N]; `quadrotors`: Σ (f_i + m_i s_i) [N]; `turning`: rate of the angular momentum less
    the push's moment [N·m], body z.
    """
    squares, speeds = lag_step(rotors.up, rotors.down, memory, speed_at(commands, rotors.per_constant))
    made = wrench(rotors.effect, squares * rotors.constant)
    return quadrotors - UP * made.thrust, turning - made.moment.z, speeds


@law(absent=("p", "m"))
def confirm(
    k: PushConfirmation,
    m: ConfirmationState,
    p: PushEstimate,
    x: SampledPush,
    commands: PerRotor | Absent,
    explained: Number,
    dt: Number,
) -> tuple[PushEstimate, ConfirmationState]:
    """(the confirmed push, the new memory), from the push as estimated, its source, and the last thrusts [N].

    `explained`: 1 while a contact with a wall explains the force on the quadrotors, else 0.
    """
    imu, e, after = x.imu, x.estimator, x.memory
    sampled = apply_transposed(rotation_from_quaternion(imu.frame), p.measured)
    momentum = apply_inertia(k.inertia, after.angular) - gyroscopic(k.inertia, imu.rates)
    turning = momentum.z - about_vertical(e, p.measured_moment, sampled) * p.armed  # before, it is not tared
    load, moment, speeds = outside_load(k.rotors, m.speeds, commands, on_quadrotors(e, imu, after.angular), turning)
    rest, about_z = low_pass_step(k.low_pass, m.rest, load), low_pass_step(k.low_pass, m.turning, moment)
    force, beside = after.force.value, rest.value + subtracted_wind(after.wind)
    turned = about_vertical(e, after.moment.value, force)
    tare, learns = (1.0 - p.armed) / maximum(after.sums.count, 1.0), p.armed * (1.0 - explained) * dt
    f = compared(k.low_pass, m.force_zero, force, beside, k.tolerance, k.ratio, tare, learns)
    n = compared(k.low_pass, m.turning_zero, turned, about_z.value, k.moment_tolerance, NO_WIND, tare, learns)
    refuted = maximum(maximum(f.refuted.x, f.refuted.y), maximum(f.refuted.z, n.refuted))
    left = withheld(p, imu, f.withheld, n.withheld, 1.0 - explained, refuted)
    return left, ConfirmationState(speeds, rest, about_z, f.zero, n.zero)


@choice(absent=ZERO)
def refuted_push(estimates: object) -> Vec3:
    """The part of a push that the motion refutes [N, world axes], or zero."""


@law
def withheld(
    p: PushEstimate, imu: ImuReading, force: Vec3, turning: Number, applies: Number, refuted: Number
) -> PushEstimate:
    """The push less what is not confirmed: `force` [N] and the moment `turning` about z [N·m], body axes."""
    less, about_z = apply(rotation_from_quaternion(imu.frame), force * applies), Vec3(0.0, 0.0, turning * applies)
    smoothed = p.force - less
    return p._replace(
        measured=p.measured - less,
        measured_moment=p.measured_moment - about_z,
        force=smoothed,
        moment=p.moment - about_z,
        usable=smoothed * (p.trusted * p.armed),
        withheld=less,
        refuted=refuted * applies,
    )


TOLERANCE = 0.5  # of the threshold of a push, so that the rest stays below it even after a bias of the other sign
MARGIN = 1.2  # tolerance of the ratios of drag areas
TINY_AREA = 1e-6  # m²: quadrotors with less do not measure the wind


def rotor_model(vehicle: Vehicle, step: float) -> tuple[RotorModel, PerRotor]:
    """The pilot's model of the rotors, and their speeds at rest."""
    rotors, fleet = each(vehicle.rotor_count), [q for q in vehicle.quadrotors for _ in range(4)]
    up, down = (lag([getattr(q, name) for q in fleet], step) for name in ("lag_up", "lag_down"))
    constants = [q.thrust_constant for q in fleet]
    model = RotorModel(mixer_from(vehicle.effect), rotors(*constants), rotors(*[1.0 / k for k in constants]), up, down)
    return model, rotors(*[0.0] * vehicle.rotor_count)


def _wind_ratios(vehicle: Vehicle) -> list[Number]:
    """Drag of the payload over that of the quadrotors along each body axis; 0 where the quadrotors have none."""
    beam = array(vehicle.payload.areas) * vehicle.payload.drag_coefficient
    fleet = np.sum([array(q.areas) * q.drag_coefficient for q in vehicle.quadrotors], axis=0)
    return [where(b < TINY_AREA, 0.0, a / maximum(b, TINY_AREA)) for a, b in zip(beam, fleet, strict=True)]


def start_confirmation(
    table: EstimatorTable,
    vehicle: Vehicle,
    interval: float,
    *,
    threshold: tuple[float, float, float],
    moment_threshold: float,
    limited: bool,
) -> tuple[PushConfirmation, ConfirmationState]:
    """The confirmation of pushes by the nominal vehicle, and its memory; `limited`: whether its thrusts are known."""
    x, y, z, about_z = [maximum(bound * TOLERANCE, TINY) for bound in (*threshold, moment_threshold)]
    side = minimum(x, y)  # body axes rotate with the heading
    heavier = vehicle.payload.mass / (vehicle.mass - vehicle.payload.mass)
    margin = MARGIN if table.wind_compensation == "none" else 0.0
    rotors, speeds = rotor_model(vehicle, interval) if limited else (Absent(), Absent())
    confirmation = PushConfirmation(
        rotors=rotors,
        tolerance=Vec3(side, side, z),
        moment_tolerance=about_z,
        ratio=vec3([maximum(ratio * margin, heavier) for ratio in _wind_ratios(vehicle)]),
        inertia=inertia_value(vehicle.inertia),
        low_pass=low_pass(BANDWIDTH, interval),
    )
    force, turning = LowPassState(ZERO, ZERO), LowPassState(0.0, 0.0)
    return confirmation, ConfirmationState(
        speeds, force, turning, Zero(ZERO, ZERO, force, ZERO, ZERO), Zero(0.0, 0.0, turning, 0.0, 0.0)
    )


CONFIRMS = 'estimator.confirmation = "motion" and estimator.wrench = "joints"'
CONFIRMATION = Part("confirmation", "estimators", "estimator", CONFIRMS, start_confirmation)
