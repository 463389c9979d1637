"""What a mission asks of a supervision, of an operator, and of sensors that fail: what cannot be."""

from __future__ import annotations

from collections.abc import Iterator

from tandemlift.core.errors import InputError, suggestion
from tandemlift.core.sensors import DEVICES, SENSORS, sensors_named
from tandemlift.core.settings import Mission
from tandemlift.missions.values import shown


def check_supervision(m: Mission) -> None:
    """Refuse a supervision and requests without a guidance by hand, limits that exclude each other, and odd faults.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    _check_guidance(m)
    _check_contact(m)
    _check_limits(m)
    _check_sensor_faults(m)


def _check_guidance(m: Mission) -> None:
    if m.pilot.guidance == "interactive":
        return
    if m.supervision.model != "none":
        raise InputError('supervision.model = "on": must be "none" where pilot.guidance is "scheduled"')
    if m.requests:
        action = m.requests[0].action
        raise InputError(f'requests.0.action = "{action}": must be left out where pilot.guidance is "scheduled"')
    if m.estimator.tare == "hover":
        raise InputError('estimator.tare = "hover": must be "at-time" where pilot.guidance is "scheduled"')


def _check_contact(m: Mission) -> None:
    if m.contact.model == "none":
        return
    if m.pilot.guidance != "interactive":
        raise InputError('contact.model = "on": must be "none" where pilot.guidance is "scheduled"')
    if m.sensors.model == "none" or m.pilot.push == "truth":
        raise InputError('contact.model = "on": must be "none" where the pilot reads no joints (pilot.push = "truth")')


def _check_limits(m: Mission) -> None:
    s = m.supervision
    if s.model == "none":
        return
    for low, high in zip(s.fence.low, s.fence.high, strict=True):
        if low >= high:
            raise InputError(
                f"supervision.fence.low = {shown(s.fence.low)}: must be below supervision.fence.high = "
                f"{shown(s.fence.high)} along each axis"
            )
    if s.checks.min_payload_ratio >= s.checks.max_payload_ratio:
        most = f"supervision.checks.max_payload_ratio = {s.checks.max_payload_ratio}"
        raise InputError(f"supervision.checks.min_payload_ratio = {s.checks.min_payload_ratio}: must be below {most}")
    _check_crash(m)
    for name in ("stale_time", "invalid_time"):
        for key, interval in (("interval", m.sensors.interval), ("motion.interval", m.sensors.motion.interval)):
            if getattr(s.watchdog, name) <= max(interval, m.mission.step):
                given = f"supervision.watchdog.{name} = {getattr(s.watchdog, name)}"
                raise InputError(f"{given}: must be longer than sensors.{key} = {interval}, and than mission.step")


def _check_crash(m: Mission) -> None:
    """Refuse a crash that would come before the supervision may react."""
    c, s = m.crash, m.supervision
    if c.tilt <= s.limits.tilt:
        raise InputError(f"crash.tilt = {c.tilt}: must be above supervision.limits.tilt = {s.limits.tilt}")
    if c.fence_margin < s.fence.margin:
        raise InputError(
            f"crash.fence_margin = {c.fence_margin}: must be at least supervision.fence.margin = {s.fence.margin}"
        )
    sides = zip(s.fence.low, s.fence.high, m.initial.position, strict=True)
    away = max(max(low - place, place - high) for low, high, place in sides)
    if away > c.fence_margin:
        raise InputError(
            f"crash.fence_margin = {c.fence_margin}: the vehicle starts {away:.3g} m outside supervision.fence, which "
            "is a crash; must be larger, or the fence must hold initial.position"
        )


def _check_sensor_faults(m: Mission) -> None:
    if m.sensor_faults and m.sensors.model == "none":
        raise InputError('sensors.model = "none": must be "simulated" where there are sensor_faults')
    seen: dict[tuple[str, int | None, bool], int] = {}
    for i, f in enumerate(m.sensor_faults):
        for sentence in _odd(m, i):
            raise InputError(sentence)
        names = (f.sensor,) if f.kind == "stale" else sensors_named(f.sensor)
        fleet = range(1, len(m.vehicle.quadrotors) + 1)
        for name in names:
            numbers = (f.quadrotor,) if f.quadrotor else tuple(fleet) if name == "joints" else (None,)
            for number in numbers:
                first = seen.setdefault((name, number, f.kind == "stale"), i)
                if first != i:
                    raise InputError(f'sensor_faults.{i}.sensor = "{f.sensor}": fails already in sensor_faults.{first}')


def _odd(m: Mission, i: int) -> Iterator[str]:
    f, key = m.sensor_faults[i], f"sensor_faults.{i}"
    additional = [s.name for s in m.sensors.additional]
    known = [*DEVICES, *SENSORS, *additional]
    if f.sensor not in known:
        yield f"{key}.sensor = {shown(f.sensor)}: must be one of {', '.join(known)}.{suggestion(f.sensor, known)}"
    if f.kind == "stale" and f.sensor not in (*DEVICES, *additional):
        yield f'{key}.kind = "stale": must be of a device, with sensor "imu" or "motion" or an additional one'
    if f.kind in ("bias", "range") and f.sensor in DEVICES:
        yield f'{key}.kind = "{f.kind}": must be of a sensor, not of the device "{f.sensor}"'
    if f.quadrotor is not None and f.sensor != "joints":
        yield f'{key}.quadrotor = {f.quadrotor}: must be left out unless the sensor is "joints"'
    if f.quadrotor is not None and f.quadrotor > len(m.vehicle.quadrotors):
        yield f"{key}.quadrotor = {f.quadrotor}: must be from 1 to {len(m.vehicle.quadrotors)}, as many as there are"
    if f.until is not None and f.until <= f.time:
        yield f"{key}.until = {f.until}: must be after {key}.time = {f.time}"
