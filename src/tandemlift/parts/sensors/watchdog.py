"""Watchdogs on every measurement: stale, frozen, not a number, out of range, or inconsistent with another one.

A sample is valid if it is fresh, finite and within its range. An invalid one goes no further: the last valid value
takes its place or, in the motion measurement, the prediction of the navigator. A sensor is *lost* once its samples have
been invalid for a time, or identical too often although noise is expected, or once its device has been stale for a
time. The substitute for a lost accelerometer is the reading of a vehicle that does not accelerate; for a lost gyroscope
it is the low-passed derivative of the measured attitude, for a lost velocity that of the measured position. While the
navigator runs without the motion measurement, it uses the mean of its bias estimates, which is less noisy than the last
one (`substitutes`). Redundant measurements are compared with each other (`consistency`).
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

from pydantic import Field

from tandemlift.core.algebra import chosen, exp, maximum, minimum, where
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.law import law
from tandemlift.core.types import Number, filled
from tandemlift.core.vector import ZERO, Quat, Vec3, dot
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_between
from tandemlift.parts.sensors.consistency import Inconsistency, exceeds, inconsistency_after
from tandemlift.parts.sensors.health import (
    FROZEN,
    AttitudeLimits,
    JointLimits,
    NoLimits,
    PerSensor,
    SensorHealth,
    SensorLimits,
    VectorLimits,
    WatchdogReport,
    any_component,
    is_valid,
    judge,
    not_finite,
)
from tandemlift.parts.sensors.readings import ImuReading, MotionReading, Readings
from tandemlift.parts.sensors.sensors_table import SensorsTable, as_simulated, joint_steps, steps_of
from tandemlift.parts.sensors.substitutes import (
    SETTLING_TIME,
    MeanBiases,
    PredictedReadings,
    mean_after,
    substituted_imu,
    substituted_motion,
    valid_imu,
)

Samples = Annotated[int, Field(ge=2, le=1_000_000)]
FAR = "chosen: larger than expected in flight"


class WatchTable(Table):
    """`[supervision.watchdog]`: watchdogs on every sensor."""

    stale_time: Positive = key(
        0.1,
        "s",
        "time without a fresh sample after which a device counts as stale",
        rule="above the sampling intervals",
        source="chosen",
    )
    invalid_time: Positive = key(
        0.05,
        "s",
        "time without a valid sample after which a sensor counts as lost",
        rule="above the sampling intervals",
        source="chosen",
    )
    frozen_samples: Samples = key(
        25, "1", "number of identical samples after which a sensor that has noise counts as frozen", source="chosen"
    )
    max_force: Positive = key(100.0, "N", "largest plausible force at a joint", source=FAR)
    max_torque: Positive = key(20.0, "N m", "largest plausible torque at a joint", source=FAR)
    max_specific_force: Positive = key(80.0, "m/s²", "largest plausible reading of the accelerometer", source=FAR)
    max_rates: Positive = key(15.0, "rad/s", "largest plausible reading of the gyroscope", source=FAR)
    max_position: Positive = key(100.0, "m", "largest plausible coordinate of the position", source=FAR)
    max_velocity: Positive = key(20.0, "m/s", "largest plausible component of the velocity", source=FAR)
    window: Positive = key(0.5, "s", "time over which measurements are compared with each other", source="chosen")
    attitude_gap: Positive = key(0.1, "rad", "largest difference between attitude and gyroscope", source="chosen")
    position_gap: Positive = key(0.1, "m", "largest difference between position and velocity", source="chosen")
    speed_gap: Positive = key(0.3, "m/s", "largest difference between velocity and accelerometer", source="chosen")
    joints_time: NonNegative = key(0.1, "s", "time for which the joints may disagree", source="chosen")
    rates_bandwidth: Positive = key(
        60.0, "rad/s", "bandwidth of the rates from the attitude, which replace a lost gyroscope", source="chosen"
    )
    velocity_bandwidth: Positive = key(
        10.0, "rad/s", "bandwidth of the velocity from the position, which replaces a lost velocity", source="chosen"
    )


class Watchdog(NamedTuple):
    """Limits of the watchdogs.

    A device is stale after `stale_time` [s] without a fresh sample, a sensor lost after `invalid_time` [s] without a
    valid one; `sensors`: its limits in `health`. Largest differences of redundant measurements: `attitude_gap` [rad],
    `position_gap` [m] and `velocity_gap` [m/s], over a window of which `forgetting` is 1 − λ. Low-pass gains of
    substituted rates and velocity, and the rate of motion samples [1/s].
    """

    stale_time: Number
    invalid_time: Number
    sensors: PerSensor[SensorLimits]
    forgetting: Number
    attitude_gap: Number
    position_gap: Number
    velocity_gap: Number
    rates_gain: Number
    velocity_gain: Number
    motion_rate: Number


class WatchdogState(NamedTuple):
    """Memory: the last readings, the last valid ones, the health of the sensors, and of each device its age.

    An age [s] is the time since the last fresh sample; `imu_seen` and `motion_seen` are 1 after the first. `rates` and
    `velocity`: substitutes for those of a lost sensor.
    """

    last: Readings
    valid: Readings
    health: PerSensor[SensorHealth]
    imu_age: Number
    motion_age: Number
    imu_seen: Number
    motion_seen: Number
    rates: Vec3
    velocity: Vec3
    mean: MeanBiases
    inconsistency: Inconsistency


@law
def lost(k: Watchdog, h: SensorHealth, limits: SensorLimits) -> Number:
    """The symptom of a lost sensor (`SYMPTOMS`, from 1), or 0."""
    invalid = where(h.invalid_time >= k.invalid_time, h.failure, 0.0)
    return where(h.failure > 0.0, invalid, where(h.identical >= limits.frozen_samples, FROZEN, 0.0))


@law
def report_of(
    k: Watchdog, h: PerSensor[SensorHealth], imu_age: Number, motion_age: Number, seen: Number, d: Inconsistency
) -> WatchdogReport:
    """The report for devices with these ages [s]; `seen` is 1 once both have sent a sample."""
    failures = PerSensor(*[lost(k, *sensor) for sensor in zip(h, k.sensors, strict=True)])
    return WatchdogReport(
        imu=where(imu_age >= k.stale_time, 1.0, 0.0),
        motion=where(motion_age >= k.stale_time, 1.0, 0.0),
        **failures._asdict(),
        attitude_inconsistent=exceeds(d.attitude, k.attitude_gap),
        velocity_inconsistent=exceeds(d.position, k.position_gap),
        speed_inconsistent=exceeds(d.velocity, k.velocity_gap),
        seen=seen,
    )


@law
def substitute_rates(
    k: Watchdog,
    m: WatchdogState,
    imu: ImuReading,
    attitude: Quat,
    fresh: Number,
    measured: Number,
    p: PredictedReadings,
) -> Vec3:
    """The rates [rad/s]: of the gyroscope while they are `measured` (1), else the derivative of the attitude."""
    derivative = rotation_between(m.valid.motion.attitude, attitude) * k.motion_rate
    return chosen(measured, imu.rates - p.gyroscope_bias, m.rates + (derivative - m.rates) * (k.rates_gain * fresh))


@law
def substitute_velocity(
    k: Watchdog, m: WatchdogState, v: MotionReading, h: PerSensor[SensorHealth], r: WatchdogReport
) -> Vec3:
    """The velocity [m/s]: as measured while that is valid, else the derivative of the position."""
    measured = is_valid(h.velocity) * where(r.velocity > 0.0, 0.0, 1.0)
    position = chosen(is_valid(h.position), v.position, m.valid.motion.position)
    derivative = (position - m.valid.motion.position) * k.motion_rate
    gain = k.velocity_gain * v.fresh * is_valid(h.position)
    return chosen(measured, v.velocity, m.velocity + (derivative - m.velocity) * gain)


@law
def any_invalid(h: PerSensor[SensorHealth]) -> Number:
    """1 if the last sample of any sensor that is compared was invalid, else 0."""
    motion = is_valid(h.attitude) * is_valid(h.position) * is_valid(h.velocity)
    return 1.0 - is_valid(h.gyroscope) * is_valid(h.accelerometer) * motion


@law
def any_lost(r: WatchdogReport) -> Number:
    """1 if any sensor that is compared is lost, else 0."""
    imu = r.imu + r.gyroscope + r.accelerometer
    return where(imu + r.motion + r.attitude + r.position + r.velocity > 0.0, 1.0, 0.0)


@law
def watchdog_step(
    k: Watchdog, m: WatchdogState, readings: Readings, p: PredictedReadings, dt: Number
) -> tuple[Readings, WatchdogReport, WatchdogState]:
    """(usable readings, `WatchdogReport`, the new memory) after a step of dt [s] with the navigator's prediction."""
    v, health = readings.motion, judge(k.sensors, m.health, m.last, readings, dt)
    m = m._replace(
        imu_age=(m.imu_age + dt) * (1.0 - readings.imu.fresh),
        motion_age=(m.motion_age + dt) * (1.0 - v.fresh),
        imu_seen=maximum(m.imu_seen, readings.imu.fresh),
        motion_seen=maximum(m.motion_seen, v.fresh),
    )
    seen = m.imu_seen * m.motion_seen
    # this report decides what is substituted; the one below adds what the substituted readings then disagree about
    before = report_of(k, health, m.imu_age, m.motion_age, seen, m.inconsistency)
    kept, attitude_valid = valid_imu(m.valid.imu, readings.imu, health), is_valid(health.attitude)
    attitude = chosen(attitude_valid, v.attitude, m.valid.motion.attitude)
    measured = where(before.gyroscope + before.imu > 0.0, 0.0, 1.0)
    rates = substitute_rates(k, m, kept, attitude, v.fresh * attitude_valid, measured, p)
    wrong, velocity = maximum(any_invalid(health), any_lost(before)), substitute_velocity(k, m, v, health, before)
    mean = mean_after(m.mean, p, wrong, dt)
    imu, motion = substituted_imu(kept, before, rates, p, mean), substituted_motion(v, health, before, velocity, p)
    difference = inconsistency_after(k.forgetting, m.inconsistency, imu, motion, wrong, dt)
    position = chosen(is_valid(health.position), v.position, m.valid.motion.position)
    after = m._replace(
        last=readings,
        valid=readings._replace(imu=kept, motion=motion._replace(position=position, attitude=attitude)),
        health=health,
        rates=rates,
        velocity=velocity,
        mean=mean,
        inconsistency=difference,
    )
    report = report_of(k, health, m.imu_age, m.motion_age, seen, difference)
    return readings._replace(imu=imu, motion=motion), report, after


def start_watchdog(readings: Readings) -> WatchdogState:
    """The memory before the first step, in which both devices have read `readings`, not fresh."""
    v = readings.motion
    return WatchdogState(
        last=readings,
        valid=readings,
        health=PerSensor(*[SensorHealth(0.0, 0.0, 0.0)] * len(PerSensor._fields)),
        imu_age=0.0,
        motion_age=0.0,
        imu_seen=0.0,
        motion_seen=0.0,
        rates=ZERO,
        velocity=v.velocity,
        mean=MeanBiases(ZERO, ZERO, -SETTLING_TIME),
        inconsistency=Inconsistency(
            attitude=ZERO,
            position=ZERO,
            velocity=ZERO,
            integrated_attitude=v.attitude,
            integrated_position=v.position,
            integrated_velocity=v.velocity,
        ),
    )


@law
def state_not_finite(s: State) -> Number:
    """1 if any number of a state is not finite, else 0."""
    motion = maximum(any_component(not_finite(s.position)), any_component(not_finite(s.velocity)))
    return maximum(motion, maximum(any_component(not_finite(s.rates)), not_finite(dot(s.attitude, s.attitude))))


def watchdog_from(w: WatchTable, s: SensorsTable, step: float) -> Watchdog:
    """The watchdogs on every sensor, for steps of `step` [s]; a sensor without noise is never frozen."""
    s = as_simulated(s)

    def frozen(noise: Number, held: int = 1) -> Number:
        return where(noise > 0.0, float(w.frozen_samples * held), math.inf)

    held = -(-(joint_steps(s, step) or 1) // steps_of(s.interval, step))  # samples of the imu with one of the joints
    interval = step * steps_of(s.motion.interval, step)
    joints: SensorLimits = JointLimits(w.max_force, w.max_torque, frozen(s.joints.force_noise, held))
    return filled(
        Watchdog,
        w,
        sensors=PerSensor(
            joints=joints if s.joints.model != "none" else NoLimits(math.inf),
            accelerometer=VectorLimits(w.max_specific_force, frozen(s.accelerometer.noise)),
            gyroscope=VectorLimits(w.max_rates, frozen(s.gyroscope.noise)),
            position=VectorLimits(w.max_position, frozen(s.motion.position_noise)),
            velocity=VectorLimits(w.max_velocity, frozen(s.motion.velocity_noise)),
            attitude=AttitudeLimits(frozen(s.motion.attitude_noise)),
        ),
        forgetting=minimum(interval / w.window, 1.0),
        velocity_gap=w.speed_gap,
        rates_gain=1.0 - exp(-w.rates_bandwidth * interval),
        velocity_gain=1.0 - exp(-w.velocity_bandwidth * interval),
        motion_rate=1.0 / interval,
    )
