"""Assembles the flight of a mission: state and parameters at t = 0, and external inputs.

All random numbers derive from the mission's seed: constant errors and the initial turbulence are drawn here, the rest
step by step by a counter-based generator with the seed's key.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.caching import cached
from tandemlift.core.phases import FLIES
from tandemlift.core.vector import ZERO, Absent
from tandemlift.engines.compiled import plant_from, readings_at_rest, start_state
from tandemlift.missions import Mission
from tandemlift.parts.contact.clearance import Clearance, clearance
from tandemlift.parts.contact.feet import start_foot_grip
from tandemlift.parts.contact.touches import start_touches
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.wind import start_wind, wind_noise_of
from tandemlift.parts.person.person import PersonState
from tandemlift.parts.person.person_table import Walk, path_legs_from, start_person, waypoints_from
from tandemlift.parts.rotors.rotors import start_rotors
from tandemlift.parts.sensors.readings import (
    Readings,
    SensorNoise,
    Sensors,
    SensorState,
    by_name,
    readings_of,
    start_sensing,
)
from tandemlift.parts.sensors.sensors_table import sensors_from
from tandemlift.simulation.assembly.crash_limits import crash_limits_from, start_crash
from tandemlift.simulation.assembly.detector_limits import finding_limits_from, start_detectors
from tandemlift.simulation.assembly.estimators import start_estimators
from tandemlift.simulation.assembly.inputs import input_tables_from, near_walls_from, push_kind
from tandemlift.simulation.assembly.pilot import start_pilot
from tandemlift.simulation.assembly.watchdogs import with_faults, with_watchdogs
from tandemlift.simulation.loop.delays import Delayed, DelayLines
from tandemlift.simulation.loop.fault_tolerant_perception import (
    FaultySensors,
    FaultySensorsState,
    WatchedEstimators,
    WatchedEstimatorsState,
)
from tandemlift.simulation.loop.perception import Estimators, EstimatorState
from tandemlift.simulation.loop.random_numbers import key_from_seed
from tandemlift.simulation.loop.running_metrics import EMPTY, NO_EFFORT, RunningMetrics
from tandemlift.simulation.loop.sources import MAPS, READS, PilotSources
from tandemlift.simulation.loop.step import FlightModel, FlightState, StepInputs, StepNoise
from tandemlift.simulation.loop_code.external_inputs import InputTables

_grip, _clearance = cached(start_foot_grip), cached(clearance)


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


def delay_lines_from(mission: Mission, delays: NDArray[np.int64]) -> DelayLines | Absent:
    """The delay lines of a mission; `Absent` if it has none."""
    if not delays.any():
        return Absent()
    imu, motion, command, view, *more = [Delayed() if d else Absent() for d in delays]
    names = tuple(s.name for s in mission.sensors.additional)
    return DelayLines(imu, motion, command, view, by_name(names)(*more))


def start_metrics(far: Clearance | Absent, person: PersonState | Absent) -> RunningMetrics:
    """The running metrics before the first step; `far`: the clearance before the first search for walls."""
    return EMPTY._replace(clearance=far, effort=person if isinstance(person, Absent) else NO_EFFORT)


class StartedPerception(NamedTuple):
    """Sensors with their memory, noise and first readings, and estimators with theirs; each may be `Absent`."""

    devices: Sensors | FaultySensors | Absent
    sensing: SensorState | FaultySensorsState | Absent
    noise: SensorNoise | Absent
    readings: Readings | Absent
    estimators: WatchedEstimators | Estimators | Absent
    known: WatchedEstimatorsState | EstimatorState | Absent


def start_perception(
    mission: Mission, vehicle: Vehicle, state: State, chance: np.random.Generator, at_rest: Callable[[], Any]
) -> StartedPerception:
    """Sensors and estimators before the first step; `at_rest` gives the perfect readings at the start."""
    devices, noise = sensors_from(mission.sensors, vehicle.count, mission.mission.step, chance)
    sensing: Any = Absent()
    readings: Any = Absent()
    if not isinstance(devices, Absent):
        sensing = start_sensing(devices, state, at_rest(), state.attitude)
        readings = readings_of(sensing)
    estimators, known = with_watchdogs(mission, *start_estimators(mission, vehicle, state, readings), readings)
    devices, sensing = with_faults(mission, devices, sensing)
    return StartedPerception(
        devices=devices, sensing=sensing, noise=noise, readings=readings, estimators=estimators, known=known
    )


def _start_rotors(mission: Mission, vehicle: Vehicle, floor: Any, *, delayed: bool) -> tuple[Any, Any, Any]:
    near_ground = mission.ground.effect and mission.actuators.model == "rotors"
    return start_rotors(
        mission.actuators,
        mission.faults,
        vehicle,
        mission.mission.step,
        weights=mission.allocation.weights,
        floor=floor.height if near_ground else None,
        delayed=delayed,
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
    grip = Absent() if isinstance(plant.floor, Absent) else _grip(plant.floor, state)
    delays = delays_from(mission)
    rotors, spinning, thrusts = _start_rotors(mission, vehicle, plant.floor, delayed=bool(delays[2]))
    wind, wind_state = start_wind(mission.wind, vehicle, mission.mission.step, chance)
    near, hand = near_walls_from(plant.walls), push_kind(mission)
    at_rest = lambda: readings_at_rest(plant, state, grip, near, thrusts, hand)  # noqa: E731
    senses = start_perception(mission, vehicle, state, chance, at_rest)
    waypoints = waypoints_from(mission.person, mission.corridor)
    walk = Walk(waypoints, state, mission.initial.euler[2], mission.phases.height)
    person, memory_of_person, tremor_noise = start_person(mission.person, vehicle, mission.mission.step, walk)
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
        impulse=Absent() if isinstance(limits.strike, Absent) else 0.0,
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
    given = StepInputs(hand, ZERO, StepNoise(wind_noise_of(wind), senses.noise, tremor_noise), memory_of_person)
    tables = input_tables_from(mission, path_legs_from(mission.person, person, walk))
    return AssembledFlight(model, given, tables, delays, np.array(key_from_seed(mission.mission.seed)))
