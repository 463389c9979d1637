"""Faults of sensors, which change their readings between the sensor and the pilot.

From one step until another, a sensor repeats its last value (frozen), gives no numbers (nan), has an offset (bias), or
gives a constant value (range); a device sends no new sample (stale). The laws are mapped over the channels of
every device. The type of a fault picks its law; a channel without a fault of its own has `NoFault`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple, TypeAlias

from tandemlift.core.algebra import chosen, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import NEVER, Number
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each, vec3
from tandemlift.parts.mechanics.rotation import rotated_by
from tandemlift.parts.sensors.noise_bias_drift import S, Sample
from tandemlift.parts.sensors.readings import (
    AdditionalChannels,
    Channels,
    ImuChannels,
    MotionChannels,
    R,
    Readings,
    by_name,
)
from tandemlift.parts.sensors.sensors_table import SensorFaultTable
from tandemlift.parts.sensors.vehicle_sensors import additional_sensor, sensors_named


class SensorFault(NamedTuple):
    """Faults of a sensor of a vector, or sets, a value for each joint: from step `start` until before step `end`.

    `frozen` is 1 if it repeats its last value, else 0. Else a reading x becomes x `keep` + `size` + `poison`, with
    `poison` 0 or NaN.
    """

    start: Number
    end: Number
    frozen: Number
    keep: Number
    size: Vec3
    poison: Number


class AttitudeFault(NamedTuple):
    """A fault of the attitude: while the reading is kept, it is rotated by `size` [rad, body axes]."""

    fault: SensorFault


class ScalarFault(NamedTuple):
    """A fault of a sensor of a number: the first component of `size` counts."""

    fault: SensorFault


class NoFault(NamedTuple):
    """The fault of a channel that does not fail on its own."""


ChannelFault: TypeAlias = SensorFault | AttitudeFault | ScalarFault | NoFault


class DeviceFaults(NamedTuple):
    """Faults of a device: no new sample from step `start` until before step `end`; and the faults of its channels."""

    start: Number
    end: Number
    channels: Channels[ChannelFault]


class SensorFaults(NamedTuple):
    """Faults of all devices; those of additional sensors by name."""

    imu: DeviceFaults
    motion: DeviceFaults
    additional: Any = Absent()


class SensorFaultState(NamedTuple):
    """Memory: the last readings that were passed on, and the number of the step."""

    given: Readings
    step: Number


@law
def during(start: Number, end: Number, step: Number) -> Number:
    """1 from a step on until before another, else 0."""
    return where(step < start, 0.0, where(step < end, 1.0, 0.0))


@elementwise
def faulty_number(
    x: Number,
    given: Number,
    size: Number,
    start: Number,
    end: Number,
    frozen: Number,
    keep: Number,
    poison: Number,
    step: Number,
) -> Number:
    """A number under a fault; `given`: the last one that was passed on."""
    wrong = where(frozen > 0.0, given, x * keep + size + poison)
    return where(step < start, x, where(step < end, wrong, x))


@choice(instead={NoFault: "x"})
def faulty(fault: ChannelFault, x: S, given: S, step: Number) -> S:
    """A reading x under a fault at a step; `given`: the last one that was passed on."""


@faulty.register(SensorFault)
def _faulty_vector(f: SensorFault, x: Vec3, given: Vec3, step: Number) -> Vec3:
    return Vec3(
        *[
            faulty_number(now, last, size, f.start, f.end, f.frozen, f.keep, f.poison, step)
            for now, last, size in zip(x, given, f.size, strict=True)
        ]
    )


@faulty.register(ScalarFault)
def _faulty_scalar(k: ScalarFault, x: Number, given: Number, step: Number) -> Number:
    f = k.fault
    return faulty_number(x, given, f.size.x, f.start, f.end, f.frozen, f.keep, f.poison, step)


@faulty.register(AttitudeFault)
def _faulty_attitude(k: AttitudeFault, x: Quat, given: Quat, step: Number) -> Quat:
    f = k.fault
    off = f.size.x * (1.0 - f.keep)
    q = rotated_by(x, f.size * (f.keep * during(f.start, f.end, step)))
    return Quat(
        *[
            faulty_number(now, last, off, f.start, f.end, f.frozen, f.keep, f.poison, step)
            for now, last in zip(q, given, strict=True)
        ]
    )


@law
def faulty_device(f: DeviceFaults, reading: R, given: R, step: Number) -> R:
    """The sample of a device under its faults; while it is stale, the last one that was passed on, not fresh."""
    stale = during(f.start, f.end, step)
    samples = [faulty(*channel, step) for channel in zip(f.channels, reading[:-1], given[:-1], strict=True)]
    held: list[Sample] = [chosen(stale, old, new) for old, new in zip(given[:-1], samples, strict=True)]
    return type(reading)._make([*held, where(stale > 0.0, 0.0, reading.fresh)])


@law
def apply_faults(k: SensorFaults, m: SensorFaultState, readings: Readings) -> tuple[Readings, SensorFaultState]:
    """(Readings as they are passed on, the new memory) of a step."""
    given, n = m.given, m.step
    more = [
        faulty_device(*device, n) for device in zip(k.additional, readings.additional, given.additional, strict=True)
    ]
    after = Readings(
        faulty_device(k.imu, readings.imu, given.imu, n),
        faulty_device(k.motion, readings.motion, given.motion, n),
        type(readings.additional)(*more),
    )
    return after, SensorFaultState(after, n + 1.0)


SOUND = SensorFault(NEVER, NEVER, frozen=0.0, keep=1.0, size=ZERO, poison=0.0)


def sensor_faults_from(
    tables: Sequence[SensorFaultTable], count: int, additional: Sequence[str], step: float
) -> SensorFaults:
    """The faults of every sensor, of `count` joints and of the additional sensors by name, for steps of `step` [s]."""
    stale, faults, joints = dict[str, tuple[float, float]](), dict[str, SensorFault](), [SOUND] * count
    for f in tables:
        if f.kind == "stale":
            stale[f.sensor] = _steps(f, step)
            continue
        fault, names = _fault_from(f, step), sensors_named(f.sensor)
        faults |= dict.fromkeys(names, fault)
        if "joints" in names:
            joints = [fault if f.quadrotor in (None, i) else old for i, old in enumerate(joints, 1)]

    def of(name: str) -> SensorFault:
        return faults.get(name, SOUND)

    def device(name: str, channels: Channels[ChannelFault]) -> DeviceFaults:
        return DeviceFaults(*stale.get(name, (NEVER, NEVER)), channels)

    def alone(name: str) -> DeviceFaults:
        fault = of(name) if additional_sensor(name).width == 3 else ScalarFault(of(name))
        return device(name, AdditionalChannels(fault))

    force, torque = _faults_of_joints(joints) if joints else (NoFault(), NoFault())
    imu = ImuChannels[ChannelFault](of("accelerometer"), of("gyroscope"), force, torque, frame=NoFault())
    motion = MotionChannels[ChannelFault](of("position"), of("velocity"), AttitudeFault(of("attitude")))
    return SensorFaults(
        device("imu", imu), device("motion", motion), by_name(tuple(additional))(*map(alone, additional))
    )


def _fault_from(f: SensorFaultTable, step: float) -> SensorFault:
    start, end = _steps(f, step)
    return SensorFault(
        start,
        end,
        frozen=float(f.kind == "frozen"),
        keep=0.0 if f.kind == "range" else 1.0,
        size=vec3(f.size) if f.kind in ("bias", "range") else ZERO,
        poison=math.nan if f.kind == "nan" else 0.0,
    )


def _steps(f: SensorFaultTable, step: float) -> tuple[float, float]:
    """The first step with a fault, and the first one without it again."""
    until = math.inf if f.until is None else f.until
    start, end = (float(round(min(time / step, NEVER))) for time in (f.time, until))
    return start, end


def _faults_of_joints(faults: Sequence[SensorFault]) -> tuple[SensorFault, SensorFault]:
    """The faults of the force sensors at all joints as one, of sets, and those of the torque that go with them."""
    cls = each(len(faults))
    size = Vec3(*[cls(*[f.size[i] for f in faults]) for i in range(3)])
    start, end, frozen, keep, poison = (
        cls(*[getattr(f, name) for f in faults]) for name in ("start", "end", "frozen", "keep", "poison")
    )
    force = SensorFault(start, end, frozen, keep, size, poison)
    return force, force._replace(size=Vec3(*[s - s * keep for s in size]))  # an offset is of the force alone
