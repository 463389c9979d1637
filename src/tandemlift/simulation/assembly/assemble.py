"""A flight assembled from a mission: its state and parameters at t = 0, and its inputs from outside.

All random numbers derive from the mission's seed: constant errors and the initial turbulence are drawn here, the rest
step by step by a counter-based generator with the seed's key.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.algebra.vector import ZERO, Nothing
from tandemlift.core.caching import kept
from tandemlift.core.outcomes import FLIES
from tandemlift.core.settings import Mission
from tandemlift.engines.compiled import plant_from, readings_at_rest, start_state
from tandemlift.parts.contact.clearance import clearance
from tandemlift.parts.contact.feet import start_foot_grip
from tandemlift.parts.contact.touches import start_touches
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.pilot.assemble import start_pilot
from tandemlift.parts.sensors.readings import by_name, readings_of, start_sensing
from tandemlift.parts.signals.random_numbers import key_from_seed
from tandemlift.parts.vehicle import Vehicle
from tandemlift.simulation.assembly.actuators import start_rotors
from tandemlift.simulation.assembly.crash_limits import crash_limits_from, start_crash
from tandemlift.simulation.assembly.disturbances import (
    input_tables_from,
    near_walls_from,
    push_kind,
    start_weather,
    wind_noise_from,
)
from tandemlift.simulation.assembly.findings import finding_limits_from, start_detectors
from tandemlift.simulation.assembly.persons import path_legs_from, start_person
from tandemlift.simulation.assembly.sensors import sensors_from, start_estimators
from tandemlift.simulation.assembly.watchdogs import with_faults, with_watchdogs
from tandemlift.simulation.kernels.external_inputs import InputTables
from tandemlift.simulation.loop.delays import Delayed, DelayLines
from tandemlift.simulation.loop.perception import MAPS, READS, PilotSources
from tandemlift.simulation.loop.running_metrics import EMPTY, NO_EFFORT, RunningMetrics
from tandemlift.simulation.loop.step import FlightModel, FlightState, StepInputs, StepNoise

_grip, _clearance = kept(start_foot_grip), kept(clearance)


class AssembledFlight(NamedTuple):
    """An assembled flight.

    Attributes:
        model: the flight at t = 0.
        given: the layout of its inputs.
        tables: pushes, gusts, walls and path legs.
        delays: of IMU, motion sensor, rotor commands and the person's sight, in steps.
        seeds: the key of its random numbers.
    """

    model: FlightModel
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
    sight = round(mission.person.delay / mission.mission.step) - 1  # a step of delay is inherent
    accompanied = mission.person.model not in ("none", "virtual-hand")
    more = [round(s.delay / mission.mission.step) * simulated for s in mission.sensors.additional]
    return np.array([*steps, max(sight, 0) * accompanied, *more], dtype=np.int64)


def delay_lines_from(mission: Mission, delays: NDArray[np.int64]) -> Any:
    """Which delay lines a mission has; `Nothing` if it has none."""
    if not delays.any():
        return Nothing()
    imu, motion, command, view, *more = [Delayed() if d else Nothing() for d in delays]
    names = tuple(s.name for s in mission.sensors.additional)
    return DelayLines(imu, motion, command, view, by_name(names)(*more))


def start_metrics(far: Any, person: Any) -> RunningMetrics:
    """The running metrics before the first step; `far`: the clearance before any wall was looked at."""
    return EMPTY._replace(clearance=far, effort=person if isinstance(person, Nothing) else NO_EFFORT)


class StartedPerception(NamedTuple):
    """Sensors with their memory, noise and first readings, and estimators with theirs; each may be `Nothing`."""

    devices: Any
    sensing: Any
    noise: Any
    readings: Any
    estimators: Any
    known: Any


def start_perception(
    mission: Mission, vehicle: Vehicle, state: State, chance: np.random.Generator, at_rest: Callable[[], Any]
) -> StartedPerception:
    """Sensors and estimators before the first step; `at_rest` gives the perfect readings at the start."""
    devices, noise = sensors_from(mission, vehicle, chance)
    sensing: Any = Nothing()
    readings: Any = Nothing()
    if not isinstance(devices, Nothing):
        sensing = start_sensing(devices, state, at_rest(), state.attitude)
        readings = readings_of(sensing)
    estimators, known = with_watchdogs(mission, *start_estimators(mission, vehicle, state, readings), readings)
    devices, sensing = with_faults(mission, devices, sensing)
    return StartedPerception(
        devices=devices, sensing=sensing, noise=noise, readings=readings, estimators=estimators, known=known
    )


def assemble(mission: Mission) -> AssembledFlight:
    """Assemble the flight of a mission at t = 0.

    Raises:
        InputError: a part of the mission cannot be built.
    """
    vehicle = Vehicle.from_settings(mission.vehicle)
    chance = np.random.default_rng(mission.mission.seed)
    pilot, memory = start_pilot(mission, vehicle)
    state, plant = start_state(mission), plant_from(mission, vehicle)
    grip = Nothing() if isinstance(plant.floor, Nothing) else _grip(plant.floor, state)
    delays = delays_from(mission)
    rotors, spinning, thrusts = start_rotors(mission, vehicle, plant.floor, delayed=bool(delays[2]))
    wind, wind_state = start_weather(mission, vehicle, chance)
    near, hand = near_walls_from(plant.walls), push_kind(mission)
    at_rest = lambda: readings_at_rest(plant, state, grip, near, thrusts, hand)  # noqa: E731
    senses = start_perception(mission, vehicle, state, chance, at_rest)
    person, memory_of_person, tremor_noise = start_person(mission, vehicle, state)
    limits = crash_limits_from(mission, vehicle)
    flight_state = FlightState(
        state=state,
        memory=memory,
        wind=wind_state,
        grip=grip,
        near=near,
        touches=start_touches(plant.floor, plant.walls, vehicle.rotor_count),
        sensing=senses.sensing,
        estimator=senses.known,
        rotors=spinning,
        readings=senses.readings,
        person=memory_of_person,
        metrics=start_metrics(_clearance(plant.walls, near, plant.frame, state), memory_of_person),
        impulse=Nothing() if isinstance(limits.strike, Nothing) else 0.0,
        crash=start_crash(limits, state),
        ended=FLIES,
        detectors=start_detectors(mission),
    )
    model = FlightModel(
        flight_state=flight_state,
        pilot=pilot,
        plant=plant,
        rotors=rotors,
        wind=wind,
        sensors=senses.devices,
        estimator=senses.estimators,
        sources=PilotSources(READS[mission.pilot.state], READS[mission.pilot.push], MAPS[mission.pilot.map]),
        person=person,
        delays=delay_lines_from(mission, delays),
        limits=limits,
        finding_limits=finding_limits_from(mission, vehicle),
    )
    given = StepInputs(hand, ZERO, StepNoise(wind_noise_from(wind), senses.noise, tremor_noise), memory_of_person)
    return AssembledFlight(
        model,
        given,
        input_tables_from(mission, path_legs_from(mission, person, state)),
        delays,
        np.array(key_from_seed(mission.mission.seed)),
    )
