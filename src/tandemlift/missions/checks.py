"""All checks of a mission in one list: first those that reject it, then those that warn of it.

Loading, `check` and the live page read this list. Each part yields the results that concern it alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.core.errors import CheckResult, InputError, refused
from tandemlift.missions.flight_checks import flight_checks
from tandemlift.missions.recording import read_recording
from tandemlift.missions.tables.mission import Mission, MissionTable
from tandemlift.missions.tables.setting_checks import outcome_refusals, part_refusals, setting_warnings
from tandemlift.parts.mechanics.push import point_checks
from tandemlift.parts.mechanics.trajectories import phase_checks
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import VehicleTable
from tandemlift.parts.person.person_table import PersonTable
from tandemlift.parts.sensors.sensor_list import ADDITIONAL

MAX_STEPS = 1_000_000_000
MAX_LOG = 4_000_000_000  # bytes
GRIP = slice(1, 4)  # of a recorded hand


def mission_checks(m: Mission) -> Iterator[CheckResult]:
    """The results of all checks, or only the first refusal if there is one."""
    refusal = next(refusals(m), None)
    if refusal is not None:
        yield refusal
        return
    yield from setting_warnings(m)
    yield from flight_checks(m)


def refusals(m: Mission) -> Iterator[CheckResult]:
    """Refusals of missions that no pilot can fly; after the first, further checks may fail to compute."""
    yield from time_checks(m.mission)
    yield from log_checks(m.mission, sample_size(m))
    yield from phase_checks(m.phases)
    yield from part_refusals(m)
    yield from recording_checks(m.person, m.vehicle)
    yield from outcome_refusals(m)


def sample_size(m: Mission) -> int:
    """Size of a logged sample [bytes]: 8 for its time and for each number of the mission's channels."""
    count = len(m.vehicle.quadrotors)
    numbers = {
        "time, state, reference, admittance, push, wrench; rotors and joints": 51 + 10 * count,
        "commands of real rotors": (5 + 4 * count) * (m.actuators.model == "rotors"),
        "wind": 6 * (m.wind.model == "air"),
        "force of floor and walls": 3 * (m.ground.model == "floor"),
        "readings and estimates": (45 + 6 * count) * (m.sensors.model == "simulated"),
        "additional sensors": sum(ADDITIONAL[s.name].width for s in m.sensors.additional if s.name in ADDITIONAL),
        "observer": 12 * (m.observer.model != "none"),
        "interactive guidance": 10 * (m.pilot.guidance == "interactive"),
        "contact": 13 * (m.contact.model == "on"),
        "supervision": 2 * (m.supervision.model == "on"),
        "rotor-failure detection": 1 * (m.detection.model != "none"),
    }
    return 8 * sum(numbers.values())


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
        yield from point_checks(f"person.recording: a grip in {path}", grip, Vehicle.from_settings(table))
