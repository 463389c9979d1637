"""The health of every sensor: whether its samples are finite numbers, within their range, and not frozen.

The checks are mapped over the sensor table; the type of a sensor's limits picks its checks.
"""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeAlias, TypeVar

from tandemlift.core.algebra import absolute, maximum, minimum, sqrt, where
from tandemlift.core.faults import SYMPTOMS
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number
from tandemlift.core.vector import Quat, Vec3, dot, total
from tandemlift.parts.sensors.readings import Readings
from tandemlift.parts.sensors.vehicle_sensors import SENSORS, Sensor

FROZEN, NO_NUMBER, OUT_OF_RANGE = (1.0 + i for i in range(len(SYMPTOMS)))
UNIT_NORM = 0.05  # by which an attitude's norm may differ from 1


T = TypeVar("T")


class PerSensor(NamedTuple, Generic[T]):
    """One value for each sensor of IMU and motion measurement, in the order of the sensor table."""

    joints: T
    accelerometer: T
    gyroscope: T
    position: T
    velocity: T
    attitude: T


class VectorLimits(NamedTuple):
    """Largest plausible magnitude of a vector's components; `frozen_samples` identical in a row make it frozen."""

    largest: Number
    frozen_samples: Number


class JointLimits(NamedTuple):
    """As `VectorLimits`, of the force [N] and the torque [N·m] at every joint."""

    force: Number
    torque: Number
    frozen_samples: Number


class AttitudeLimits(NamedTuple):
    """As `VectorLimits`, of the attitude, whose norm must be 1."""

    frozen_samples: Number


class NoLimits(NamedTuple):
    """For joints without sensors, which never fail; `frozen_samples`: more than there are."""

    frozen_samples: Number


SensorLimits: TypeAlias = VectorLimits | JointLimits | AttitudeLimits | NoLimits


class SensorHealth(NamedTuple):
    """Memory of one sensor.

    `identical`: samples in a row that equal the one before. `invalid_time` [s]: since the last valid sample. `failure`:
    symptom of the last sample (`SYMPTOMS`, from 1), 0 for none.
    """

    identical: Number
    invalid_time: Number
    failure: Number


class SampleChecks(NamedTuple):
    """Checks of a sample: 1 if a number is not finite, if one is out of range, if the sample repeats the last one."""

    not_finite: Number
    out_of_range: Number
    identical: Number


class WatchdogReport(NamedTuple):
    """The watchdogs' report: 1 or 0 for devices, the symptom of each sensor (`SYMPTOMS`, from 1; 0 for none).

    `imu` and `motion`: stale. `seen`: 1 once both devices have sent a sample.
    """

    imu: Number
    motion: Number
    joints: Number
    accelerometer: Number
    gyroscope: Number
    position: Number
    velocity: Number
    attitude: Number
    attitude_inconsistent: Number
    velocity_inconsistent: Number
    speed_inconsistent: Number
    seen: Number


WELL = WatchdogReport._make([*[0.0] * 11, 1.0])


@elementwise
def not_finite(x: Number) -> Number:
    """1 where a value is not finite, else 0."""
    return where(x - x == 0.0, 0.0, 1.0)


@elementwise
def out_of_range(x: Number, largest: Number) -> Number:
    """1 where the magnitude of a value is above the largest, or it is no number, else 0."""
    return where(absolute(x) <= largest, 0.0, 1.0)


@elementwise
def differs(x: Number, last: Number) -> Number:
    """1 where two values differ, else 0."""
    return where(x == last, 0.0, 1.0)


@elementwise
def is_zero(x: Number) -> Number:
    """1 where a count is 0, else 0."""
    return where(x == 0.0, 1.0, 0.0)


@law
def any_component(v: Vec3) -> Number:
    """1 if any component of a vector of flags is 1, else 0."""
    return minimum(v.x + v.y + v.z, 1.0)


@law
def any_of_sets(v: Vec3) -> Number:
    """1 if any flag in a vector of sets is 1, else 0."""
    return minimum(total(v.x) + total(v.y) + total(v.z), 1.0)


@choice(instead={NoLimits: SampleChecks(0.0, 0.0, 0.0)})
def check_sample(limits: SensorLimits, sample: tuple[Vec3 | Quat, ...], last: tuple[Vec3 | Quat, ...]) -> SampleChecks:
    """The `SampleChecks` of a sample; it and the one before it are tuples of the sensor's quantities."""


@check_sample.register(VectorLimits)
def _check_vector(k: VectorLimits, sample: tuple[Vec3], last: tuple[Vec3]) -> SampleChecks:
    x, before = sample[0], last[0]
    return SampleChecks(
        not_finite=any_component(not_finite(x)),
        out_of_range=any_component(out_of_range(x, k.largest)),
        identical=is_zero(any_component(differs(x, before))),
    )


@check_sample.register(JointLimits)
def _check_joints(k: JointLimits, sample: tuple[Vec3, Vec3], last: tuple[Vec3, Vec3]) -> SampleChecks:
    f, t, g, s = *sample, *last
    differing = differs(f.x, g.x) + differs(f.y, g.y) + differs(f.z, g.z)
    differing = differing + differs(t.x, s.x) + differs(t.y, s.y) + differs(t.z, s.z)
    large_force = any_of_sets(Vec3(*[out_of_range(x, k.force) for x in f]))
    large_torque = any_of_sets(Vec3(*[out_of_range(x, k.torque) for x in t]))
    return SampleChecks(
        not_finite=maximum(any_of_sets(Vec3(*map(not_finite, f))), any_of_sets(Vec3(*map(not_finite, t)))),
        out_of_range=maximum(large_force, large_torque),
        identical=minimum(total(is_zero(differing)), 1.0),
    )


@check_sample.register(AttitudeLimits)
def _check_attitude(k: AttitudeLimits, sample: tuple[Quat], last: tuple[Quat]) -> SampleChecks:
    q, before = sample[0], last[0]
    square = dot(q, q)
    off = absolute(sqrt(maximum(square, 0.0)) - 1.0)
    differing = total(map(differs, q, before))
    return SampleChecks(not_finite(square), out_of_range(off, UNIT_NORM), is_zero(differing))


@law
def health_after(m: SensorHealth, checks: SampleChecks, fresh: Number, dt: Number) -> SensorHealth:
    """The health of a sensor after a step of dt [s] with these checks of its sample; `fresh`: of its device."""
    new = fresh > 0.0
    failure = where(checks.not_finite > 0.0, NO_NUMBER, where(checks.out_of_range > 0.0, OUT_OF_RANGE, 0.0))
    invalid = where(new, where(failure > 0.0, 1.0, 0.0), 1.0)
    return SensorHealth(
        identical=where(new, (m.identical + 1.0) * checks.identical, m.identical),
        invalid_time=(m.invalid_time + dt) * invalid,
        failure=where(new, failure, m.failure),
    )


def quantities(readings: Readings, sensor: Sensor) -> tuple[Vec3 | Quat, ...]:
    """The reading of a sensor."""
    return tuple(getattr(getattr(readings, sensor.device), name) for name in sensor.quantities)


@law
def judge(
    limits: PerSensor[SensorLimits], healths: PerSensor[SensorHealth], last: Readings, readings: Readings, dt: Number
) -> PerSensor[SensorHealth]:
    """The health of every sensor after a step of dt [s] with these readings; `last`: those before them."""
    checks = [
        check_sample(k, quantities(readings, sensor), quantities(last, sensor))
        for k, sensor in zip(limits, SENSORS.values(), strict=True)
    ]
    fresh = [getattr(readings, sensor.device).fresh for sensor in SENSORS.values()]
    return PerSensor(*[health_after(*sensor, dt) for sensor in zip(healths, checks, fresh, strict=True)])


@law
def is_valid(h: SensorHealth) -> Number:
    """1 if a sensor's last sample was valid, else 0."""
    return where(h.failure > 0.0, 0.0, 1.0)
