"""Readings of all sensors: every device samples on its own clock and holds its last sample.

The inertial measurement unit (IMU) holds an accelerometer at the payload's origin and a gyroscope; the
force-torque sensors at the joints run on its clock; all read in body axes. The motion measurement reads position and
velocity of the system's centre of mass in world axes, and the attitude. An additional sensor is a device of its own
(`additional_sensors`). Between samples the last one is held, no longer fresh. Delays from the sensors to the pilot are
in the loop (`simulation.loop.sources`).
"""

from __future__ import annotations

from functools import cache
from typing import Any, Generic, NamedTuple, Protocol, TypeAlias, TypeVar

from tandemlift.core.algebra import selected, where
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent, Quat, Vec3
from tandemlift.parts.mechanics.loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.noise_bias_drift import (
    PERFECT,
    AttitudeNoise,
    ChannelModel,
    Drift,
    NoError,
    Sample,
    SensorGrade,
    WhiteNoise,
    next_drift,
    no_noise,
    read,
    sensor_model,
    start_drift,
)
from tandemlift.parts.sensors.sensor_registry import true_value

NONE = Absent()
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


class MotionChannels(NamedTuple, Generic[T]):
    """One value for each quantity of the motion measurement: position [m], velocity [m/s] and attitude."""

    position: T
    velocity: T
    attitude: T


class AdditionalChannels(NamedTuple, Generic[T]):
    """One value for the quantity of an additional sensor."""

    value: T


Channels: TypeAlias = ImuChannels[T] | MotionChannels[T] | AdditionalChannels[T]


class ImuReading(NamedTuple):
    """A sample of `ImuChannels`, body axes; `fresh` is 1 in the step in which it was taken, else 0."""

    specific_force: Vec3
    rates: Vec3
    joint_force: Vec3
    joint_torque: Vec3
    frame: Quat
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


R = TypeVar("R", ImuReading, MotionReading, AdditionalReading)


class Readings(NamedTuple):
    """The last samples of all devices; of additional sensors, by name."""

    imu: ImuReading
    motion: MotionReading
    additional: Any = Absent()


class Device(Protocol):
    """A device: the models of its channels, and the steps from one sample to the next."""

    @property
    def channels(self) -> Channels[ChannelModel]:
        """Their models."""

    @property
    def period(self) -> Number:
        """In steps."""


class DeviceModel(NamedTuple):
    """A device: the models of its channels, and the steps from one sample to the next."""

    channels: ImuChannels[ChannelModel] | MotionChannels[ChannelModel]
    period: Number


class DeviceState(NamedTuple, Generic[R]):
    """Memory of a device: its last sample, the drifts of its channels, and the steps to wait for the next sample."""

    reading: R
    drift: Channels[Drift]
    wait: Number


class Sensors(NamedTuple):
    """All devices; the additional ones by name."""

    imu: DeviceModel
    motion: DeviceModel
    additional: Any = Absent()


class SensorState(NamedTuple):
    """Memory of all devices."""

    imu: DeviceState[ImuReading]
    motion: DeviceState[MotionReading]
    additional: Any = Absent()


class SensorNoise(NamedTuple):
    """Independent standard normals for one step, for every channel of every device."""

    imu: ImuChannels[Drift]
    motion: MotionChannels[Drift]
    additional: Any = Absent()


@law
def sample_channels(
    models: Channels[ChannelModel], drift: Channels[Drift], truth: Channels[Sample], normals: Channels[Drift]
) -> Channels[Sample]:
    """A sample of every channel of a device."""
    return type(truth)(*[read(*channel) for channel in zip(models, drift, truth, normals, strict=True)])


@law
def sample_device(k: Device, m: DeviceState[R], truth: Channels[Sample], normals: Channels[Drift]) -> DeviceState[R]:
    """The memory of a device after a step: with a fresh sample if one is due, else with the last, no longer fresh."""
    due = m.wait <= 0.0
    fresh, samples = where(due, 1.0, 0.0), sample_channels(k.channels, m.drift, truth, normals)
    held: list[Sample] = [selected(due, new, old) for new, old in zip(samples, m.reading[:-1], strict=True)]
    drift = [next_drift(*channel, fresh) for channel in zip(k.channels, m.drift, normals, strict=True)]
    reading, after = type(m.reading)._make([*held, fresh]), type(m.drift)(*drift)
    return DeviceState(reading, after, where(due, k.period, m.wait) - 1.0)


@law
def true_imu(state: State, perfect: PerfectReadings, believed: Quat) -> ImuChannels[Sample]:
    """The readings of the IMU and the joints' sensors without errors."""
    return ImuChannels(perfect.specific_force, state.rates, perfect.joint_force, perfect.joint_torque, believed)


@law
def true_motion(state: State) -> MotionChannels[Sample]:
    """The readings of the motion measurement without errors."""
    return MotionChannels(state.position, state.velocity, state.attitude)


@law
def true_additional(sensor: object, state: State, perfect: PerfectReadings) -> AdditionalChannels[Sample]:
    """The reading of an additional sensor without errors."""
    return AdditionalChannels(true_value(sensor, state, perfect))


@law
def sense(
    k: Sensors, m: SensorState, state: State, perfect: PerfectReadings, believed: Quat, noise: SensorNoise
) -> tuple[Readings, SensorState]:
    """(Readings, the new memory) of a step in which the pilot's attitude estimate was `believed`."""
    more = [
        sample_device(sensor, memory, true_additional(sensor, state, perfect), normals)
        for sensor, memory, normals in zip(k.additional, m.additional, noise.additional, strict=True)
    ]
    imu = sample_device(k.imu, m.imu, true_imu(state, perfect, believed), noise.imu)
    motion = sample_device(k.motion, m.motion, true_motion(state), noise.motion)
    after = SensorState(imu, motion, type(m.additional)(*more))
    return readings_of(after), after


@law
def readings_of(m: SensorState) -> Readings:
    """The last samples of all devices."""
    return Readings(m.imu.reading, m.motion.reading, type(m.additional)(*[device.reading for device in m.additional]))


@cache
def by_name(names: tuple[str, ...]) -> Any:
    """The type of values by name, one for each additional sensor; `Absent` for none."""
    return NamedTuple("_".join(("ByName", *names)), [(name, Any) for name in names]) if names else Absent


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
        imu_period: of the IMU and the joints, in whole steps.
        motion_period: of the motion measurement, in whole steps.
        additional: parameters of additional sensors by name (`by_name`).
    """
    interval = step * imu_period
    imu: ImuChannels[ChannelModel] = ImuChannels(
        specific_force=sensor_model(accelerometer, interval),
        rates=sensor_model(gyroscope, interval),
        joint_force=sensor_model(force, interval, count),
        joint_torque=sensor_model(torque, interval, count),
        frame=NoError(),
    )
    noise = WhiteNoise(position_noise), WhiteNoise(velocity_noise), AttitudeNoise(attitude_noise)
    motion: MotionChannels[ChannelModel] = MotionChannels(*noise)
    return Sensors(DeviceModel(imu, float(imu_period)), DeviceModel(motion, float(motion_period)), additional)


def zero_noise(k: Sensors) -> SensorNoise:
    """Standard normals of 0 for one step of these sensors."""
    imu, motion = ImuChannels(*map(no_noise, k.imu.channels)), MotionChannels(*map(no_noise, k.motion.channels))
    more = [AdditionalChannels(*map(no_noise, sensor.channels)) for sensor in k.additional]
    return SensorNoise(imu, motion, type(k.additional)(*more))


def start_sensing(k: Sensors, state: State, perfect: PerfectReadings, believed: Quat) -> SensorState:
    """The memory before the first step: readings of a state, with bias but without noise, and not fresh.

    Every device takes its first sample in the first step.
    """
    noise = zero_noise(k)

    def start(
        k: Device, drift: Channels[Drift], truth: Channels[Sample], normals: Channels[Drift], kind: type[R]
    ) -> DeviceState[R]:
        return DeviceState(kind._make([*sample_channels(k.channels, drift, truth, normals), 0.0]), drift, 0.0)

    imu, motion = ImuChannels(*map(start_drift, k.imu.channels)), MotionChannels(*map(start_drift, k.motion.channels))
    more = []
    for device, normals in zip(k.additional, noise.additional, strict=True):
        drift, truth = AdditionalChannels(*map(start_drift, device.channels)), true_additional(device, state, perfect)
        more.append(start(device, drift, truth, normals, AdditionalReading))
    return SensorState(
        start(k.imu, imu, true_imu(state, perfect, believed), noise.imu, ImuReading),
        start(k.motion, motion, true_motion(state), noise.motion, MotionReading),
        by_name(getattr(k.additional, "_fields", ()))(*more),
    )
