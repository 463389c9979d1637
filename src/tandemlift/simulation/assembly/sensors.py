"""The sensors of a mission, and the estimators of its pilot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tandemlift.core.algebra.arrays import array
from tandemlift.core.algebra.ops import maximum, minimum, where
from tandemlift.core.algebra.types import number
from tandemlift.core.algebra.vector import ZERO, Nothing, Vec3, each, vec3
from tandemlift.core.sensors import additional_sensor
from tandemlift.core.settings import AdditionalSensorTable, InertialSensor, JointSensors, Mission
from tandemlift.core.types import Array
from tandemlift.parts.estimation.confirmed_part import Zero
from tandemlift.parts.estimation.navigation import navigator, start_navigation
from tandemlift.parts.estimation.push_confirmation import BANDWIDTH, ConfirmationState, PushConfirmation, RotorModel
from tandemlift.parts.estimation.push_estimate import push_estimator, start_push
from tandemlift.parts.estimation.wind_compensation import PayloadDrag
from tandemlift.parts.mechanics.inertia import inertia_value
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.rotors.allocation import mixer_from
from tandemlift.parts.rotors.rotor_lag import lag
from tandemlift.parts.sensors.noise_bias_drift import SensorGrade, scalar_sensor_model, sensor_model
from tandemlift.parts.sensors.readings import AdditionalChannels, by_name, sensors, zero_noise
from tandemlift.parts.sensors.sensor_registry import PARAMETERS
from tandemlift.parts.signals.low_pass import LowPassState, low_pass
from tandemlift.parts.vehicle import Vehicle
from tandemlift.simulation.assembly.contacts import start_contacts
from tandemlift.simulation.loop.perception import Estimators, EstimatorState, NominalVehicle, TareAtTime, TareInHover


def steps_of(interval: float, step: float) -> int:
    """A sampling interval in whole steps, at least one."""
    return max(1, round(interval / step))


def sensors_from(mission: Mission, vehicle: Vehicle, chance: np.random.Generator) -> tuple[Any, Any]:
    """The sensors of a mission, and the layout of their noise; or `Nothing`."""
    s, N, step = mission.sensors, vehicle.count, mission.mission.step
    if s.model == "none":
        return Nothing(), Nothing()
    turns = chance.standard_normal((N, 3)) * s.joints.misalignment
    devices = sensors(
        count=N,
        step=step,
        force=_joint_grade(s.joints, "force", turns, chance),
        torque=_joint_grade(s.joints, "torque", turns, chance),
        accelerometer=_inertial_grade(s.accelerometer, chance),
        gyroscope=_inertial_grade(s.gyroscope, chance),
        position_noise=s.motion.position_noise,
        velocity_noise=s.motion.velocity_noise,
        attitude_noise=s.motion.attitude_noise,
        imu_period=steps_of(s.interval, step),
        motion_period=steps_of(s.motion.interval, step),
        additional=_additional_sensors(s.additional, step, chance),
    )
    return devices, zero_noise(devices)


def _joint_grade(s: JointSensors, kind: str, turns: Array, chance: np.random.Generator) -> SensorGrade:
    """The sensors at the joints, of kind "force" or "torque"; `turns` (N × 3) of their axes [rad]."""
    noise, bias, drift, resolution, limit = (
        getattr(s, f"{kind}_{error}") for error in ("noise", "bias", "drift", "resolution", "range")
    )
    return SensorGrade(
        noise=noise,
        bias=chance.standard_normal(turns.shape) * bias,
        drift=drift,
        resolution=resolution,
        limit=limit,
        misalignment=turns,
    )


def _inertial_grade(s: InertialSensor, chance: np.random.Generator) -> SensorGrade:
    return SensorGrade(noise=s.noise, bias=chance.standard_normal((1, 3)) * s.bias, drift=s.drift, limit=s.range)


def _additional_sensors(tables: Sequence[AdditionalSensorTable], step: float, chance: np.random.Generator) -> Any:
    """The parameters of additional sensors by name; `Nothing` for none."""
    return by_name(tuple(s.name for s in tables))(*[_additional(s, step, chance) for s in tables])


def _additional(s: AdditionalSensorTable, step: float, chance: np.random.Generator) -> Any:
    is_vector, period = additional_sensor(s.name).width == 3, steps_of(s.interval, step)
    bias = chance.standard_normal(3 if is_vector else None) * s.bias
    grade = SensorGrade(noise=s.noise, bias=bias, drift=s.drift, resolution=s.resolution, limit=s.range)
    model = (sensor_model if is_vector else scalar_sensor_model)(grade, step * period)
    return PARAMETERS[s.name](AdditionalChannels(model), float(period))


def payload_drag_from(vehicle: Vehicle, bandwidth: float, step: float) -> PayloadDrag:
    """The windage of the nominal vehicle, with a low-pass of a bandwidth [rad/s]."""
    beam = array(vehicle.payload.areas) * vehicle.payload.drag_coefficient
    quadrotors = np.sum([array(q.drag_area) * q.drag_coefficient for q in vehicle.quadrotors], axis=0)
    return PayloadDrag(number(beam[0] / quadrotors[0]), number(beam[1] / quadrotors[1]), low_pass(bandwidth, step))


TOLERANCE = 0.5  # of the threshold of a push: also after a bias of the other sign, what is left stays below it
MARGIN = 1.2  # on ratios of drag areas, which are not known better
TINY_AREA = 1e-6  # m²: quadrotors with less tell nothing of the wind


def _rotor_model(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    """The rotors as the pilot knows them, and their speeds at rest; `Nothing` where they have no limits."""
    if mission.allocation.method != "constrained":
        return Nothing(), Nothing()
    rotors, fleet = each(vehicle.rotor_count), [q for q in vehicle.quadrotors for _ in range(4)]
    up, down = (lag([getattr(q, name) for q in fleet], mission.mission.step) for name in ("lag_up", "lag_down"))
    constants = [q.thrust_constant for q in fleet]
    model = RotorModel(mixer_from(vehicle.effect), rotors(*constants), rotors(*[1.0 / k for k in constants]), up, down)
    return model, rotors(*[0.0] * vehicle.rotor_count)


def _wind_ratios(vehicle: Vehicle) -> list[Any]:
    """Drag of the payload over that of the quadrotors along each body axis; 0 where the quadrotors have none."""
    beam = array(vehicle.payload.areas) * vehicle.payload.drag_coefficient
    fleet = np.sum([array(q.drag_area) * q.drag_coefficient for q in vehicle.quadrotors], axis=0)
    return [where(b < TINY_AREA, 0.0, a / maximum(b, TINY_AREA)) for a, b in zip(beam, fleet, strict=True)]


def start_confirmation(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    """The confirmation of pushes by the nominal vehicle, and its memory; or `Nothing`."""
    e, (x, y, z) = mission.estimator, mission.admittance.threshold
    if e.confirmation == "none":
        return Nothing(), Nothing()
    side = minimum(x, y) * TOLERANCE  # body axes turn with the heading
    heavier = vehicle.payload.mass / (vehicle.mass - vehicle.payload.mass)
    margin = MARGIN if e.wind_compensation == "none" else 0.0
    rotors, speeds = _rotor_model(mission, vehicle)
    confirmation = PushConfirmation(
        rotors=rotors,
        tolerance=Vec3(side, side, z * TOLERANCE),
        moment_tolerance=mission.compliance.yaw.threshold * TOLERANCE,
        ratio=vec3([maximum(ratio * margin, heavier) for ratio in _wind_ratios(vehicle)]),
        inertia=inertia_value(vehicle.inertia),
        low_pass=low_pass(BANDWIDTH, mission.mission.step),
    )
    force, turning = LowPassState(ZERO, ZERO), LowPassState(0.0, 0.0)
    return confirmation, ConfirmationState(
        speeds, force, turning, Zero(ZERO, ZERO, force, ZERO, ZERO), Zero(0.0, 0.0, turning, 0.0, 0.0)
    )


def start_estimators(mission: Mission, vehicle: Vehicle, state: State, readings: Any) -> tuple[Any, Any]:
    """The estimators of a mission and their memory at t = 0, for the nominal vehicle; or `Nothing`."""
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
        imu_period=period,
        length=math.inf if payload.length is None else payload.length,
        bandwidth=e.push_bandwidth,
        min_force=e.min_force,
        tare_start=0.0 if e.tare == "hover" else e.tare_start,
        tare_duration=e.tare_duration,
        identify_mass=e.identify_mass,
        disagreement_limit=e.disagreement_limit,
        windage=Nothing() if e.wind_compensation == "none" else payload_drag_from(vehicle, e.wind_bandwidth, step),
        system=vehicle.center_of_mass,
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
    contact, no_contact = start_contacts(mission, vehicle)
    confirmation, unconfirmed = start_confirmation(mission, vehicle)
    known = Estimators(push, observer, believed, tare, contact, confirmation)
    return known, EstimatorState(
        start_push(push, readings.imu), start_navigation(observer, state), no_contact, unconfirmed
    )
