"""The sensors of a mission and the estimators on board."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tandemlift.algebra.vector import ZERO, Nothing, Vec3, each, vec3
from tandemlift.laws.estimation.navigation import navigator, start_navigation
from tandemlift.laws.estimation.push_estimate import push_estimator, start_push
from tandemlift.laws.estimation.wind_compensation import PayloadDrag
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.sensors.readings import SensorNoise, sensors
from tandemlift.laws.sensors.sensor_errors import SensorGrade
from tandemlift.laws.signals.low_pass import low_pass
from tandemlift.loop.perception import Estimators, EstimatorState, NominalVehicle, TareAtTime, TareInHover
from tandemlift.settings import InertialSensor, Mission
from tandemlift.vehicle import Vehicle


def steps_of(interval: float, step: float) -> int:
    """A sampling interval in whole steps, at least one."""
    return max(1, round(interval / step))


def sensors_from(mission: Mission, vehicle: Vehicle, chance: np.random.Generator) -> tuple[Any, Any]:
    """The sensors of a mission, and the layout of their noise; or `Nothing`."""
    s, N, step = mission.sensors, vehicle.count, mission.mission.step
    if s.model == "none":
        return Nothing(), Nothing()
    j, turns = s.joints, chance.standard_normal((N, 3)) * s.joints.misalignment
    force = SensorGrade(
        j.force_noise,
        chance.standard_normal((N, 3)) * j.force_bias,
        j.force_drift,
        j.force_resolution,
        j.force_range,
        turns,
    )
    torque = SensorGrade(
        j.torque_noise,
        chance.standard_normal((N, 3)) * j.torque_bias,
        j.torque_drift,
        j.torque_resolution,
        j.torque_range,
        turns,
    )
    devices = sensors(
        N,
        step,
        force,
        torque,
        _inertial(s.accelerometer, chance),
        _inertial(s.gyroscope, chance),
        s.motion.position_noise,
        s.motion.velocity_noise,
        s.motion.attitude_noise,
        steps_of(s.interval, step),
        steps_of(s.motion.interval, step),
    )
    none = each(N)(*(0.0,) * N)
    sets = Vec3(none, none, none)
    return devices, SensorNoise(ZERO, ZERO, sets, sets, ZERO, ZERO, ZERO)


def _inertial(s: InertialSensor, chance: np.random.Generator) -> SensorGrade:
    return SensorGrade(s.noise, chance.standard_normal((1, 3)) * s.bias, s.drift, 0.0, s.range)


def payload_drag_from(vehicle: Vehicle, bandwidth: float, step: float) -> PayloadDrag:
    """The windage of a vehicle as it is believed to be, with a low-pass of a bandwidth [rad/s]."""
    beam = np.array(vehicle.payload.areas) * vehicle.payload.drag_coefficient
    quadrotors = np.sum([np.array(q.drag_area) * q.drag_coefficient for q in vehicle.quadrotors], axis=0)
    return PayloadDrag(float(beam[0] / quadrotors[0]), float(beam[1] / quadrotors[1]), low_pass(bandwidth, step))


def start_estimators(mission: Mission, vehicle: Vehicle, state: State, readings: Any) -> tuple[Any, Any]:
    """The estimators of a mission and their memory at t = 0, as the vehicle is believed to be; or `Nothing`."""
    if isinstance(readings, Nothing):
        return Nothing(), Nothing()
    e, s, step = mission.estimator, mission.sensors, mission.mission.step
    payload, quadrotors = vehicle.payload, vehicle.quadrotors
    period, motion_period = steps_of(s.interval, step), steps_of(s.motion.interval, step)
    push = push_estimator(
        mass=payload.mass,
        inertia=payload.moments,
        joints=[q.joint_position for q in quadrotors],
        quadrotors=[q.position for q in quadrotors],
        quadrotor_masses=[q.mass for q in quadrotors],
        step=step,
        unit_period=period,
        length=payload.length or math.inf,
        bandwidth=e.push_bandwidth,
        min_force=e.min_force,
        tare_start=0.0 if e.tare == "hover" else e.tare_start,
        tare_duration=e.tare_duration,
        identify_mass=e.identify_mass,
        disagreement_limit=e.disagreement_limit,
        windage=Nothing() if e.wind_compensation == "none" else payload_drag_from(vehicle, e.wind_bandwidth, step),
    )
    observer = navigator(
        vehicle.center_of_mass,
        step,
        period,
        motion_period,
        position_bandwidth=e.position_bandwidth,
        attitude_bandwidth=e.attitude_bandwidth,
        age=s.motion.delay - s.delay,
    )
    drag = vehicle.drag
    believed = NominalVehicle(vec3(-vehicle.center_of_mass), vec3(drag.force), vec3(drag.moment))
    tare = TareInHover() if e.tare == "hover" else TareAtTime()
    known = Estimators(push, observer, believed, tare)
    return known, EstimatorState(start_push(push, readings.unit), start_navigation(observer, state))
