"""The shadow of a flight: what a mission's pilot makes of a log, without a simulated body.

Estimators, pilot, detectors and findings run as in a flight. The body's place is taken by the log: at each step its
state and loads are the latest readings of the log, which the mission's sensors then sample, without errors of their
own, at the mission's rates and with its delays. The loop is open: the vehicle flew with the commands in the log, not
with those of this pilot. So the pilot takes the flown command for its own last one wherever the two differ; its
observer and its detectors compare the motion with the thrusts that caused it. Parts of a pilot that integrate an error
of tracking wander if the log's pilot tracked something else.
"""

from __future__ import annotations

import warnings
from collections.abc import Container
from dataclasses import replace

import numpy as np

from tandemlift.analysis.identification.windows import check_columns
from tandemlift.analysis.linearization.loop_margins import UNROUNDED
from tandemlift.analysis.logs.causes import check_streams
from tandemlift.analysis.logs.log import (
    COMMANDS,
    FLOWN_COMMANDS,
    IMU,
    JOINTS,
    MOTION,
    PUSH,
    SOON,
    SPEED_COMMANDS,
    Log,
    sample_stamps,
)
from tandemlift.core.errors import FlightWarning, InputError
from tandemlift.core.types import Array, Progress, flat, leaves, unflat
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, MissionLike, check, merge, mission_of, tables_of
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import SampleChannels, flight_of
from tandemlift.simulation.stepping import Stepper, fly_stepwise

ENGINE = "log"
RATES = IMU[1]
ELSEWHERE = 0.5  # m: a log that begins farther from the mission's start is of another flight
LATE = 1.0  # s: a stream that begins later than that after the mission's start begins late
SPARSE = 0.8  # of the mission's rate: with fewer samples the estimators take one sample for several
EXACT = {"errors": "none", **UNROUNDED}
HOLDERS = ((("readings",), ()), (("sensing",), ("reading",)))  # of the last readings, in a flight's state


def shadow(log: Log, mission: MissionLike, *, progress: Progress | None = None) -> Flight:
    """The flight of a log with a mission's pilot beside it.

    Args:
        log: with IMU, pose and velocity, and, if the mission has sensors, loads at the joints. Commands are optional:
            without them the pilot takes its own for flown. `push_force` is needed if `pilot.push` is "truth".
        mission: of the vehicle in the log; its time 0 is that of the log. Its duration becomes the log's; its pushes,
            its person and its sensors' faults are left out.
        progress: called from time to time with (steps taken, steps in all).

    Returns:
        A flight whose channels `position`, `velocity`, `attitude`, `rates` and those at the joints are the log's
        readings, held from sample to sample, and whose other channels are the pilot's: `rotor_commands` beside
        `flown_rotor_commands`, `push_estimate`, `alarm` and so on. Simulated quantities, such as `rotor_thrusts`, are
        the response of the mission's rotors to the pilot's own commands.

    Raises:
        InputError: a stream that the mission's pilot needs is missing, or has another number of rotors or quadrotors;
            the log is too short; or the mission changes in flight.
    """
    mission = mission_of(mission)
    check_vehicle(log, mission)
    check_streams(log, mission.vehicle)
    p = plan_of(log, mission)
    body = LogBody(log, p)
    flight = flight_of(p, fly_stepwise(p, p.steps // p.every + 1, p.every, progress, body, lead=body.lead), ENGINE)
    more = sample_stamps(log, flight)
    if body.flown is not None:
        more[FLOWN_COMMANDS] = body.flown[: p.steps + 1 : p.every][: len(flight.time)]
    return replace(flight, channels={**flight.channels, **more})


class LogBody:
    """The body of a log, an `engines.registry.EngineBody`: it moves as the log says, whatever it is told.

    Args:
        log: of the plan's vehicle.
        p: its steps are the log's.
    """

    def __init__(self, log: Log, p: FlightPlan) -> None:
        times: Array = np.arange(p.steps + 2, dtype=float) * p.dt
        none = {IMU[0]: 3, **dict.fromkeys(JOINTS, 3 * len(p.mission.vehicle.quadrotors)), "contact": 3}
        loads = [rows(log, name, times) if name in log else np.zeros((len(times), none[name])) for name in none]
        self._states = np.hstack([log[name].at(times) for name in (*MOTION, RATES)])
        self._readings = np.hstack(loads)  # in the order of a `PerfectReadings`
        self.state, self.readings = self._states[0].copy(), self._readings[0].copy()
        constants = [q.thrust_constant for q in p.mission.vehicle.quadrotors for _ in range(4)]
        self.flown = flown_commands(log, np.array(constants), times)
        self._pushes = log[PUSH[0]].at(times) if PUSH[0] in log else None
        self._external, self._step = np.zeros(leaves(p.given.external)), 0
        self._sample, self._own = SampleChannels(p.sample), p.place("flight_state", "memory", "allocation", "thrusts")

    def advance(self, thrusts: Array, loads: Array, force: Array, moment: Array) -> None:
        """Take the log's next step."""
        self.readings[:] = self._readings[self._step]
        self._step += 1
        self.state[:] = self._states[self._step]

    def lead(self, stepper: Stepper, k: int) -> Array | None:
        """Before step k, let the pilot take the flown command for its last one where they differ; the push then."""
        if k and self.flown is not None and self._own.size:
            commands = self._sample.of(stepper.row, commands_of(self._sample))
            if not np.array_equal(commands, self.flown[k - 1]):
                stepper.a[self._own.at : self._own.at + self._own.size] = self.flown[k - 1]
        if self._pushes is None:
            return None
        self._external[:3] = self._pushes[k]
        return self._external


def rows(log: Log, name: str, times: Array) -> Array:
    """The last samples of a stream at some times [s]; of joints, x of all, then y, then z."""
    values = log[name].at(times)
    return values.reshape(len(values), -1, 3).swapaxes(1, 2).reshape(len(values), -1) if name in JOINTS else values


def check_vehicle(log: Log, mission: Mission) -> None:
    """Refuse what cannot be a log of the mission's vehicle, or a mission that cannot be followed."""
    name = mission.mission.name
    joints = JOINTS if mission.sensors.joints.model != "none" else ()
    sensed = (*IMU, *joints) if mission.sensors.model != "none" else (RATES,)
    log.require(*MOTION, *sensed, *(PUSH[:1] if mission.pilot.push == "truth" else []))
    if mission.changes_in_flight:
        raise InputError(f"mission {name} changes in flight: leave out [[changes]] and person.recording")
    check_columns(log, mission.vehicle, name)
    begins = {stream: float(log[stream].time[0]) for stream in (*MOTION, *sensed)}
    if (begin := min(begins.values())) > LATE:
        shift = f"log.aligned([*log], {-begin:.9g})"
        raise InputError(f"{log.source}: begins at {begin:.9g} s, and mission {name} at 0 s: shift it by {shift}")
    if late := [f"{stream} at {at:.4g} s" for stream, at in begins.items() if at > LATE]:
        found = f"{', '.join(late)}: until then, the first sample is held"
        warnings.warn(FlightWarning(f"{log.source}: begins late: {found}"), stacklevel=3)
    start = log[MOTION[0]].values[0]
    if np.linalg.norm(start - mission.initial.position) > ELSEWHERE:
        at, other = np.round(start, 3).tolist(), list(mission.initial.position)
        raise InputError(f"{log.source}: begins at {at} m, mission {name} at {other} m: set initial.position")
    for device, interval, stream in (
        ("", mission.sensors.interval, RATES),
        (".motion", mission.sensors.motion.interval, MOTION[0]),
    ):
        asked = 1.0 / (interval or mission.mission.step)
        if sensed != (RATES,) and log.rate(stream) < SPARSE * asked:
            found = f"{stream} at {log.rate(stream):.4g} Hz, which mission {name} samples at {asked:.4g} Hz"
            set_it = f"set sensors{device}.interval = {1.0 / max(log.rate(stream), 0.1):.4g}"
            warnings.warn(FlightWarning(f"{log.source}: has {found}: samples are held between; {set_it}"), stacklevel=3)
    if log.end < mission.mission.step:
        raise InputError(f"{log.source}: ends at {log.end:g} s, before the first step of the mission")


def plan_of(log: Log, mission: Mission) -> FlightPlan:
    """The plan of a flight as long as a log, from its first readings, whose sensors have no errors of their own."""
    step = mission.mission.step
    duration = int(log.end / step + SOON) * step
    calm = {"mission": {"duration": duration}, "pushes": [], "sensor_faults": [], "person": {"model": "none"}}
    tables = merge(tables_of(mission), calm)
    missions = check(tables, quiet=True), check(merge(tables, {"sensors": EXACT}), quiet=True)
    p, exact = (FlightPlan(m, interactive=PUSH[0] in log) for m in missions)
    numbers = np.array(flat(p.model._replace(sensors=exact.model.sensors)))
    for device, names in (("imu", (*IMU, *JOINTS)), ("motion", MOTION), ("joints", JOINTS)):
        for name in (n for n in names if n in log):
            for above, below in HOLDERS:
                place = p.place("flight_state", *above, device, *below, name.removeprefix("measured_"))
                if place.size:
                    numbers[place.at : place.at + place.size] = rows(log, name, np.array([-p.dt]))[0]
    state = p.place("flight_state", "state")
    numbers[state.at : state.at + state.size] = np.hstack([log[name].at(np.zeros(1))[0] for name in (*MOTION, RATES)])
    p.model = unflat(numbers, p.model)
    return p


def commands_of(channels: Container[str]) -> str:
    """The channel of the pilot's commands: thrusts of ideal rotors are their commands."""
    return COMMANDS if COMMANDS in channels else "rotor_thrusts"


def flown_commands(log: Log, constants: Array, times: Array) -> Array | None:
    """The commanded thrusts (n, 4N) [N] at some times; of speeds, by the thrust constants of the rotors (4N)."""
    if COMMANDS in log:
        return log[COMMANDS].at(times)
    if SPEED_COMMANDS not in log:
        return None
    return constants * log[SPEED_COMMANDS].at(times) ** 2
