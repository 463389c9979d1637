"""The sensors of a vehicle by their tables, with biases and misalignments drawn from the seed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Absent
from tandemlift.parts.sensors.noise_bias_drift import (
    AttitudeNoise,
    ChannelModel,
    NoError,
    NoSensor,
    SensorGrade,
    SensorModel,
    WhiteNoise,
    scalar_sensor_model,
    sensor_model,
)
from tandemlift.parts.sensors.readings import (
    AdditionalChannels,
    DeviceModel,
    ImuChannels,
    JointChannels,
    MotionChannels,
    SensorNoise,
    Sensors,
    by_name,
    zero_noise,
)
from tandemlift.parts.sensors.sensor_registry import PARAMETERS
from tandemlift.parts.sensors.sensors_table import (
    AdditionalSensorTable,
    InertialSensor,
    SensorsTable,
    as_simulated,
    joint_steps,
    noise_scale,
    steps_of,
)
from tandemlift.parts.sensors.vehicle_sensors import additional_sensor


def sensors_from(
    s: SensorsTable, count: int, step: float, chance: np.random.Generator
) -> tuple[Sensors | Absent, SensorNoise | Absent]:
    """The sensors of `count` joints and of the body, and the layout of their noise; or `Absent`.

    `chance` draws biases and misalignments; `step` [s] is that of the simulation.
    """
    if s.model == "none":
        return Absent(), Absent()
    s = as_simulated(s)
    # the order of the draws decides which error a seed gives to which sensor
    turns = chance.standard_normal((count, 3)) * s.joints.misalignment
    imu_period, joint_period = steps_of(s.interval, step), joint_steps(s, step)
    interval, of_joints = step * imu_period, step * (joint_period or imu_period)
    force: ChannelModel = _joint_model(s, "force", turns, of_joints, chance)
    torque: ChannelModel = _joint_model(s, "torque", turns, of_joints, chance)
    joints: DeviceModel | Absent = Absent()
    if joint_period:
        joints = DeviceModel(JointChannels(force, torque), float(joint_period))
        force = torque = NoError()  # the IMU holds their last samples, which have the errors
    elif s.joints.model == "none":
        force = torque = NoSensor()
    accelerometer = _inertial_model(s, s.accelerometer, interval, chance)
    gyroscope = _inertial_model(s, s.gyroscope, interval, chance)
    imu = ImuChannels(accelerometer, gyroscope, force, torque, frame=NoError())
    position, velocity = WhiteNoise(s.motion.position_noise), WhiteNoise(s.motion.velocity_noise)
    motion = MotionChannels[ChannelModel](position, velocity, AttitudeNoise(s.motion.attitude_noise))
    devices = Sensors(
        imu=DeviceModel(imu, float(imu_period)),
        motion=DeviceModel(motion, float(steps_of(s.motion.interval, step))),
        additional=_additional_sensors(s.additional, step, chance),
        joints=joints,
    )
    return devices, zero_noise(devices)


def _joint_model(s: SensorsTable, kind: str, turns: Array, interval: float, chance: np.random.Generator) -> SensorModel:
    """The sensors at the joints, of kind "force" or "torque"; `turns` (N × 3) of their axes [rad]."""
    noise, bias, drift, resolution, limit = (
        getattr(s.joints, f"{kind}_{error}") for error in ("noise", "bias", "drift", "resolution", "range")
    )
    biases = chance.standard_normal(turns.shape) * bias
    grade = SensorGrade(noise * noise_scale(s, interval), biases, drift, resolution, limit, turns)
    return sensor_model(grade, interval, len(turns))


def _inertial_model(s: SensorsTable, own: InertialSensor, interval: float, chance: np.random.Generator) -> SensorModel:
    bias = chance.standard_normal((1, 3)) * own.bias
    grade = SensorGrade(noise=own.noise * noise_scale(s, interval), bias=bias, drift=own.drift, limit=own.range)
    return sensor_model(grade, interval)


def _additional_sensors(
    tables: Sequence[AdditionalSensorTable], step: float, chance: np.random.Generator
) -> tuple[DeviceModel, ...]:
    """The parameters of additional sensors by name; `Absent` for none."""
    return by_name(tuple(s.name for s in tables))(*[_additional(s, step, chance) for s in tables])


def _additional(s: AdditionalSensorTable, step: float, chance: np.random.Generator) -> DeviceModel:
    is_vector, period = additional_sensor(s.name).width == 3, steps_of(s.interval, step)
    bias = chance.standard_normal(3 if is_vector else None) * s.bias
    grade = SensorGrade(noise=s.noise, bias=bias, drift=s.drift, resolution=s.resolution, limit=s.range)
    model = (sensor_model if is_vector else scalar_sensor_model)(grade, step * period)
    return PARAMETERS[s.name](AdditionalChannels(model), float(period))
