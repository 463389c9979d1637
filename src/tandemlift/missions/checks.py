"""All checks of a mission in one list: first those that reject it, then those that warn of it; their report.

Loading, `check` and the live page read this list. Each part yields the results that concern it alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from tandemlift.core.errors import CLOSE, FAILS, OK, REFUSED, SETTINGS, CheckResult, InputError, refused
from tandemlift.core.phases import CRASH_SPEED
from tandemlift.missions import outcomes
from tandemlift.missions.facts import Facts
from tandemlift.missions.flight_checks import FlightCheck, flight_checks
from tandemlift.missions.mission import PARTS, Mission, MissionTable
from tandemlift.missions.recording import read_recording
from tandemlift.parts.contact import standing
from tandemlift.parts.contact.corridor import wall_checks, wall_warnings
from tandemlift.parts.estimation import estimator_table as estimator
from tandemlift.parts.flight_checks import authority
from tandemlift.parts.flight_checks.schedule_checks import phase_checks, phase_warnings
from tandemlift.parts.guidance.admittance import admittance_checks, gate_checks
from tandemlift.parts.guidance.guidance import reading_checks
from tandemlift.parts.guidance.requests import request_checks
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_checks import on_vehicle_checks, vehicle_checks
from tandemlift.parts.mechanics.vehicle_table import VehicleTable
from tandemlift.parts.person.person_table import PersonTable
from tandemlift.parts.rotors.rotor_faults import fault_checks, fault_warnings
from tandemlift.parts.rotors.rotors import ActuatorsTable
from tandemlift.parts.sensors import sensor_checks as sensors
from tandemlift.parts.sensors.sensors_table import SensorsTable

__all__ = ["FlightCheck", "check_lines", "flight_checks", "mission_checks", "refusals"]

MAX_STEPS = 1_000_000_000
MAX_LOG = 4_000_000_000  # bytes
GRIP = slice(1, 4)  # of a recorded hand


def refusals(m: Mission) -> Iterator[CheckResult]:
    """Refusals of missions that no pilot can fly, in the order of their search; after one, others may not compute."""
    guidance, step, rotors, s = m.pilot.guidance, m.mission.step, m.actuators.model, m.sensors
    facts, count, walls = Facts(m), len(m.vehicle.quadrotors), bool(m.all_walls)
    yield from time_checks(m.mission)
    yield from log_checks(m.mission, m.sample_size)
    yield from phase_checks(m.phases)
    yield from vehicle_checks(m.vehicle, m.allocation.weights)
    yield from admittance_checks(m.admittance, step)
    yield from fault_checks(m.faults, count, rotors)
    yield from authority.lift_checks(m.hover)
    yield from sensors.delay_checks(_delays(m.actuators, s, m.person), step)
    yield from sensors.additional_checks(s)
    yield from sensors.first_sample_checks(s, step)
    yield from reading_checks(m.pilot, s.model)
    yield from estimator.tare_checks(m.estimator, s.interval, step, uses_mass=m.compliance.mass_feedforward)
    yield from estimator.wrench_checks(m.estimator, s, rotors, m.allocation.method, m.contact.model, m.hover.mass, step)
    yield from estimator.compensation_checks(m.estimator.wind_compensation, m.vehicle.quadrotors)
    yield from standing.floor_checks(m.ground, rotors, m.phases, walls=walls)
    if m.ground.model != "none":
        stands = standing.standing_on(m.ground, m.vehicle, m.plant.mass_scale, step, m.initial)
        yield from standing.depth_checks(m.ground, m.initial, stands)
    yield from wall_checks(m.walls)
    yield from request_checks(m.requests, guidance)
    for part in PARTS:
        yield from facts.ask(part, part.refusals) if part.refusals else ()
    yield from estimator.hover_tare_checks(m.estimator, guidance)
    yield from gate_checks(m.admittance, guidance)
    yield from outcomes.fence_crash_checks(m.crash, m.supervision, m.initial, m.phases.height)
    yield from sensors.sensor_fault_checks(m.sensor_faults, s, count)
    for i, push in enumerate(m.pushes):
        yield from on_vehicle_checks(f"pushes.{i}.point", push.point, Vehicle.from_settings(m.vehicle))
    yield from recording_checks(m.person, m.vehicle)
    yield from outcomes.crash_checks(m.crash, m.initial)
    yield from outcomes.promise_checks(m.promise, m.findings, m.crash, guidance)
    yield from outcomes.oscillation_checks(m.findings, step)
    yield from standing.lift_height_checks(m.ground, m.phases)


def mission_checks(m: Mission) -> Iterator[CheckResult]:
    """The first refusal alone; else of settings that do not suit each other, then `flight_checks`."""
    refusal = next(refusals(m), None)
    if refusal is not None:
        yield refusal
        return
    guidance, hover, p, e, end = m.pilot.guidance, m.hover, m.phases, m.estimator, m.mission.duration
    simulated, over_floor = m.sensors.model == "simulated", m.ground.model == "floor"
    yield from phase_warnings(p)
    if simulated and m.pilot.state != "truth":
        yield from outcomes.sensed_promise_warnings(m.promise, guidance, m.sensors.motion)
    if guidance == "interactive" and over_floor and p.land_start is not None and p.land_start < end:
        yield from outcomes.landing_promise_warnings(m.promise, guidance, m.compliance.touchdown_depth)
    if m.actuators.model == "rotors":
        yield from authority.hover_warnings(hover)
        yield from fault_warnings(m.faults, hover.weight, hover.faulty_lift, m.allocation.method)
    else:
        yield from authority.ideal_lift_warnings(hover)
    if simulated:
        yield from sensors.range_warnings(m.sensors, hover.vehicle, hover.thrusts)
        yield from authority.payload_warnings(hover)
        yield from estimator.bias_warnings(e, m.sensors.joints.force_bias, m.pilot.push)
        yield from estimator.tare_warnings(e, p, m.pushes, end)
    if over_floor:
        limit = hover.mass * CRASH_SPEED if m.crash.impulse is None else m.crash.impulse
        stands = standing.standing_on(m.ground, m.vehicle, m.plant.mass_scale, m.mission.step, m.initial)
        yield from standing.floor_warnings(m.ground, m.vehicle, m.actuators.model, m.mission.step, stands)
        yield from standing.start_warnings(p, stands)
        yield from standing.blow_warnings(p, m.initial, hover.mass, limit, stands)
        yield from standing.reference_warnings(p, end, stands)
        yield from wall_warnings(m.walls, m.corridor, m.initial, hover.vehicle)
    yield from m.controller.checks(m.mission.step)
    yield from flight_checks(m)


def time_checks(t: MissionTable) -> Iterator[CheckResult]:
    """Refusal of a time grid that is empty or too long."""
    if t.step > t.duration:
        yield refused(f"mission.step = {t.step}: must not be longer than mission.duration = {t.duration}")
    if t.duration / t.step > MAX_STEPS:
        count = f"makes {t.duration / t.step:.3g} steps of mission.step = {t.step}"
        yield refused(f"mission.duration = {t.duration}: {count}; at most {MAX_STEPS:.0e} are allowed")


def log_checks(t: MissionTable, sample: int) -> Iterator[CheckResult]:
    """Refusal of a log that would not fit in memory, for a sample's size in bytes."""
    size = t.steps / t.log_every * sample
    if size > MAX_LOG:
        longer = f"must be at least {t.log_interval * size / MAX_LOG:.2g}"
        yield refused(f"mission.log_interval = {t.log_interval}: {longer}, or the log exceeds {MAX_LOG / 1e9:.0f} GB")


def recording_checks(person: PersonTable, table: VehicleTable) -> Iterator[CheckResult]:
    """Refusal of a recorded hand that cannot be read, or whose grip is beside the vehicle."""
    path = person.recording
    if path is None or person.model != "virtual-hand":
        return
    try:
        grips = np.unique(read_recording(path).hands[:, GRIP], axis=0)
    except InputError as error:
        yield refused(str(error))
        return
    for grip in grips:
        yield from on_vehicle_checks(f"person.recording: a grip in {path}", grip, Vehicle.from_settings(table))


def _delays(actuators: ActuatorsTable, sensors: SensorsTable, person: PersonTable) -> dict[str, float]:
    delays = {
        "actuators.delay": actuators.delay,
        "sensors.delay": sensors.delay,
        "sensors.motion.delay": sensors.motion.delay,
        "person.delay": person.delay,
    }
    return delays | {f"sensors.additional.{i}.delay": s.delay for i, s in enumerate(sensors.additional)}


WORST_FIRST = (REFUSED, FAILS, CLOSE, OK)
HEAD = ("check", "of", "value", "limit", "unit", "margin", "verdict")  # of the table of checks


def check_lines(results: Sequence[CheckResult]) -> Iterator[tuple[str, str]]:
    """Verdict and text of each line of a report: a table with a row for each result, worst first; texts; counts."""
    results = sorted(results, key=lambda result: WORST_FIRST.index(result.verdict))
    rows = [HEAD, *map(_check_row, results)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEAD))]
    for row, verdict in zip(rows, ["", *(result.verdict for result in results)], strict=True):
        cells = enumerate(zip(row, widths, strict=True))
        yield verdict, "  ".join(cell.rjust(w) if i in (2, 3, 5) else cell.ljust(w) for i, (cell, w) in cells).rstrip()
    yield from ((result.verdict, f"{result.verdict}: {result.text}") for result in results if result.text)
    counts = {verdict: sum(result.verdict == verdict for result in results) for verdict in (OK, CLOSE, FAILS)}
    yield "", ", ".join(f"{count} {verdict}" for verdict, count in counts.items())


def _check_row(result: CheckResult) -> tuple[str, ...]:
    is_advice = result.verdict == CLOSE and result.margin is not None and result.margin < 0.0
    margin = "" if result.margin is None else "advice" if is_advice else f"{100.0 * result.margin:.0f} %"
    value, limit = ("" if x is None else "none" if math.isinf(x) else f"{x:.3g}" for x in (result.value, result.limit))
    return result.check, result.subject, value, limit, "" if result.unit == "1" else result.unit, margin, result.verdict


def worst_failures(results: Iterable[CheckResult]) -> Iterator[CheckResult]:
    """The worst failure of each check, and every failure of settings."""
    failed: dict[str, list[CheckResult]] = {}
    for result in results:
        if result.verdict == FAILS:
            failed.setdefault(result.text if result.check == SETTINGS else result.check, []).append(result)
    yield from (max(many, key=_excess) for many in failed.values())


def _excess(result: CheckResult) -> float:
    """The excess of a result over its limit, as a fraction of the limit."""
    if result.value is None or result.limit is None or result.limit <= 0.0:
        return float("inf")
    return result.value / result.limit
