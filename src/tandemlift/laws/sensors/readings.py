"""What the sensors on the vehicle and around it read.

The on-board unit holds a force-torque sensor at every joint, an accelerometer at the payload's centre of mass and a
gyroscope, all on one clock, in body axes. The motion measurement sees the system's centre of mass in world axes, and
the attitude, on a clock of its own. Between samples the last one stands, no longer fresh. Time on the way from the
sensors to the pilot is not in here.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import where
from tandemlift.algebra.vector import ZERO, Quat, Vec3
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.loads import PerfectReadings
from tandemlift.laws.mechanics.rotation import rotated_by
from tandemlift.laws.sensors.sensor_errors import PERFECT, SensorGrade, SensorModel, no_drift, read, sensor_model


class ImuReading(NamedTuple):
    """A sample of the on-board unit, body axes; `fresh` is 1 in the step in which it was taken, else 0.

    Specific force at the payload's centre of mass [m/s²], rates [rad/s], and what each quadrotor puts on the payload at
    its joint: force [N] and torque [N·m], vectors of sets. `frame` is the attitude that the pilot then believed in.
    """

    specific_force: Vec3
    rates: Vec3
    joint_force: Vec3
    joint_torque: Vec3
    frame: Quat
    fresh: Any


class MotionReading(NamedTuple):
    """A sample of position [m] and velocity [m/s] of the centre of mass, world axes, and of the attitude."""

    position: Vec3
    velocity: Vec3
    attitude: Quat
    fresh: Any


class Readings(NamedTuple):
    """What both devices say."""

    unit: ImuReading
    motion: MotionReading


class Sensors(NamedTuple):
    """Meters of the unit; σ of the motion measurement: position [m], velocity [m/s], attitude [rad, about body axes].

    Periods are in steps from one sample to the next.
    """

    force: SensorModel
    torque: SensorModel
    accelerometer: SensorModel
    gyroscope: SensorModel
    position: Any
    velocity: Any
    attitude: Any
    unit_period: Any
    motion_period: Any


class SensorDrift(NamedTuple):
    """Random walks of the unit's meters."""

    force: Vec3
    torque: Vec3
    accelerometer: Vec3
    gyroscope: Vec3


class SensorState(NamedTuple):
    """Memory: the last readings, the drifts, and the steps to wait for the next samples."""

    readings: Readings
    drift: SensorDrift
    unit_wait: Any
    motion_wait: Any


class SensorNoise(NamedTuple):
    """Independent standard normals for one step, on everything that is read (at joints, vectors of sets)."""

    specific_force: Vec3
    rates: Vec3
    joint_force: Vec3
    joint_torque: Vec3
    position: Vec3
    velocity: Vec3
    attitude: Vec3


@law
def renewed(due: Any, new: Any, old: Any) -> Vec3:
    """The new vector, or vector of sets, where it is due, else the old one."""
    return Vec3(where(due, new.x, old.x), where(due, new.y, old.y), where(due, new.z, old.z))


@law
def renewed_attitude(due: Any, new: Quat, old: Quat) -> Quat:
    """The new attitude where it is due, else the old one."""
    return Quat(where(due, new.w, old.w), where(due, new.x, old.x), where(due, new.y, old.y), where(due, new.z, old.z))


@law
def sample_unit(
    k: Sensors, drift: SensorDrift, rates: Vec3, felt: PerfectReadings, frame: Quat, n: SensorNoise
) -> ImuReading:
    """A fresh sample of the on-board unit."""
    return ImuReading(
        read(k.accelerometer, drift.accelerometer, felt.specific_force, n.specific_force),
        read(k.gyroscope, drift.gyroscope, rates, n.rates),
        read(k.force, drift.force, felt.joint_force, n.joint_force),
        read(k.torque, drift.torque, felt.joint_torque, n.joint_torque),
        frame,
        1.0,
    )


@law
def sample_motion(k: Sensors, s: State, n: SensorNoise) -> MotionReading:
    """A fresh sample of the motion measurement."""
    return MotionReading(
        s.position + n.position * k.position,
        s.velocity + n.velocity * k.velocity,
        rotated_by(s.attitude, n.attitude * k.attitude),
        1.0,
    )


@law
def latest_unit(due: Any, new: ImuReading, old: ImuReading) -> ImuReading:
    """The new sample where it is due, else the old one, no longer fresh."""
    return ImuReading(
        renewed(due, new.specific_force, old.specific_force),
        renewed(due, new.rates, old.rates),
        renewed(due, new.joint_force, old.joint_force),
        renewed(due, new.joint_torque, old.joint_torque),
        renewed_attitude(due, new.frame, old.frame),
        where(due, 1.0, 0.0),
    )


@law
def latest_motion(due: Any, new: MotionReading, old: MotionReading) -> MotionReading:
    """The new sample where it is due, else the old one, no longer fresh."""
    return MotionReading(
        renewed(due, new.position, old.position),
        renewed(due, new.velocity, old.velocity),
        renewed_attitude(due, new.attitude, old.attitude),
        where(due, 1.0, 0.0),
    )


@law
def wander(k: Sensors, drift: SensorDrift, n: SensorNoise, sampled: Any) -> SensorDrift:
    """The drifts after a sample (`sampled` 1), or as they were (0)."""
    return SensorDrift(
        drift.force + n.joint_force * (k.force.walk * sampled),
        drift.torque + n.joint_torque * (k.torque.walk * sampled),
        drift.accelerometer + n.specific_force * (k.accelerometer.walk * sampled),
        drift.gyroscope + n.rates * (k.gyroscope.walk * sampled),
    )


@law
def sense(
    sensors: Sensors, memory: SensorState, state: State, felt: PerfectReadings, believed: Quat, hiss: SensorNoise
) -> Any:
    """(Readings, the new memory) of a step in which the pilot believed in the attitude `believed`."""
    unit_due, motion_due = memory.unit_wait <= 0.0, memory.motion_wait <= 0.0
    old = memory.readings
    unit = latest_unit(unit_due, sample_unit(sensors, memory.drift, state.rates, felt, believed, hiss), old.unit)
    motion = latest_motion(motion_due, sample_motion(sensors, state, hiss), old.motion)
    readings = Readings(unit, motion)
    return readings, SensorState(
        readings,
        wander(sensors, memory.drift, hiss, unit.fresh),
        where(unit_due, sensors.unit_period, memory.unit_wait) - 1.0,
        where(motion_due, sensors.motion_period, memory.motion_wait) - 1.0,
    )


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
    unit_period: int = 1,
    motion_period: int = 1,
) -> Sensors:
    """The sensors of a vehicle of `count` quadrotors; as they stand, perfect and sampled every step.

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
        unit_period: of the on-board unit, in whole steps.
        motion_period: of the motion measurement, in whole steps.
    """
    interval = step * unit_period
    return Sensors(
        sensor_model(force, interval, count),
        sensor_model(torque, interval, count),
        sensor_model(accelerometer, interval),
        sensor_model(gyroscope, interval),
        position_noise,
        velocity_noise,
        attitude_noise,
        float(unit_period),
        float(motion_period),
    )


def start_sensing(sensors: Sensors, state: State, felt: PerfectReadings, believed: Quat) -> SensorState:
    """The memory before the first step: readings of a state, biased but without noise, and not fresh.

    Both devices take their first sample in the first step.
    """
    count = len(sensors.force.bias.x)
    drift = SensorDrift(no_drift(count), no_drift(count), no_drift(), no_drift())
    silence = SensorNoise(ZERO, ZERO, no_drift(count), no_drift(count), ZERO, ZERO, ZERO)
    unit = sample_unit(sensors, drift, state.rates, felt, believed, silence)._replace(fresh=0.0)
    return SensorState(Readings(unit, sample_motion(sensors, state, silence)._replace(fresh=0.0)), drift, 0.0, 0.0)
