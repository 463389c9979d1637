"""The set-up of a flight in words, from its mission: vehicle, pilot, rotors, sensors, and surroundings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from pydantic import TypeAdapter, ValidationError

from tandemlift.core.errors import InputError, shown
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission
from tandemlift.pictures.drawing.vehicle import floor_height

Row = tuple[str, str]

MOST_CHANGES = 12  # that are listed
OBSERVERS = {"extended-state": "a linear extended-state observer", "super-twisting": "a super-twisting observer"}
READ = {"truth": "true", "measurement": "measured", "estimate": "estimated"}
JOINTS = {"force": ("N", "Joint forces"), "torque": ("N m", "Joint torques")}


def _table(flight: Flight, name: str) -> Any:
    """A table of the flight's mission, or the tuple of an array of tables."""
    field = Mission.model_fields[name]
    if name not in flight.mission:  # of a flight that was read from a bag, or made by hand
        return field.default
    kind: Any = field.annotation
    try:
        return TypeAdapter(kind).validate_python(flight.mission[name])
    except ValidationError as error:
        raise InputError(f"the flight's mission has no {name} that this version reads: {error}") from error


def describe(value: float, unit: str = "", scale: float = 1.0) -> str:
    """A number in at most four digits, with its unit."""
    return f"{scale * value:.4g} {unit}".rstrip().replace("-", "−")


def _vector(values: Iterable[float], unit: str) -> str:
    return f"({', '.join(describe(v) for v in values)}) {unit}"


def _spread(values: Iterable[float], unit: str, scale: float = 1.0) -> str:
    """One value, or the least to the largest of several."""
    ordered = sorted(values)
    return " to ".join(dict.fromkeys(describe(v, scale=scale) for v in (ordered[0], ordered[-1]))) + f" {unit}"


def _vehicle(flight: Flight) -> Iterator[Row]:
    table = _table(flight, "vehicle")
    count, payload = len(table.quadrotors), table.payload.mass
    mass = payload + sum(q.mass for q in table.quadrotors)
    fleet = f"{count} quadrotor{'s' if count > 1 else ''}"
    bends = f", which bends ({table.payload.material or 'stiffness given'})" if table.payload.is_elastic else ""
    gives = "; mounts give" if any(q.joint_stiffness is not None for q in table.quadrotors) else ""
    yield "Vehicle", f"{fleet} and a payload of {describe(payload, 'kg')}{bends}, {describe(mass, 'kg')} in all{gives}"
    plant, push = _table(flight, "plant"), _table(flight, "disturbance")
    unknown = []
    if plant.mass_scale != 1.0:
        unknown.append(f"its mass is {describe(plant.mass_scale * mass, 'kg')}")
    if plant.inertia_scale != (1.0, 1.0, 1.0):
        unknown.append(f"its inertia is {_vector(plant.inertia_scale, 'times as large')}")
    if plant.thrust_scale != 1.0:
        unknown.append(f"its rotors give {describe(plant.thrust_scale, '%', 100.0)} of the thrust")
    if any(plant.center_of_mass_offset):
        unknown.append(f"its centre of mass is off by {_vector(plant.center_of_mass_offset, 'm')}")
    if any(push.force):
        unknown.append(f"a force of {_vector(push.force, 'N')} acts on it")
    if any(push.moment):
        unknown.append(f"a moment of {_vector(push.moment, 'N m')} acts on it")
    if unknown:
        yield "Unknown to the pilot", ", ".join(unknown)


def _pilot(flight: Flight) -> Iterator[Row]:
    pilot, name = _table(flight, "pilot"), flight.mission["controller"]["name"]
    yield "Pilot", f"controller {name}; reads the {READ[pilot.state]} state and the {READ[pilot.push]} push"


def _guidance(flight: Flight) -> Iterator[Row]:
    if _table(flight, "pilot").guidance == "scheduled":
        yield "Guidance", "scheduled: lift and landing at set times, the paper’s admittance in between"
        return
    c, estimator = _table(flight, "compliance"), _table(flight, "estimator")
    caps = f"up to {_spread(c.max_speed, 'm/s')}, {_spread(c.max_acceleration, 'm/s²')}, {_spread(c.max_jerk, 'm/s³')}"
    yaw = "turns with a push at an end" if c.yaw.model == "compliant" else "heading held"
    tank = "; an energy tank adds damping" if c.tank.model != "none" else ""
    wind = "; wind on the beam is separated from a push" if estimator.wind_compensation != "none" else ""
    yield "Guidance", f"by hand: {caps}; {yaw}{tank}{wind}"


def _watch(flight: Flight) -> Iterator[Row]:
    observer, detection = _table(flight, "observer"), _table(flight, "detection")
    yield "Disturbance", "not estimated" if observer.model == "none" else f"estimated by {OBSERVERS[observer.model]}"
    if detection.model != "none":
        yield "Rotor failure", "detected from motion that the modelled rotors do not explain; then an emergency landing"
    if _table(flight, "supervision").model != "none":
        yield "Supervision", "checks before a lift, watchdogs on every sensor, limits and a fence, each with a reaction"
    for change in _table(flight, "changes")[:MOST_CHANGES]:
        over = f" within {describe(change.duration, 's')}" if change.duration else ""
        yield "Change", f"{change.key} = {shown(change.value)} from {describe(change.time, 's')} on{over}"
    more = len(flight.mission.get("changes", [])) - MOST_CHANGES
    if more > 0:
        yield "Change", f"and {more} more"


def _lag(quadrotors: Any) -> str:
    up, down = ([getattr(q, name) for q in quadrotors] for name in ("lag_up", "lag_down"))
    return f"lag of {_spread(up, 'ms', 1e3)} up and {_spread(down, 'ms', 1e3)} down" if any(up + down) else "no lag"


def _rotors(flight: Flight) -> Iterator[Row]:
    actuators, quadrotors = (_table(flight, "actuators"), _table(flight, "vehicle").quadrotors)
    method = _table(flight, "allocation").method
    if actuators.model == "ideal":
        yield "Rotors", f"ideal: every command takes effect at once and exactly; {method} allocation"
        return
    most = _spread([q.thrust_limit for q in quadrotors], "N")
    late = f"commands {describe(actuators.delay, 'ms', 1e3)} late" if actuators.delay else "commands without delay"
    start = {"hover": "turning as in hover at the start", "stopped": "stopped at the start"}[actuators.start]
    yield "Rotors", f"0 to {most} each; {_lag(quadrotors)}; {late}; {start}; {method} allocation"
    for fault in (f for f in _table(flight, "faults") if f.time <= flight.mission["mission"]["duration"]):
        known = "never known" if fault.known_after is None else f"known {describe(fault.known_after, 's')} later"
        left = f"{describe(fault.efficiency, '%', 100.0)} of the thrust left"
        place = f"rotor {fault.rotor} of quadrotor {fault.quadrotor}"
        yield "Fault", f"{place}: {left} from {describe(fault.time, 's')} on, {known}"


def _errors(unit: str, **sizes: tuple[float, str]) -> str:
    """The errors that are not zero, each by its name, with its unit."""
    said = [f"{name} {describe(size, f'{unit}{per}')}" for name, (size, per) in sizes.items() if size]
    return ", ".join(said) or "exact"


def _every(interval: float, delay: float) -> str:
    often = f"every {describe(interval, 'ms', 1e3)}" if interval else "every step"
    late = f"{describe(delay, 'ms', 1e3)} and " if delay else ""
    return f"{often}, known {late}a step later"


def _sensors(flight: Flight) -> Iterator[Row]:
    s = _table(flight, "sensors")
    if s.model == "none":
        yield "Sensors", "none: the pilot reads true values"
        return
    drawn = "noise, bias and misalignment are standard deviations; the seed gives biases and misalignments"
    if s.noise_interval is not None:
        drawn += (
            f"; noise on board is that of samples every {describe(s.noise_interval, 'ms', 1e3)}, its density is kept"
        )
    yield "Sensors on board", f"{_every(s.interval, s.delay)}; {drawn}"
    if s.joints.interval is not None and s.joints.model != "none":
        yield "Joints", f"{_every(s.joints.interval, s.delay)}, with the next sample on board"
    for kind, (unit, name) in JOINTS.items() if s.joints.model != "none" else ():
        noise, bias, drift, step = (getattr(s.joints, f"{kind}_{x}") for x in ("noise", "bias", "drift", "resolution"))
        errors = _errors(unit, noise=(noise, ""), bias=(bias, ""), drift=(drift, "/√s"), steps=(step, ""))
        turned = f", misaligned by {describe(s.joints.misalignment, 'rad')}" if s.joints.misalignment else ""
        yield name, f"{errors}{turned}; up to ±{describe(getattr(s.joints, f'{kind}_range'), unit)}"
    for meter, unit, name in ((s.accelerometer, "m/s²", "Accelerometer"), (s.gyroscope, "rad/s", "Gyroscope")):
        errors = _errors(unit, noise=(meter.noise, ""), bias=(meter.bias, ""), drift=(meter.drift, "/√s"))
        yield name, f"{errors}; up to ±{describe(meter.range, unit)}"
    m = s.motion
    noises = ((m.position_noise, "m"), (m.velocity_noise, "m/s"), (m.attitude_noise, "rad"))
    noise = ", ".join(describe(size, unit) for size, unit in noises if size)
    yield "Motion", f"{_every(m.interval, m.delay)}; " + (f"noise {noise}" if noise else "exact")
    yield "Estimate of the push", _estimate(_table(flight, "estimator"))


def _estimate(e: Any) -> str:
    tare = f"tare in steady hover, for {describe(e.tare_duration, 's')}" if e.tare == "hover" else "no tare"
    if e.tare == "at-time" and e.tare_start is not None:
        tare = f"tare from {describe(e.tare_start)} to {describe(e.tare_start + e.tare_duration, 's')}"
    tare += ", which also finds the payload’s mass" if e.identify_mass else ""
    trust = f"not used while sensors disagree by {describe(e.disagreement_limit, 'N')} or more"
    return f"low-pass filter of {describe(e.push_bandwidth, 'rad/s')}; {tare}; {trust}"


def _surroundings(flight: Flight) -> Iterator[Row]:
    wind = _table(flight, "wind")
    said = "none"
    if wind.model == "air":
        parts = [f"mean {_vector(wind.velocity, 'm/s')}"]
        if wind.turbulence:
            parts.append(f"Dryden turbulence of {describe(wind.turbulence, 'm/s')} at 20 ft")
        parts += [f"gust of {_vector(g.velocity, 'm/s')} from {describe(g.start, 's')} on" for g in wind.gusts]
        said = "; ".join(parts)
    yield "Wind", said
    ground, height = _table(flight, "ground"), floor_height(flight)
    if height is not None:
        effect = "; ground effect on the rotors" if ground.effect else ""
        yield "Floor", f"at z = {describe(height, 'm')}; friction {describe(ground.friction)}{effect}"
    else:
        yield "Floor", "none"
    if walls := flight.walls:
        yield "Walls", str(len(walls))


LEADS = {
    "pull": "one hand leads the grip along the path",
    "steer": "one hand leads the centre of mass along the path",
    "two-hands": "two hands lead and turn the payload’s centre along the path",
    "hold": "one hand goes to the waypoints and stays there",
}


def _person(flight: Flight) -> Iterator[Row]:
    p = _table(flight, "person")
    if p.model == "none":
        return
    if p.model == "virtual-hand":
        spring = (
            f"{describe(p.stiffness, 'N/m')} and {describe(p.damping, 'N s/m')}, up to {describe(p.max_force, 'N')}"
        )
        yield "Person", f"a virtual hand that is moved from outside, on a spring of {spring}"
        return
    where = "" if p.model == "two-hands" else f", {describe(p.grip, 'm')} along the beam from the payload’s centre"
    arm = (
        f"arm of {describe(p.stiffness, 'N/m')} and {describe(p.damping, 'N s/m')}, up to {describe(p.max_force, 'N')}"
    )
    late = f"visual delay {describe(p.delay, 'ms', 1e3)}, two muscle lags of {describe(p.lag, 'ms', 1e3)}"
    yield "Person", f"{LEADS[p.model]}{where}; {late}; {arm}; tremor {describe(p.tremor, 'N')}"


def setup_rows(flight: Flight) -> list[Row]:
    """The set-up of a flight: rows of a name and a description."""
    parts = (_vehicle, _pilot, _guidance, _watch, _rotors, _sensors, _surroundings, _person)
    return [row for part in parts for row in part(flight)]
