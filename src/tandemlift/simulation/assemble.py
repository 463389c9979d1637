"""A mission put together for the loop: the flight at t = 0, and what it is given from outside.

Everything random is drawn from the mission's seed: constant errors and the first eddies here, the rest step by step by
a counter-based generator with the seed's key.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.algebra.vector import ZERO, Nothing
from tandemlift.engines.compiled import readings_at_rest, start_plant, start_state
from tandemlift.kernels.external_inputs import InputTables
from tandemlift.laws.mechanics.clearance import clearance
from tandemlift.laws.mechanics.contact import start_foot_grip
from tandemlift.laws.mechanics.push import PushSamples
from tandemlift.laws.sensors.readings import by_name, readings_of, start_sensing
from tandemlift.laws.signals.random_numbers import key_from_seed
from tandemlift.loop.delays import Delayed, DelayLines
from tandemlift.loop.perception import READS, PilotSources
from tandemlift.loop.running_metrics import EMPTY, NO_EFFORT, RunningMetrics
from tandemlift.loop.step import FlightModel, FlightState, StepInputs, StepNoise
from tandemlift.models.surroundings import floor_from, walls_from
from tandemlift.pilot.assemble import start_pilot
from tandemlift.settings import Mission
from tandemlift.simulation.actuators import start_rotors
from tandemlift.simulation.disturbances import (
    input_tables_from,
    near_walls_from,
    push_kind,
    start_weather,
    wind_noise_from,
)
from tandemlift.simulation.persons import path_legs_from, start_person
from tandemlift.simulation.sensors import sensors_from, start_estimators
from tandemlift.simulation.watchdogs import with_faults, with_watchdogs
from tandemlift.vehicle import Vehicle


class AssembledFlight(NamedTuple):
    """A flight at t = 0, its inputs' layout, its tables, the delays in steps, its key."""

    flying: FlightModel
    given: StepInputs
    tables: InputTables
    delays: NDArray[np.int64]
    seeds: NDArray[np.float64]


def delays_from(mission: Mission) -> NDArray[np.int64]:
    """Delays in steps, in the order of `DelayLines`: of IMU, motion, commands, sight, and additional sensors."""
    simulated, real = mission.sensors.model == "simulated", mission.actuators.model == "rotors"
    seconds = [
        mission.sensors.delay * simulated,
        mission.sensors.motion.delay * simulated,
        mission.actuators.delay * real,
    ]
    steps = [round(s / mission.mission.step) for s in seconds]
    sight = round(mission.person.delay / mission.mission.step) - 1  # what is seen is known a step later anyway
    accompanied = mission.person.model not in ("none", "grab")
    more = [round(s.delay / mission.mission.step) * simulated for s in mission.sensors.additional]
    return np.array([*steps, max(sight, 0) * accompanied, *more], dtype=np.int64)


def delay_lines_from(mission: Mission, delays: NDArray[np.int64]) -> Any:
    """Which delay lines a mission has; `Nothing` if it has none."""
    if not delays.any():
        return Nothing()
    imu, motion, command, seen, *more = [Delayed() if d else Nothing() for d in delays]
    names = tuple(s.name for s in mission.sensors.additional)
    return DelayLines(imu, motion, command, seen, by_name(names)(*more))


def start_metrics(far: Any, company: Any) -> RunningMetrics:
    """The tally of a flight before its first step; `far`: the clearance before any wall was looked at."""
    return EMPTY._replace(clearance=far, effort=company if isinstance(company, Nothing) else NO_EFFORT)


def assemble(mission: Mission) -> AssembledFlight:
    """A mission's loop at t = 0.

    Raises:
        InputError: something in the mission cannot be built.
    """
    vehicle = Vehicle.from_settings(mission.vehicle)
    chance = np.random.default_rng(mission.mission.seed)
    pilot, memory = start_pilot(mission, vehicle)
    state, floor, walls = start_state(mission), floor_from(mission, vehicle), walls_from(mission, vehicle)
    plant = start_plant(mission, vehicle, floor, walls)
    grip = Nothing() if isinstance(floor, Nothing) else start_foot_grip(floor, state)
    delays = delays_from(mission)
    rotors, spinning, thrusts = start_rotors(mission, vehicle, floor, delayed=bool(delays[2]))
    weather, eddies = start_weather(mission, vehicle, chance)
    push = push_kind(mission)
    near, hand = near_walls_from(walls), PushSamples(push, push, push)
    devices, hiss = sensors_from(mission, vehicle, chance)
    sensing: Any = Nothing()
    if not isinstance(devices, Nothing):
        felt = readings_at_rest(plant, state, grip, near, thrusts, hand)
        sensing = start_sensing(devices, state, felt, state.attitude)
    readings = Nothing() if isinstance(devices, Nothing) else readings_of(sensing)
    estimators, known = with_watchdogs(mission, *start_estimators(mission, vehicle, state, readings), readings)
    devices, sensing = with_faults(mission, devices, sensing)
    partner, company, twitch = start_person(mission, vehicle, state)
    tally = start_metrics(clearance(walls, near, plant.frame, state), company)
    moving = FlightState(state, memory, eddies, grip, near, sensing, known, spinning, readings, company, tally, 0.0)
    reads = PilotSources(READS[mission.pilot.state], READS[mission.pilot.push])
    late = delay_lines_from(mission, delays)
    flying = FlightModel(moving, pilot, plant, rotors, weather, devices, estimators, reads, partner, late)
    given = StepInputs(hand, ZERO, StepNoise(wind_noise_from(weather), hiss, twitch), company)
    return AssembledFlight(
        flying,
        given,
        input_tables_from(mission, path_legs_from(mission, partner, state)),
        delays,
        np.array(key_from_seed(mission.mission.seed)),
    )
