"""The sensors of a vehicle and their memory before the first step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Absent, Quat
from tandemlift.parts.mechanics.loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.noise_bias_drift import (
    PERFECT,
    AttitudeNoise,
    ChannelModel,
    NoError,
    NoSensor,
    SensorGrade,
    WhiteNoise,
    no_noise,
    scalar_sensor_model,
    sensor_model,
    start_drift,
)
from tandemlift.parts.sensors.readings import (
    AdditionalChannels,
    AdditionalReading,
    Device,
    DeviceModel,
    DeviceState,
    ImuChannels,
    ImuReading,
    JointChannels,
    JointReading,
    MotionChannels,
    MotionReading,
    R,
    Seldom,
    SensorNoise,
    Sensors,
    SensorState,
    by_name,
    sample_channels,
    true_additional,
    true_imu,
    true_motion,
    with_sampled_joints,
)
from tandemlift.parts.sensors.sensor_list import additional_sensor
from tandemlift.parts.sensors.sensor_registry import PARAMETERS
from tandemlift.parts.sensors.sensors_table import (
    AdditionalSensorTable,
    InertialSensor,
    JointSensors,
    SensorsTable,
    as_simulated,
    joint_steps,
    noise_scale,
    steps_of,
)

NONE = Absent()
AT_ONCE: Mapping[str, int] = MappingProxyType({})


def sensors(
    count: int,
    step: float,
    force: SensorGrade = PERFECT,
    torque: SensorGrade = PERFECT,
    accelerometer: SensorGrade = PERFECT,
    gyroscope: SensorGrade = PERFECT,
    position_noise: float = 0.0,
    velocity_noise: float = 0.0,
    attitude_noise: float = 0.0,
    imu_period: int = 1,
    motion_period: int = 1,
    additional: tuple[Device, ...] = NONE,
    joint_period: int | None = None,
    has_joints: bool = True,
) -> Sensors:
    """The sensors of a vehicle of `count` quadrotors; by default perfect and sampled every step.

    Args:
        count: number of quadrotors N.
        step: of the simulation [s].
        force: of the joints' force [N]; `bias` and `misalignment` may be N × 3.
        torque: of the joints' torque [N·m], likewise.
        accelerometer: of the specific force [m/s²].
        gyroscope: of the rates [rad/s].
        position_noise: σ of a motion sample's position [m].
        velocity_noise: σ of its velocity [m/s].
        attitude_noise: σ of its attitude, about each body axis [rad].
        imu_period: of the IMU, in whole steps.
        motion_period: of the motion measurement, in whole steps.
        additional: parameters of additional sensors by name (`by_name`).
        joint_period: of the joints, in whole steps; None for the IMU's clock.
        has_joints: whether there are sensors at the joints.
    """
    interval = step * (joint_period or imu_period)
    models: tuple[ChannelModel, ...] = (sensor_model(force, interval, count), sensor_model(torque, interval, count))
    joints = DeviceModel(JointChannels(*models), float(joint_period)) if joint_period else Absent()
    own_force, own_torque = (NoError(), NoError()) if joint_period else models if has_joints else (NoSensor(),) * 2
    imu: ImuChannels[ChannelModel] = ImuChannels(
        specific_force=sensor_model(accelerometer, step * imu_period),
        rates=sensor_model(gyroscope, step * imu_period),
        joint_force=own_force,
        joint_torque=own_torque,
        frame=NoError(),
    )
    noise = WhiteNoise(position_noise), WhiteNoise(velocity_noise), AttitudeNoise(attitude_noise)
    motion: MotionChannels[ChannelModel] = MotionChannels(*noise)
    return Sensors(DeviceModel(imu, float(imu_period)), DeviceModel(motion, float(motion_period)), additional, joints)


def sensors_from(
    s: SensorsTable, count: int, step: float, chance: np.random.Generator
) -> tuple[Sensors | Absent, SensorNoise | Absent]:
    """The sensors of `count` joints and of the body, and the layout of their noise; or `Absent`.

    `chance` draws biases and misalignments; `step` [s] is that of the simulation.
    """
    if s.model == "none":
        return Absent(), Absent()
    s = as_simulated(s)
    turns = chance.standard_normal((count, 3)) * s.joints.misalignment
    imu_period, joint_period = steps_of(s.interval, step), joint_steps(s, step)
    scale, of_joints = noise_scale(s, step * imu_period), noise_scale(s, step * (joint_period or imu_period))
    devices = sensors(
        count=count,
        step=step,
        force=_joint_grade(s.joints, "force", turns, of_joints, chance),
        torque=_joint_grade(s.joints, "torque", turns, of_joints, chance),
        accelerometer=_inertial_grade(s.accelerometer, scale, chance),
        gyroscope=_inertial_grade(s.gyroscope, scale, chance),
        position_noise=s.motion.position_noise,
        velocity_noise=s.motion.velocity_noise,
        attitude_noise=s.motion.attitude_noise,
        imu_period=imu_period,
        motion_period=steps_of(s.motion.interval, step),
        joint_period=joint_period,
        has_joints=s.joints.model != "none",
        additional=_additional_sensors(s.additional, step, chance),
    )
    return devices, zero_noise(devices)


def _joint_grade(s: JointSensors, kind: str, turns: Array, scale: float, chance: np.random.Generator) -> SensorGrade:
    """The sensors at the joints, of kind "force" or "torque"; `turns` (N × 3) of their axes [rad]."""
    noise, bias, drift, resolution, limit = (
        getattr(s, f"{kind}_{error}") for error in ("noise", "bias", "drift", "resolution", "range")
    )
    return SensorGrade(
        noise=noise * scale,
        bias=chance.standard_normal(turns.shape) * bias,
        drift=drift,
        resolution=resolution,
        limit=limit,
        misalignment=turns,
    )


def _inertial_grade(s: InertialSensor, scale: float, chance: np.random.Generator) -> SensorGrade:
    return SensorGrade(
        noise=s.noise * scale, bias=chance.standard_normal((1, 3)) * s.bias, drift=s.drift, limit=s.range
    )


def _additional_sensors(
    tables: Sequence[AdditionalSensorTable], step: float, chance: np.random.Generator
) -> tuple[Device, ...]:
    """The parameters of additional sensors by name; `Absent` for none."""
    return by_name(tuple(s.name for s in tables))(*[_additional(s, step, chance) for s in tables])


def _additional(s: AdditionalSensorTable, step: float, chance: np.random.Generator) -> Device:
    is_vector, period = additional_sensor(s.name).width == 3, steps_of(s.interval, step)
    bias = chance.standard_normal(3 if is_vector else None) * s.bias
    grade = SensorGrade(noise=s.noise, bias=bias, drift=s.drift, resolution=s.resolution, limit=s.range)
    model = (sensor_model if is_vector else scalar_sensor_model)(grade, step * period)
    return PARAMETERS[s.name](AdditionalChannels(model), float(period))


def zero_noise(k: Sensors) -> SensorNoise:
    """Standard normals of 0 for one step of these sensors."""
    imu, motion = ImuChannels(*map(no_noise, k.imu.channels)), MotionChannels(*map(no_noise, k.motion.channels))
    more = [AdditionalChannels(*map(no_noise, sensor.channels)) for sensor in k.additional]
    joints = Absent() if isinstance(k.joints, Absent) else JointChannels(*map(no_noise, k.joints.channels))
    return SensorNoise(imu, motion, type(k.additional)(*more), joints)


def start_sensing(
    k: Sensors, state: State, perfect: PerfectReadings, believed: Quat, waits: Mapping[str, int] = AT_ONCE
) -> SensorState:
    """The memory before the first step: readings of a state, with bias but without noise, and not fresh.

    Every device takes its first sample in the first step, or later: `waits` steps, by the name of the device.
    """
    noise = zero_noise(k)

    def start(name: str, device: Device, truth: Any, normals: Any, kind: type[R]) -> DeviceState[R]:
        drift: Any = type(truth)(*map(start_drift, device.channels))
        reading = kind._make([*sample_channels(device.channels, drift, truth, normals), 0.0])
        marked = Seldom() if min(device.period, k.imu.period) > 1.0 else Absent()
        return DeviceState(reading, drift, float(waits.get(name, 0)), marked)

    joints: DeviceState[JointReading] | Absent = Absent()
    if not isinstance(k.joints, Absent) and not isinstance(noise.joints, Absent):
        felt = JointChannels(perfect.joint_force, perfect.joint_torque)
        joints = start("joints", k.joints, felt, noise.joints, JointReading)
    names = getattr(k.additional, "_fields", ())
    more = [
        start(name, device, true_additional(device, state, perfect), normals, AdditionalReading)
        for name, device, normals in zip(names, k.additional, noise.additional, strict=True)
    ]
    truth = true_imu(state, with_sampled_joints(k.joints, joints, perfect), believed)
    return SensorState(
        start("imu", k.imu, truth, noise.imu, ImuReading),
        start("motion", k.motion, true_motion(state), noise.motion, MotionReading),
        by_name(names)(*more),
        joints,
    )
