"""Sensors that fail: what becomes of their readings between the sensor and the pilot.

From a step on, until another, a sensor repeats its last value, gives no numbers, has an offset, or gives one value
whatever happens; a device (the unit on board, the motion measurement) sends nothing new.
"""

import math
from typing import Any, NamedTuple

from tandemlift.algebra.law import elementwise, law
from tandemlift.algebra.ops import where
from tandemlift.algebra.vector import ZERO, Quat, Vec3, each
from tandemlift.laws.mechanics.rotation import rotated_by
from tandemlift.laws.sensors.readings import ImuReading, MotionReading, Readings

NEVER = 1e18  # steps


class SensorFault(NamedTuple):
    """Of one sensor, or sets, a value for each joint: from step `start` until before step `end`.

    `frozen` is 1 if it repeats its last value, else 0. Else a reading x becomes x `keep` + `size` + `poison`, with
    `poison` 0 or NaN; an attitude that is kept is turned by `size` [rad, body axes].
    """

    start: Any
    end: Any
    frozen: Any
    keep: Any
    size: Vec3
    poison: Any


class DeviceSilence(NamedTuple):
    """From step `start` until before step `end`, a device sends no new sample."""

    start: Any
    end: Any


class SensorFaults(NamedTuple):
    """Of both devices, and of every sensor on them."""

    imu: DeviceSilence
    motion: DeviceSilence
    joints: SensorFault
    accelerometer: SensorFault
    gyroscope: SensorFault
    position: SensorFault
    velocity: SensorFault
    attitude: SensorFault


class SensorFaultState(NamedTuple):
    """Memory: what was given last, and the number of the step."""

    given: Readings
    step: Any


@law
def during(start: Any, end: Any, step: Any) -> Any:
    """1 from a step on until before another, else 0."""
    return where(step < start, 0.0, where(step < end, 1.0, 0.0))


@elementwise
def spoiled(x, given, size, start, end, frozen, keep, poison, step):
    """A reading under a fault; `given`: the last one."""
    wrong = where(frozen > 0.0, given, x * keep + size + poison)
    return where(step < start, x, where(step < end, wrong, x))


@law
def spoil_vector(f: SensorFault, x: Vec3, given: Vec3, step: Any) -> Vec3:
    """A vector's reading under a fault."""
    return spoiled(x, given, f.size, f.start, f.end, f.frozen, f.keep, f.poison, step)


@law
def spoil_joints(f: SensorFault, x: Vec3, given: Vec3, size: Vec3, step: Any) -> Vec3:
    """The joints' readings, vectors of sets, under a fault of each."""
    return Vec3(
        spoiled(x.x, given.x, size.x, f.start, f.end, f.frozen, f.keep, f.poison, step),
        spoiled(x.y, given.y, size.y, f.start, f.end, f.frozen, f.keep, f.poison, step),
        spoiled(x.z, given.z, size.z, f.start, f.end, f.frozen, f.keep, f.poison, step),
    )


@law
def spoil_attitude(f: SensorFault, x: Quat, given: Quat, step: Any) -> Quat:
    """An attitude's reading under a fault."""
    off = f.size.x * (1.0 - f.keep)
    q = rotated_by(x, f.size * (f.keep * during(f.start, f.end, step)))
    return Quat(
        spoiled(q.w, given.w, off, f.start, f.end, f.frozen, f.keep, f.poison, step),
        spoiled(q.x, given.x, off, f.start, f.end, f.frozen, f.keep, f.poison, step),
        spoiled(q.y, given.y, off, f.start, f.end, f.frozen, f.keep, f.poison, step),
        spoiled(q.z, given.z, off, f.start, f.end, f.frozen, f.keep, f.poison, step),
    )


@law
def held_unit(silent: Any, new: ImuReading, old: ImuReading) -> ImuReading:
    """The new sample, or the old one, no longer fresh, while the unit is silent."""
    return ImuReading(
        chosen(silent, old.specific_force, new.specific_force),
        chosen(silent, old.rates, new.rates),
        chosen(silent, old.joint_force, new.joint_force),
        chosen(silent, old.joint_torque, new.joint_torque),
        chosen_attitude(silent, old.frame, new.frame),
        where(silent > 0.0, 0.0, new.fresh),
    )


@law
def held_motion(silent: Any, new: MotionReading, old: MotionReading) -> MotionReading:
    """The new sample, or the old one, no longer fresh, while the motion measurement is silent."""
    return MotionReading(
        chosen(silent, old.position, new.position),
        chosen(silent, old.velocity, new.velocity),
        chosen_attitude(silent, old.attitude, new.attitude),
        where(silent > 0.0, 0.0, new.fresh),
    )


@law
def chosen(flag: Any, a: Any, b: Any) -> Vec3:
    """Vector a where a flag is 1, else b; or vectors of sets."""
    on = flag > 0.0
    return Vec3(where(on, a.x, b.x), where(on, a.y, b.y), where(on, a.z, b.z))


@law
def chosen_attitude(flag: Any, a: Quat, b: Quat) -> Quat:
    """Attitude a where a flag is 1, else b."""
    on = flag > 0.0
    return Quat(where(on, a.w, b.w), where(on, a.x, b.x), where(on, a.y, b.y), where(on, a.z, b.z))


@law
def apply_faults(k: SensorFaults, m: SensorFaultState, readings: Readings) -> Any:
    """(Readings as they are given, the new memory) of a step."""
    u, v, n = readings.unit, readings.motion, m.step
    was, then = m.given.unit, m.given.motion
    size, keep = k.joints.size, k.joints.keep
    torque = Vec3(size.x - size.x * keep, size.y - size.y * keep, size.z - size.z * keep)  # an offset is of the force
    unit = ImuReading(
        spoil_vector(k.accelerometer, u.specific_force, was.specific_force, n),
        spoil_vector(k.gyroscope, u.rates, was.rates, n),
        spoil_joints(k.joints, u.joint_force, was.joint_force, size, n),
        spoil_joints(k.joints, u.joint_torque, was.joint_torque, torque, n),
        u.frame,
        u.fresh,
    )
    motion = MotionReading(
        spoil_vector(k.position, v.position, then.position, n),
        spoil_vector(k.velocity, v.velocity, then.velocity, n),
        spoil_attitude(k.attitude, v.attitude, then.attitude, n),
        v.fresh,
    )
    silent = during(k.imu.start, k.imu.end, n), during(k.motion.start, k.motion.end, n)
    given = Readings(held_unit(silent[0], unit, was), held_motion(silent[1], motion, then))
    return given, SensorFaultState(given, n + 1.0)


def sensor_fault(kind: str, start: float, end: float, size: Vec3) -> SensorFault:
    """The fault of one sensor: `kind` is "frozen", "nan", "bias" or "range"; steps, and the reading's unit."""
    frozen, poison = float(kind == "frozen"), math.nan if kind == "nan" else 0.0
    sized = size if kind in ("bias", "range") else ZERO
    return SensorFault(start, end, frozen, 0.0 if kind == "range" else 1.0, sized, poison)


def together(faults: list[SensorFault]) -> SensorFault:
    """The faults of all joints as one, of sets."""
    cls = each(len(faults))
    size = Vec3(*[cls(*[f.size[i] for f in faults]) for i in range(3)])
    start, end, frozen, keep, poison = (
        cls(*[getattr(f, name) for f in faults]) for name in ("start", "end", "frozen", "keep", "poison")
    )
    return SensorFault(start, end, frozen, keep, size, poison)


SOUND = sensor_fault("bias", NEVER, NEVER, ZERO)
