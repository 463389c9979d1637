"""Readings of all sensors: every device samples on its own clock and holds its last sample.

The inertial measurement unit (IMU) holds an accelerometer at the payload's origin and a gyroscope; the
force-torque sensors at the joints run on its clock, or on one of their own: then a sample of the IMU holds the last one
of theirs. All read in body axes. The motion measurement reads position and velocity of the system's centre of mass in
world axes, and the attitude. An additional sensor is a device of its own (`additional_sensors`). Between samples the
last one is held, no longer fresh. Delays from the sensors to the pilot are in the loop (`simulation.loop.sources`).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any, Generic, NamedTuple, TypeAlias, TypeVar

from tandemlift.core.algebra import selected, where
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent, Quat, Vec3
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.noise_bias_drift import (
    ChannelModel,
    Drift,
    Sample,
    next_drift,
    no_noise,
    read,
    start_drift,
)
from tandemlift.parts.sensors.sensor_registry import true_value

T = TypeVar("T")


class ImuChannels(NamedTuple, Generic[T]):
    """One value for each quantity that is sampled with the IMU: a truth, a model, a drift, a noise, a fault.

    Specific force at the payload's origin [m/s²], rates [rad/s], and the load of each quadrotor on the payload
    at its joint: force [N] and torque [N·m], vectors of sets. `frame` is the pilot's attitude estimate at that time.
    """

    specific_force: T
    rates: T
    joint_force: T
    joint_torque: T
    frame: T


class JointChannels(NamedTuple, Generic[T]):
    """One value for each quantity of joints with a clock of their own; as in `ImuChannels`."""

    joint_force: T
    joint_torque: T


class MotionChannels(NamedTuple, Generic[T]):
    """One value for each quantity of the motion measurement: position [m], velocity [m/s] and attitude."""

    position: T
    velocity: T
    attitude: T


class AdditionalChannels(NamedTuple, Generic[T]):
    """One value for the quantity of an additional sensor."""

    value: T


Channels: TypeAlias = ImuChannels[T] | JointChannels[T] | MotionChannels[T] | AdditionalChannels[T]


class ImuReading(NamedTuple):
    """A sample of `ImuChannels`, body axes; `fresh` is 1 in the step in which it was taken, else 0."""

    specific_force: Vec3
    rates: Vec3
    joint_force: Vec3
    joint_torque: Vec3
    frame: Quat
    fresh: Number


class JointReading(NamedTuple):
    """A sample of `JointChannels`, body axes; `fresh` is 1 in the step in which it was taken, else 0."""

    joint_force: Vec3
    joint_torque: Vec3
    fresh: Number


class MotionReading(NamedTuple):
    """A sample of `MotionChannels`, world axes; `fresh` is 1 in the step in which it was taken, else 0."""

    position: Vec3
    velocity: Vec3
    attitude: Quat
    fresh: Number


class AdditionalReading(NamedTuple):
    """A sample of an additional sensor; `fresh` is 1 in the step in which it was taken, else 0."""

    value: Number | Vec3
    fresh: Number


R = TypeVar("R", ImuReading, JointReading, MotionReading, AdditionalReading)


class Readings(NamedTuple):
    """The last samples of all devices; of additional sensors, by name."""

    imu: ImuReading
    motion: MotionReading
    additional: Any = Absent()


class DeviceModel(NamedTuple):
    """A device: the models of its channels, and the steps from one sample to the next.

    An additional sensor has a type of its own with these fields, by which its law is picked.
    """

    channels: Channels[ChannelModel]
    period: Number


class Seldom(NamedTuple):
    """Marks a device of which compiled loops compute nothing between samples: neither it nor the IMU always samples."""


class DeviceState(NamedTuple, Generic[R]):
    """Memory of a device: its last sample, the drifts of its channels, and the steps to wait for the next sample."""

    reading: R
    drift: Channels[Drift]
    wait: Number
    seldom: Seldom | Absent = Absent()


class Sensors(NamedTuple):
    """All devices; the additional ones by name. `joints` is `Absent` where they run on the IMU's clock."""

    imu: DeviceModel
    motion: DeviceModel
    additional: Any = Absent()
    joints: DeviceModel | Absent = Absent()


class SensorState(NamedTuple):
    """Memory of all devices."""

    imu: DeviceState[ImuReading]
    motion: DeviceState[MotionReading]
    additional: Any = Absent()
    joints: DeviceState[JointReading] | Absent = Absent()


class SensorNoise(NamedTuple):
    """Independent standard normals for one step, for every channel of every device."""

    imu: ImuChannels[Drift]
    motion: MotionChannels[Drift]
    additional: Any = Absent()
    joints: JointChannels[Drift] | Absent = Absent()


@law
def sample_channels(
    models: Channels[ChannelModel], drift: Channels[Drift], truth: Channels[Sample], normals: Channels[Drift]
) -> Channels[Sample]:
    """A sample of every channel of a device."""
    return type(truth)(*[read(*channel) for channel in zip(models, drift, truth, normals, strict=True)])


@law
def sample_device(
    k: DeviceModel, m: DeviceState[R], truth: Channels[Sample], normals: Channels[Drift]
) -> DeviceState[R]:
    """The memory of a device after a step: with a fresh sample if one is due, else with the last, no longer fresh."""
    due = m.wait <= 0.0
    fresh, samples = where(due, 1.0, 0.0), sample_channels(k.channels, m.drift, truth, normals)
    held: list[Sample] = [selected(due, new, old) for new, old in zip(samples, m.reading[:-1], strict=True)]
    drift = [next_drift(*channel, fresh) for channel in zip(k.channels, m.drift, normals, strict=True)]
    reading, after = type(m.reading)._make([*held, fresh]), type(m.drift)(*drift)
    return DeviceState(reading, after, where(due, k.period, m.wait) - 1.0, m.seldom)


@law
def true_imu(state: State, perfect: PerfectReadings, believed: Quat) -> ImuChannels[Sample]:
    """The readings of the IMU and the joints' sensors without errors."""
    return ImuChannels(perfect.specific_force, state.rates, perfect.joint_force, perfect.joint_torque, believed)


@law(absent="m")
def sample_joints(
    k: DeviceModel, m: DeviceState[JointReading], perfect: PerfectReadings, normals: JointChannels[Drift]
) -> DeviceState[JointReading]:
    """The memory, after a step, of joints with a clock of their own."""
    return sample_device(k, m, JointChannels(perfect.joint_force, perfect.joint_torque), normals)


@law(absent="perfect")
def with_sampled_joints(k: DeviceModel, m: DeviceState[JointReading], perfect: PerfectReadings) -> PerfectReadings:
    """Readings in which the last samples of the joints stand, if they have a clock of their own."""
    return perfect._replace(joint_force=m.reading.joint_force, joint_torque=m.reading.joint_torque)


@law
def true_motion(state: State) -> MotionChannels[Sample]:
    """The readings of the motion measurement without errors."""
    return MotionChannels(state.position, state.velocity, state.attitude)


@law
def sense(
    k: Sensors, m: SensorState, state: State, perfect: PerfectReadings, believed: Quat, noise: SensorNoise
) -> tuple[Readings, SensorState]:
    """(Readings, the new memory) of a step in which the pilot's attitude estimate was `believed`."""
    more = [
        sample_device(sensor, memory, AdditionalChannels(true_value(sensor, state, perfect)), normals)
        for sensor, memory, normals in zip(k.additional, m.additional, noise.additional, strict=True)
    ]
    # joints first, because the sample of the IMU holds the last one of theirs
    joints = sample_joints(k.joints, m.joints, perfect, noise.joints)
    seen = with_sampled_joints(k.joints, joints, perfect)
    imu = sample_device(k.imu, m.imu, true_imu(state, seen, believed), noise.imu)
    motion = sample_device(k.motion, m.motion, true_motion(state), noise.motion)
    after = SensorState(imu, motion, type(m.additional)(*more), joints)
    return readings_of(after), after


@law
def readings_of(m: SensorState) -> Readings:
    """The last samples of all devices."""
    return Readings(m.imu.reading, m.motion.reading, type(m.additional)(*[device.reading for device in m.additional]))


@cache
def by_name(names: tuple[str, ...]) -> Any:
    """The type of values by name, one for each additional sensor; `Absent` for none."""
    return NamedTuple("_".join(("ByName", *names)), [(name, Any) for name in names]) if names else Absent


def zero_noise(k: Sensors) -> SensorNoise:
    """Standard normals of 0 for one step of these sensors."""
    imu, motion = ImuChannels(*map(no_noise, k.imu.channels)), MotionChannels(*map(no_noise, k.motion.channels))
    more = [AdditionalChannels(*map(no_noise, sensor.channels)) for sensor in k.additional]
    joints = Absent() if isinstance(k.joints, Absent) else JointChannels(*map(no_noise, k.joints.channels))
    return SensorNoise(imu, motion, type(k.additional)(*more), joints)


def start_sensing(
    k: Sensors, state: State, perfect: PerfectReadings, believed: Quat, waits: Mapping[str, int] = MappingProxyType({})
) -> SensorState:
    """The memory before the first step: readings of a state, with bias but without noise, and not fresh.

    Every device takes its first sample in the first step, or later: `waits` steps, by the name of the device.
    """
    noise = zero_noise(k)

    def start(name: str, device: DeviceModel, truth: Any, normals: Any, kind: type[R]) -> DeviceState[R]:
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
        start(name, device, AdditionalChannels(true_value(device, state, perfect)), normals, AdditionalReading)
        for name, device, normals in zip(names, k.additional, noise.additional, strict=True)
    ]
    truth = true_imu(state, with_sampled_joints(k.joints, joints, perfect), believed)
    return SensorState(
        start("imu", k.imu, truth, noise.imu, ImuReading),
        start("motion", k.motion, true_motion(state), noise.motion, MotionReading),
        by_name(names)(*more),
        joints,
    )
