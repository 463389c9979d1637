"""Watchdogs on every measurement: what is stale, frozen, no number, out of range, or at odds with another.

A sensor's sample is good if it is fresh, finite and within its range. What is not good never gets further: the last
good value stands in its place or, in the motion measurement, what the navigator predicts. A sensor is *lost* once its
samples were not good for a time, or were exactly alike too often although noise is expected, or its device has sent
nothing for a time. For a lost accelerometer stands that of a vehicle that does not accelerate; for a lost gyroscope,
how fast the measured attitude turns, and for a lost velocity, how fast the position changes, low-passed. Where the
navigator must go on without the motion measurement, it does so with the mean of the biases that it has found, which is
quieter than their last value.

Measurements that should tell the same are compared over a window: the turn that gyroscope and attitude tell of, the way
that velocity and position do, the speed that accelerometer and velocity do. With ε what they differ by from one motion
sample to the next, d ← λ d + ε forgets over the window τ = T / (1 − λ): a jump shows as it is, a constant error b as
b τ.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import law
from tandemlift.algebra.ops import clip, maximum, where
from tandemlift.algebra.vector import ZERO, Quat, Vec3, apply, apply_transposed, dot
from tandemlift.laws.mechanics.body import UP, State
from tandemlift.laws.mechanics.rotation import rotated_by, rotation_between, rotation_from_quaternion
from tandemlift.laws.sensors.health import (
    FROZEN,
    FrozenLimits,
    ReadingRanges,
    SensorHealth,
    SensorHealths,
    any_of,
    judge,
    no_number,
    passing,
)
from tandemlift.laws.sensors.readings import ImuReading, MotionReading, Readings
from tandemlift.laws.sensors.sensor_faults import chosen, chosen_attitude

EARLY, LONG = 2.0, 5.0  # s: before biases are looked at, and over which their mean is taken


class Watchdog(NamedTuple):
    """Limits: no fresh sample for `stale` [s], none good for `invalid` [s]; `forgets` is 1 − λ.

    `attitude` [rad], `way` [m] and `speed` [m/s]: by how much measurements may differ. `turn_share` of a new turn in
    the rates from it, `way_share` of a new way in the velocity, and one over the time between motion samples [1/s].
    """

    stale: Any
    invalid: Any
    ranges: ReadingRanges
    alike: FrozenLimits
    forgets: Any
    attitude: Any
    way: Any
    speed: Any
    turn_share: Any
    way_share: Any
    per_interval: Any


class Inconsistency(NamedTuple):
    """Memory of what measurements differ by: attitude [rad, body axes], way [m], speed [m/s]; what one tells since."""

    attitude: Vec3
    way: Vec3
    speed: Vec3
    turned: Quat
    reached: Vec3
    gained: Vec3


class Biases(NamedTuple):
    """Mean of the biases [rad/s, m/s²], and how long they have been looked at, less `EARLY` [s]."""

    gyroscope: Vec3
    accelerometer: Vec3
    time: Any


class WatchdogState(NamedTuple):
    """Memory: readings as last given and as last found good, ages of both devices [s], 1 once each was heard.

    The rates as they are believed, the velocity as the position tells it, and means of the navigator's biases.
    """

    last: Readings
    good: Readings
    health: SensorHealths
    unit_age: Any
    motion_age: Any
    unit_seen: Any
    motion_seen: Any
    rates: Vec3
    velocity: Vec3
    mean: Biases
    apart: Inconsistency


class WatchdogReport(NamedTuple):
    """What is wrong: 1 or 0, or what is wrong with a sensor (`SYMPTOMS`, from 1; 0 for nothing).

    `imu` and `motion`: stale. `seen`: 1 once both devices have been heard.
    """

    imu: Any
    motion: Any
    joints: Any
    accelerometer: Any
    gyroscope: Any
    position: Any
    velocity: Any
    attitude: Any
    attitude_inconsistent: Any
    velocity_inconsistent: Any
    speed_inconsistent: Any
    seen: Any


WELL = WatchdogReport(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class PredictedReadings(NamedTuple):
    """What the navigator expects: the state, and both sensors' bias [rad/s, m/s²]."""

    state: State
    gyroscope_bias: Vec3
    accelerometer_bias: Vec3


@law
def wrong_with(k: Watchdog, h: SensorHealth, alike: Any) -> Any:
    """What is wrong with a sensor for too long (`SYMPTOMS`), or 0."""
    bad = where(h.silent >= k.invalid, h.wrong, 0.0)
    return where(h.wrong > 0.0, bad, where(h.same >= alike, FROZEN, 0.0))


@law
def kept_unit(good: ImuReading, u: ImuReading, h: SensorHealths) -> ImuReading:
    """A unit's sample in which the last good values stand for what is not good."""
    joints, accelerometer, gyroscope = passing(h.joints), passing(h.accelerometer), passing(h.gyroscope)
    return ImuReading(
        chosen(accelerometer, u.specific_force, good.specific_force),
        chosen(gyroscope, u.rates, good.rates),
        chosen(joints, u.joint_force, good.joint_force),
        chosen(joints, u.joint_torque, good.joint_torque),
        u.frame,
        u.fresh,
    )


@law
def replaced_unit(u: ImuReading, r: WatchdogReport, rates: Vec3, p: PredictedReadings, mean: Biases) -> ImuReading:
    """A unit's sample in which something stands for lost sensors, and for biases that are no longer corrected."""
    still = apply_transposed(rotation_from_quaternion(p.state.attitude), UP * GRAVITY) + p.accelerometer_bias
    turns, moves = maximum(r.motion, r.attitude), maximum(r.motion, maximum(r.position, r.velocity))
    force = u.specific_force + chosen(moves, p.accelerometer_bias - mean.accelerometer, ZERO)
    turning = u.rates + chosen(turns, p.gyroscope_bias - mean.gyroscope, ZERO)
    return ImuReading(
        chosen(maximum(r.accelerometer, r.imu), still, force),
        chosen(maximum(r.gyroscope, r.imu), rates + p.gyroscope_bias, turning),
        u.joint_force,
        u.joint_torque,
        u.frame,
        u.fresh,
    )


@law
def replaced_motion(
    v: MotionReading, h: SensorHealths, r: WatchdogReport, velocity: Vec3, p: PredictedReadings
) -> MotionReading:
    """A motion sample in which what is predicted stands for what is not good or lost; `velocity`: from the position."""
    position = maximum(maximum(r.position, h.position.wrong), r.motion)
    blurred = maximum(maximum(r.velocity, h.velocity.wrong), r.motion)
    attitude = maximum(maximum(r.attitude, h.attitude.wrong), r.motion)
    left = where(position > 0.0, where(blurred > 0.0, where(attitude > 0.0, 0.0, 1.0), 1.0), 1.0)
    return MotionReading(
        chosen(position, p.state.position, v.position),
        chosen(blurred, chosen(position, p.state.velocity, velocity), v.velocity),
        chosen_attitude(attitude, p.state.attitude, v.attitude),
        v.fresh * left,
    )


@law
def inconsistency_after(
    k: Watchdog, m: Inconsistency, u: ImuReading, v: MotionReading, lost: Any, dt: Any
) -> Inconsistency:
    """What measurements differ by, with a sample; `lost` is 1 if one of them is, and nothing is compared."""
    so_far, reached = rotated_by(m.turned, u.rates * dt), m.reached + v.velocity * dt
    pull = apply(rotation_from_quaternion(v.attitude), u.specific_force) - UP * GRAVITY
    gained = m.gained + pull * dt
    new, none = v.fresh, maximum(v.fresh, lost)
    keep = (1.0 - k.forgets * new) * (1.0 - lost)
    taken = new * (1.0 - lost)
    return Inconsistency(
        m.attitude * keep + rotation_between(so_far, v.attitude) * taken,
        m.way * keep + (v.position - reached) * taken,
        m.speed * keep + (v.velocity - gained) * taken,
        chosen_attitude(none, v.attitude, so_far),
        chosen(none, v.position, reached),
        chosen(none, v.velocity, gained),
    )


@law
def reported(
    k: Watchdog, h: SensorHealths, unit_age: Any, motion_age: Any, seen: Any, apart: Inconsistency
) -> WatchdogReport:
    """What is wrong, with devices of these ages [s]; `seen` is 1 once both were heard."""
    return WatchdogReport(
        where(unit_age >= k.stale, 1.0, 0.0),
        where(motion_age >= k.stale, 1.0, 0.0),
        wrong_with(k, h.joints, k.alike.joints),
        wrong_with(k, h.accelerometer, k.alike.accelerometer),
        wrong_with(k, h.gyroscope, k.alike.gyroscope),
        wrong_with(k, h.position, k.alike.position),
        wrong_with(k, h.velocity, k.alike.velocity),
        wrong_with(k, h.attitude, k.alike.attitude),
        where(dot(apart.attitude, apart.attitude) > k.attitude * k.attitude, 1.0, 0.0),
        where(dot(apart.way, apart.way) > k.way * k.way, 1.0, 0.0),
        where(dot(apart.speed, apart.speed) > k.speed * k.speed, 1.0, 0.0),
        seen,
    )


@law
def turning_of(
    k: Watchdog, m: WatchdogState, u: ImuReading, attitude: Quat, fresh: Any, heard: Any, p: PredictedReadings
) -> Vec3:
    """The rates [rad/s]: of the gyroscope while it is `heard` (1), else as the measured attitude turns."""
    seen = rotation_between(m.good.motion.attitude, attitude) * k.per_interval
    return chosen(heard, u.rates - p.gyroscope_bias, m.rates + (seen - m.rates) * (k.turn_share * fresh))


@law
def velocity_of(k: Watchdog, m: WatchdogState, v: MotionReading, h: SensorHealths, r: WatchdogReport) -> Vec3:
    """The velocity [m/s]: as measured while that is well, else as the position changes."""
    well = passing(h.velocity) * where(r.velocity > 0.0, 0.0, 1.0)
    position = chosen(passing(h.position), v.position, m.good.motion.position)
    seen = (position - m.good.motion.position) * k.per_interval
    return chosen(well, v.velocity, m.velocity + (seen - m.velocity) * (k.way_share * v.fresh * passing(h.position)))


@law
def mean_of(m: Biases, p: PredictedReadings, wrong: Any, dt: Any) -> Biases:
    """The mean of the biases, with what the navigator has found now unless something is wrong (1)."""
    time = m.time + dt * (1.0 - wrong)
    share = dt / clip(time, dt, LONG) * (1.0 - wrong)
    return Biases(
        m.gyroscope + (p.gyroscope_bias - m.gyroscope) * share,
        m.accelerometer + (p.accelerometer_bias - m.accelerometer) * share,
        time,
    )


@law
def any_wrong(h: SensorHealths) -> Any:
    """1 if any of what is compared was not good in its last sample, else 0."""
    motion = passing(h.attitude) * passing(h.position) * passing(h.velocity)
    return 1.0 - passing(h.gyroscope) * passing(h.accelerometer) * motion


@law
def any_lost(r: WatchdogReport) -> Any:
    """1 if any of what is compared is lost, else 0."""
    unit = r.imu + r.gyroscope + r.accelerometer
    return where(unit + r.motion + r.attitude + r.position + r.velocity > 0.0, 1.0, 0.0)


@law
def watchdog_step(k: Watchdog, m: WatchdogState, readings: Readings, p: PredictedReadings, dt: Any) -> Any:
    """(usable readings, `WatchdogReport`, the new memory) of a step of dt [s], with what the navigator expects."""
    u, v, health = readings.unit, readings.motion, judge(k.ranges, m.health, m.last, readings, dt)
    unit_age, motion_age = (m.unit_age + dt) * (1.0 - u.fresh), (m.motion_age + dt) * (1.0 - v.fresh)
    seen = maximum(m.unit_seen, u.fresh), maximum(m.motion_seen, v.fresh)
    before = reported(k, health, unit_age, motion_age, seen[0] * seen[1], m.apart)
    kept, attitude = kept_unit(m.good.unit, u, health), passing(health.attitude)
    seen_attitude = chosen_attitude(attitude, v.attitude, m.good.motion.attitude)
    heard = where(before.gyroscope + before.imu > 0.0, 0.0, 1.0)
    rates = turning_of(k, m, kept, seen_attitude, v.fresh * attitude, heard, p)
    wrong, velocity = maximum(any_wrong(health), any_lost(before)), velocity_of(k, m, v, health, before)
    mean = mean_of(m.mean, p, wrong, dt)
    unit, motion = replaced_unit(kept, before, rates, p, mean), replaced_motion(v, health, before, velocity, p)
    apart = inconsistency_after(k, m.apart, unit, motion, wrong, dt)
    position = chosen(passing(health.position), v.position, m.good.motion.position)
    good = Readings(kept, MotionReading(position, motion.velocity, seen_attitude, motion.fresh))
    after = WatchdogState(readings, good, health, unit_age, motion_age, seen[0], seen[1], rates, velocity, mean, apart)
    report = reported(k, health, unit_age, motion_age, seen[0] * seen[1], apart)
    return Readings(unit, motion), report, after


def start_watchdog(readings: Readings) -> WatchdogState:
    """The memory before the first step, in which both devices say `readings`, not fresh."""
    none, v = SensorHealth(0.0, 0.0, 0.0), readings.motion
    health = SensorHealths(none, none, none, none, none, none)
    apart, mean = Inconsistency(ZERO, ZERO, ZERO, v.attitude, v.position, v.velocity), Biases(ZERO, ZERO, -EARLY)
    return WatchdogState(readings, readings, health, 0.0, 0.0, 0.0, 0.0, ZERO, v.velocity, mean, apart)


@law
def unsound(s: State) -> Any:
    """1 if any number of a state is not finite, else 0."""
    where_and_how_fast = maximum(any_of(no_number(s.position)), any_of(no_number(s.velocity)))
    return maximum(where_and_how_fast, maximum(any_of(no_number(s.rates)), no_number(dot(s.attitude, s.attitude))))
