"""Substitutes for invalid samples and lost sensors: last valid values, and predictions of the navigator."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, clip, maximum, where
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import ZERO, Vec3, apply_transposed
from tandemlift.parts.mechanics.rigid_body import UP, State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.sensors.health import PerSensor, SensorHealth, WatchdogReport, is_valid
from tandemlift.parts.sensors.readings import ImuReading, MotionReading

SETTLING_TIME = 2.0  # s: before bias estimates are averaged
AVERAGING_TIME = 5.0  # s: of their mean


class PredictedReadings(NamedTuple):
    """The prediction of the navigator: the state, and the bias of both inertial sensors [rad/s, m/s²]."""

    state: State
    gyroscope_bias: Vec3
    accelerometer_bias: Vec3


class MeanBiases(NamedTuple):
    """Means of the bias estimates [rad/s, m/s²], and the time of averaging, less `SETTLING_TIME` [s]."""

    gyroscope: Vec3
    accelerometer: Vec3
    time: Number


@law
def mean_after(m: MeanBiases, p: PredictedReadings, wrong: Number, dt: Number) -> MeanBiases:
    """The means with the present bias estimates, unless something is `wrong` (1)."""
    time = m.time + dt * (1.0 - wrong)
    gain = dt / clip(time, dt, AVERAGING_TIME) * (1.0 - wrong)
    return MeanBiases(
        m.gyroscope + (p.gyroscope_bias - m.gyroscope) * gain,
        m.accelerometer + (p.accelerometer_bias - m.accelerometer) * gain,
        time,
    )


@law
def valid_imu(last: ImuReading, imu: ImuReading, h: PerSensor[SensorHealth]) -> ImuReading:
    """The IMU's sample with the last valid value in place of each that is invalid."""
    joints = is_valid(h.joints)
    return imu._replace(
        specific_force=chosen(is_valid(h.accelerometer), imu.specific_force, last.specific_force),
        rates=chosen(is_valid(h.gyroscope), imu.rates, last.rates),
        joint_force=chosen(joints, imu.joint_force, last.joint_force),
        joint_torque=chosen(joints, imu.joint_torque, last.joint_torque),
    )


@law
def substituted_imu(
    imu: ImuReading, r: WatchdogReport, rates: Vec3, p: PredictedReadings, mean: MeanBiases
) -> ImuReading:
    """The IMU's sample with substitutes for lost sensors.

    While the navigator cannot estimate a bias, the mean bias is subtracted from the sensor's reading.
    """
    at_rest = apply_transposed(rotation_from_quaternion(p.state.attitude), UP * GRAVITY) + p.accelerometer_bias
    no_attitude = maximum(r.motion, r.attitude)
    no_motion = maximum(r.motion, maximum(r.position, r.velocity))
    specific_force = imu.specific_force + chosen(no_motion, p.accelerometer_bias - mean.accelerometer, ZERO)
    measured_rates = imu.rates + chosen(no_attitude, p.gyroscope_bias - mean.gyroscope, ZERO)
    return imu._replace(
        specific_force=chosen(maximum(r.accelerometer, r.imu), at_rest, specific_force),
        rates=chosen(maximum(r.gyroscope, r.imu), rates + p.gyroscope_bias, measured_rates),
    )


@law
def substituted_motion(
    v: MotionReading, h: PerSensor[SensorHealth], r: WatchdogReport, velocity: Vec3, p: PredictedReadings
) -> MotionReading:
    """A motion sample with the prediction in place of invalid or lost values; `velocity`: from the position."""
    position = maximum(maximum(r.position, h.position.failure), r.motion)
    no_velocity = maximum(maximum(r.velocity, h.velocity.failure), r.motion)
    attitude = maximum(maximum(r.attitude, h.attitude.failure), r.motion)
    any_left = where(position > 0.0, where(no_velocity > 0.0, where(attitude > 0.0, 0.0, 1.0), 1.0), 1.0)
    return MotionReading(
        chosen(position, p.state.position, v.position),
        chosen(no_velocity, chosen(position, p.state.velocity, velocity), v.velocity),
        chosen(attitude, p.state.attitude, v.attitude),
        v.fresh * any_left,
    )
