"""The push of a person on the payload, from the sensors at its joints and in its centre of mass.

With f_i, t_i the load of quadrotor i on the payload at its joint c_i, a the specific force and ω the rates, all in body
axes and about the payload's centre of mass, the payload's equations of motion (the paper's trans_rot_payload_equ, with
a person on its right side) leave for the person F = m_L a − Σ f_i and M = J_L ω̇ + ω × J_L ω − Σ t_i − Σ c_i × f_i.
Wind on the payload counts as a push. ω̇ is the difference of consecutive samples.

In hover, over a window, the means of F and M are taken as the sensors' bias, after the payload's mass if it is
identified (`parts.estimation.tare`); the place of an excess mass is not observable in hover (`inertial_force`).
Wind on the payload may be subtracted (`parts.mechanics.wind`).

The external force on quadrotor i is f_i + m_i s_i, with s_i its specific force. Thrust is only in z, so x and y are
wind or sensor error; where they differ between quadrotors, the push is not trusted. Errors in z, of torques, and errors
that are equal at all joints are not detected.

One low-pass in body axes serves F and M, so that the point of application, x × F = M on the beam's axis y, is exact
however the force changes and the vehicle rotates.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import clip, maximum, sqrt, where
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.types import Number, NumberSet, PerQuadrotor, number
from tandemlift.core.vector import ZERO, Absent, Vec3, apply, cross, each, spread, total, vec3
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.tare import TINY, SideForces, TareSums, is_tared, summed, tare_fields, tare_of
from tandemlift.parts.estimation.wind_compensation import (
    PayloadDrag,
    PayloadDragState,
    payload_drag_from,
    start_payload_drag,
    wind_on_payload,
)
from tandemlift.parts.estimation.wrench.observation import PushEstimate as PushEstimate
from tandemlift.parts.mechanics.joint_loads import add_to_each, sum_over_set
from tandemlift.parts.mechanics.rigid_body import Inertia, apply_inertia, gyroscopic, inertia_value
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.off_center import OffCenter, about_center, from_origin, off_center_at
from tandemlift.parts.sensors.readings import ImuReading


class PushEstimator(NamedTuple):
    """The nominal vehicle and the numbers of the estimator; body axes.

    Payload: `mass` [kg] and `inertia` [kg·m²]. From its centre of mass [m]: the `system`'s centre of mass, `joints`,
    and the `quadrotors`' centres of mass, which weigh `quadrotor_mass` [kg] (sets); `reach`, half the beam's length.
    `per_interval`: samples of the IMU per second. `least`: square of the least force [N²] that has a point of
    application. Tare from `tare_start` [s] until before `tare_end`; `identify` is 1 to identify the payload's mass,
    else 0. `limit`: disagreement [N] from which on nothing is trusted; `share` is 1/N, `alone` N/(N − 1) or 0 for N =
    1. `windage`: how wind is subtracted, or `Absent`; `off_center`: `Absent` where the origin is the centre of mass.
    """

    mass: Number
    inertia: Inertia
    system: Vec3
    joints: Vec3
    quadrotors: Vec3
    quadrotor_mass: PerQuadrotor
    reach: Number
    per_interval: Number
    low_pass: LowPass
    least: Number
    tare_start: Number
    tare_end: Number
    identify: Number
    limit: Number
    share: Number
    alone: Number
    windage: PayloadDrag | Absent
    off_center: OffCenter | Absent


class PushEstimatorState(NamedTuple):
    """The last rates [rad/s] and angular acceleration [rad/s²], the sums of the tare, the low-passes, the wind."""

    rates: Vec3
    angular: Vec3
    sums: TareSums
    force: LowPassState[Vec3]
    moment: LowPassState[Vec3]
    x: LowPassState[NumberSet]
    y: LowPassState[NumberSet]
    wind: PayloadDragState | Absent


@law
def relative_acceleration(r: Vec3, rates: Vec3, angular: Vec3) -> Vec3:
    """ω × (ω × r) + ω̇ × r [m/s², body axes]: the acceleration of a point r of the vehicle relative to the origin."""
    # r is the left factor, because it may be a vector of sets: some array libraries swallow a tuple on the right
    return cross(cross(r, rates), rates) - cross(r, angular)


@law
def moment_on_payload(k: PushEstimator, imu: ImuReading, angular: Vec3) -> Vec3:
    """The moment M on the payload besides those of the joints [N·m, body axes], about its centre of mass."""
    joints = imu.joint_torque + cross(k.joints, imu.joint_force)
    return apply_inertia(k.inertia, angular) - gyroscopic(k.inertia, imu.rates) - sum_over_set(joints)


@law
def inertial_force(k: PushEstimator, specific_force: Vec3, rates: Vec3, angular: Vec3, mass: Number) -> Vec3:
    """m_L a [N, body axes]; `mass` [kg] beyond the nominal is assumed at the system's centre of mass.

    `specific_force` [m/s²] is at the payload's centre of mass. If a large excess mass were assumed there too, every
    rotation of the vehicle would look like a push, which the pilot then compensates: an unstable loop.
    """
    return specific_force * mass + relative_acceleration(k.system, rates, angular) * (mass - k.mass)


@law
def external_forces(k: PushEstimator, imu: ImuReading, angular: Vec3) -> SideForces[PerQuadrotor]:
    """The external horizontal force on every quadrotor [N], body axes."""
    a, turn = imu.specific_force, relative_acceleration(k.quadrotors, imu.rates, angular)
    x = imu.joint_force.x + add_to_each(turn.x, a.x) * k.quadrotor_mass
    y = imu.joint_force.y + add_to_each(turn.y, a.y) * k.quadrotor_mass
    return SideForces(x, y)


@law
def less_mean(k: PushEstimator, outside: SideForces[PerQuadrotor]) -> SideForces[PerQuadrotor]:
    """These forces less their mean over the quadrotors [N]."""
    x, y = outside
    return SideForces(add_to_each(x, -total(x) * k.share), add_to_each(y, -total(y) * k.share))


@law
def point_of_application(
    off_center: OffCenter | Absent, reach: Number, least: Number, force: Vec3, moment: Vec3
) -> Number:
    """The place on the beam's axis, body y [m], of a force with this moment about the centre of mass (body axes).

    It lies within `reach` [m] of the middle, and is 0 for a force whose square is below `least` [N²].
    """
    square = force.x * force.x + force.z * force.z
    y = (moment.x * force.z - moment.z * force.x) / maximum(square, least)
    return where(square < least, 0.0, clip(from_origin(off_center, y), -reach, reach))


@law
def disagreement(k: PushEstimator, x: PerQuadrotor, y: PerQuadrotor) -> Number:
    """The horizontal force [N] by which one joint sensor alone would have to be wrong to explain these `SideForces`."""
    return sqrt(maximum((total(x * x) + total(y * y)) * k.alone, TINY))


@law
def estimate(
    k: PushEstimator, memory: PushEstimatorState, imu: ImuReading, t: Number, free: Number = 1.0
) -> tuple[PushEstimate, PushEstimatorState]:
    """(Push, the new memory) from a reading of the IMU at time t [s], for a tare if `free`: see `wind_on_payload`."""
    angular = where(imu.fresh > 0.0, (imu.rates - memory.rates) * k.per_interval, memory.angular)
    # the accelerometer is at the origin, and the equations are about the centre of mass
    imu = about_center(k.off_center, imu, angular)
    a, f = imu.specific_force, sum_over_set(imu.joint_force)
    moment, outside = moment_on_payload(k, imu, angular), external_forces(k, imu, angular)
    unequal = less_mean(k, outside)
    begun = where(t < k.tare_start, 0.0, 1.0)
    taken = begun * where(t < k.tare_end, imu.fresh, 0.0) * free
    sums = summed(memory.sums, begun, taken, f, a, moment, unequal)
    armed = is_tared(k.tare_start, k.tare_end, sums.count, t)
    tare = tare_of(k.mass, k.identify, sums, armed)
    wind, wind_memory = wind_on_payload(k.windage, memory.wind, outside.x, outside.y, begun, taken, armed, free)
    force = inertial_force(k, a, imu.rates, angular, tare.mass) - f - tare.force - wind
    after = PushEstimatorState(
        imu.rates,
        angular,
        sums,
        low_pass_step(k.low_pass, memory.force, force * armed),
        low_pass_step(k.low_pass, memory.moment, (moment - tare.moment) * armed),
        low_pass_step(k.low_pass, memory.x, (unequal.x - tare.sides.x) * armed),
        low_pass_step(k.low_pass, memory.y, (unequal.y - tare.sides.y) * armed),
        wind_memory,
    )
    return concluded(k, imu, force, moment - tare.moment, after, tare.mass, armed), after


@law
def concluded(
    k: PushEstimator,
    imu: ImuReading,
    force: Vec3,
    turning: Vec3,
    after: PushEstimatorState,
    mass: Number,
    armed: Number,
) -> PushEstimate:
    """The push from the sample's `force` [N] and moment `turning` [N·m], body axes, and the low-passed values."""
    R = rotation_from_quaternion(imu.frame)
    smoothed, moment = apply(R, after.force.value), after.moment.value
    wrong = disagreement(k, after.x.value, after.y.value)
    trusted = where(wrong < k.limit, 1.0, 0.0)
    return PushEstimate(
        measured=apply(R, force),
        measured_moment=turning,
        force=smoothed,
        moment=moment,
        point=point_of_application(k.off_center, k.reach, k.least, after.force.value, moment),
        payload_mass=mass,
        disagreement=wrong,
        trusted=trusted,
        armed=armed,
        usable=smoothed * (trusted * armed),
    )


def push_estimator(e: EstimatorTable, vehicle: Vehicle, interval: float) -> PushEstimator:
    """The estimator with the nominal vehicle, for samples of the IMU every `interval` [s]."""
    payload, quadrotors, N = vehicle.payload, vehicle.quadrotors, len(vehicle.quadrotors)
    return PushEstimator(
        mass=number(payload.mass),
        inertia=inertia_value(payload.tensor),
        system=-vec3(vehicle.payload_center),
        joints=spread([np.subtract(q.joint_position, payload.center_of_mass) for q in quadrotors]),
        quadrotors=spread([np.subtract(q.position, payload.center_of_mass) for q in quadrotors]),
        quadrotor_mass=each(N)(*[number(q.mass) for q in quadrotors]),
        reach=math.inf if payload.span is None else 0.5 * payload.span,
        per_interval=1.0 / interval,
        low_pass=low_pass(e.push_bandwidth, interval),
        least=e.min_force**2,
        **tare_fields(0.0 if e.tare == "hover" else e.tare_start, e.tare_duration, e.identify_mass),
        limit=number(e.disagreement_limit),
        share=1.0 / N,
        alone=N / (N - 1) if N > 1 else 0.0,
        windage=Absent() if e.wind_compensation == "none" else payload_drag_from(vehicle, e.wind_bandwidth, interval),
        off_center=off_center_at(payload.center_of_mass),
    )


def start_push(estimator: PushEstimator, imu: ImuReading) -> PushEstimatorState:
    """The memory before the first step, in which the IMU reads `imu`."""
    none = estimator.quadrotor_mass * 0.0
    sums = TareSums(0.0, ZERO, ZERO, ZERO, 0.0, 0.0, SideForces(none, none))
    still, level = LowPassState(ZERO, ZERO), LowPassState(none, none)
    return PushEstimatorState(imu.rates, ZERO, sums, still, still, level, level, start_payload_drag(estimator.windage))
