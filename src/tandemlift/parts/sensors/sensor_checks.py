"""Checks for invalid sensors, sensor faults and delays, and for ranges that hover exceeds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from tandemlift.core.errors import CheckResult, refused, shown, suggestion, warned
from tandemlift.core.types import GRAVITY, Array
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.sensors_table import SensorFaultTable, SensorsTable, clocks_of, steps_of
from tandemlift.parts.sensors.vehicle_sensors import ADDITIONAL, DEVICES, SENSORS, sensors_named

MAX_DELAY = 10_000  # steps


def delay_checks(delays: Mapping[str, float], step: float) -> Iterator[CheckResult]:
    """Check for delays [s], by key, that take too many steps."""
    for key, delay in delays.items():
        if delay / step > MAX_DELAY:
            yield refused(f"{key} = {delay}: must be at most {MAX_DELAY} steps of mission.step = {step}")


def additional_checks(table: SensorsTable) -> Iterator[CheckResult]:
    """Check for additional sensors that are not registered, that occur twice, or that cannot be simulated."""
    for i, s in enumerate(table.additional):
        key = f"sensors.additional.{i}.name = {shown(s.name)}"
        if s.name not in ADDITIONAL:
            known = sorted(ADDITIONAL)
            yield refused(f"{key}: must be one of {', '.join(known)}.{suggestion(s.name, known)}")
        if s.name in [other.name for other in table.additional[:i]]:
            yield refused(f"{key}: must be different from the sensors above it")
    if table.additional and table.model == "none":
        yield refused('sensors.model = "none": must be "simulated" where there are additional sensors')


def first_sample_checks(table: SensorsTable, step: float) -> Iterator[CheckResult]:
    """Check for first samples that are not within an interval between samples."""
    for _, key, interval, first in clocks_of(table):
        if first / step >= steps_of(interval or 0.0, step) - 0.5:  # rounded, it is at the next sample
            often = "set, and above it" if interval is None else f"above it, and is {interval}"
            yield refused(f"{key}.first_sample = {first}: {key}.interval must be {often}")


def range_warnings(table: SensorsTable, vehicle: Vehicle, thrusts: Array) -> Iterator[CheckResult]:
    """Check for sensors whose ranges are exceeded in hover; `thrusts` of all rotors there [N] (N × 4)."""
    quadrotors = () if table.joints.model == "none" else vehicle.quadrotors
    for i, (q, own) in enumerate(zip(quadrotors, thrusts, strict=False), 1):
        force = own.sum() - q.mass * GRAVITY
        if abs(force) > table.joints.force_range:
            given = f"sensors.joints.force_range = {table.joints.force_range}"
            yield warned(f"{given}: joint {i} carries {force:.4g} N in hover")
    if table.accelerometer.range < GRAVITY:
        yield warned(f"sensors.accelerometer.range = {table.accelerometer.range}: it reads {GRAVITY} m/s2 in hover")


def sensor_fault_checks(
    tables: Sequence[SensorFaultTable], sensors: SensorsTable, quadrotors: int
) -> Iterator[CheckResult]:
    """Check for faults of sensors that do not exist, that cannot fail in this way, or that fail twice."""
    if tables and sensors.model == "none":
        yield refused('sensors.model = "none": must be "simulated" where there are sensor_faults')
    if sensors.joints.model == "none" and any(f.sensor == "joints" for f in tables):
        yield refused('sensors.joints.model = "none": must be "simulated" where there are sensor_faults of joints')
    additional = [s.name for s in sensors.additional]
    seen: dict[tuple[str, int | None, bool], int] = {}
    for i, f in enumerate(tables):
        yield from _odd_fault_checks(f, f"sensor_faults.{i}", additional, quadrotors)
        names = (f.sensor,) if f.kind == "stale" else sensors_named(f.sensor)
        for name in names:
            every = tuple(range(1, quadrotors + 1)) if name == "joints" else (None,)
            for number in (f.quadrotor,) if f.quadrotor else every:
                first = seen.setdefault((name, number, f.kind == "stale"), i)
                if first != i:
                    yield refused(f'sensor_faults.{i}.sensor = "{f.sensor}": fails already in sensor_faults.{first}')


def _odd_fault_checks(
    f: SensorFaultTable, key: str, additional: Sequence[str], quadrotors: int
) -> Iterator[CheckResult]:
    known = [*DEVICES, *SENSORS, *additional]
    if f.sensor not in known:
        hint = suggestion(f.sensor, known)
        yield refused(f"{key}.sensor = {shown(f.sensor)}: must be one of {', '.join(known)}.{hint}")
    if f.kind == "stale" and f.sensor not in (*DEVICES, *additional):
        devices = 'with sensor "imu" or "motion" or an additional one'
        yield refused(f'{key}.kind = "stale": must be of a device, {devices}')
    if f.kind in ("bias", "range") and f.sensor in DEVICES:
        yield refused(f'{key}.kind = "{f.kind}": must be of a sensor, not of the device "{f.sensor}"')
    if f.quadrotor is not None and f.sensor != "joints":
        yield refused(f'{key}.quadrotor = {f.quadrotor}: must be left out unless the sensor is "joints"')
    if f.quadrotor is not None and f.quadrotor > quadrotors:
        limit = f"must be from 1 to {quadrotors}, as many as there are"
        yield refused(f"{key}.quadrotor = {f.quadrotor}: {limit}")
    if f.until is not None and f.until <= f.time:
        yield refused(f"{key}.until = {f.until}: must be after {key}.time = {f.time}")
