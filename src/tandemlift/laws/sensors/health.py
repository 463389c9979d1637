"""The health of every sensor: whether its samples are numbers, within their range, and not always the same."""

from typing import Any, NamedTuple

from tandemlift.algebra.law import elementwise, law
from tandemlift.algebra.ops import absolute, maximum, minimum, sqrt, where
from tandemlift.algebra.vector import Quat, Vec3, dot, total
from tandemlift.common.faults import SYMPTOMS
from tandemlift.laws.sensors.readings import ImuReading, Readings

FROZEN, NO_NUMBER, OUT_OF_RANGE = (1.0 + i for i in range(len(SYMPTOMS)))
UNIT_NORM = 0.05  # by which an attitude's norm may differ from 1


class ReadingRanges(NamedTuple):
    """The largest readings that can be true, either way: N, N·m, m/s², rad/s, m, m/s."""

    force: Any
    torque: Any
    specific_force: Any
    rates: Any
    position: Any
    velocity: Any


class FrozenLimits(NamedTuple):
    """How many samples of each sensor in a row, exactly alike, make it frozen."""

    joints: Any
    accelerometer: Any
    gyroscope: Any
    position: Any
    velocity: Any
    attitude: Any


class SensorHealth(NamedTuple):
    """Memory of one sensor: samples alike in a row, time without a good one [s], what was wrong with the last."""

    same: Any
    silent: Any
    wrong: Any


class SensorHealths(NamedTuple):
    """Memory of all sensors."""

    joints: SensorHealth
    accelerometer: SensorHealth
    gyroscope: SensorHealth
    position: SensorHealth
    velocity: SensorHealth
    attitude: SensorHealth


@elementwise
def no_number(x):
    """1 where a value is not finite, else 0."""
    return where(x - x == 0.0, 0.0, 1.0)


@elementwise
def beyond_range(x, most):
    """1 where a value is larger than a most, or no number, else 0."""
    return where(absolute(x) <= most, 0.0, 1.0)


@elementwise
def unlike(x, last):
    """1 where two values differ, else 0."""
    return where(x == last, 0.0, 1.0)


@elementwise
def none_of(x):
    """1 where a count is 0, else 0."""
    return where(x == 0.0, 1.0, 0.0)


@law
def any_of(v: Vec3) -> Any:
    """1 if any component of a vector is above 0, else 0."""
    return minimum(v.x + v.y + v.z, 1.0)


@law
def any_of_sets(v: Vec3) -> Any:
    """1 if any component of vectors of sets is above 0, else 0."""
    return minimum(total(v.x) + total(v.y) + total(v.z), 1.0)


@law
def judged(m: SensorHealth, fresh: Any, blank: Any, far: Any, alike: Any, dt: Any) -> SensorHealth:
    """A sensor's health with a sample: `blank` 1 if it has no numbers, `far` 1 if out of range, `alike` the last."""
    new = fresh > 0.0
    wrong = where(blank > 0.0, NO_NUMBER, where(far > 0.0, OUT_OF_RANGE, 0.0))
    bad = where(new, where(wrong > 0.0, 1.0, 0.0), 1.0)
    return SensorHealth(where(new, (m.same + 1.0) * alike, m.same), (m.silent + dt) * bad, where(new, wrong, m.wrong))


@law
def judge_vector(m: SensorHealth, x: Vec3, last: Vec3, most: Any, fresh: Any, dt: Any) -> SensorHealth:
    """The health of a sensor that reads a vector."""
    far = any_of(beyond_range(x, most))
    return judged(m, fresh, any_of(no_number(x)), far, none_of(any_of(unlike(x, last))), dt)


@law
def joints_blank(u: ImuReading) -> Any:
    """1 if any joint's reading has no number, else 0."""
    f, t = u.joint_force, u.joint_torque
    force = Vec3(no_number(f.x), no_number(f.y), no_number(f.z))
    torque = Vec3(no_number(t.x), no_number(t.y), no_number(t.z))
    return maximum(any_of_sets(force), any_of_sets(torque))


@law
def joints_far(k: ReadingRanges, u: ImuReading) -> Any:
    """1 if any joint's reading is out of range, else 0."""
    f, t = u.joint_force, u.joint_torque
    force = Vec3(beyond_range(f.x, k.force), beyond_range(f.y, k.force), beyond_range(f.z, k.force))
    torque = Vec3(beyond_range(t.x, k.torque), beyond_range(t.y, k.torque), beyond_range(t.z, k.torque))
    return maximum(any_of_sets(force), any_of_sets(torque))


@law
def joints_alike(u: ImuReading, last: ImuReading) -> Any:
    """1 if the sensor of any joint reads exactly what it read last, else 0."""
    f, t, g, s = u.joint_force, u.joint_torque, last.joint_force, last.joint_torque
    force = unlike(f.x, g.x) + unlike(f.y, g.y) + unlike(f.z, g.z)
    return minimum(total(none_of(force + unlike(t.x, s.x) + unlike(t.y, s.y) + unlike(t.z, s.z))), 1.0)


@law
def judge_attitude(m: SensorHealth, q: Quat, last: Quat, fresh: Any, dt: Any) -> SensorHealth:
    """The health of the measured attitude: of unit norm, or it is none."""
    size = dot(q, q)
    off = absolute(sqrt(maximum(size, 0.0)) - 1.0)
    differs = unlike(q.w, last.w) + unlike(q.x, last.x) + unlike(q.y, last.y) + unlike(q.z, last.z)
    return judged(m, fresh, no_number(size), beyond_range(off, UNIT_NORM), none_of(differs), dt)


@law
def judge(r: ReadingRanges, h: SensorHealths, last: Readings, readings: Readings, dt: Any) -> SensorHealths:
    """The health of every sensor with these readings."""
    u, v, was, then = readings.unit, readings.motion, last.unit, last.motion
    return SensorHealths(
        judged(h.joints, u.fresh, joints_blank(u), joints_far(r, u), joints_alike(u, was), dt),
        judge_vector(h.accelerometer, u.specific_force, was.specific_force, r.specific_force, u.fresh, dt),
        judge_vector(h.gyroscope, u.rates, was.rates, r.rates, u.fresh, dt),
        judge_vector(h.position, v.position, then.position, r.position, v.fresh, dt),
        judge_vector(h.velocity, v.velocity, then.velocity, r.velocity, v.fresh, dt),
        judge_attitude(h.attitude, v.attitude, then.attitude, v.fresh, dt),
    )


@law
def passing(h: SensorHealth) -> Any:
    """1 if a sensor's last sample was good, else 0."""
    return where(h.wrong > 0.0, 0.0, 1.0)
