"""Assembles the flight of a mission: state and parameters at t = 0, and external inputs.

All random numbers derive from the mission's seed: constant errors and the initial turbulence are drawn here, the rest
step by step by a counter-based generator with the seed's key.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
from tandemlift.parts.person.person_table import PersonTable, Walk, path_legs_from, start_person, waypoints_from
from tandemlift.parts.rotors.rotors import ActuatorsTable, start_rotors
from tandemlift.parts.sensors.readings import (
    Readings,
    SensorNoise,
    Sensors,
    SensorState,
    by_name,
    readings_of,
    start_sensing,
)
from tandemlift.parts.sensors.sensor_faults import sensor_faults_from
from tandemlift.parts.sensors.sensors_table import SensorsTable, first_samples
from tandemlift.parts.sensors.start_sensors import sensors_from
from tandemlift.simulation.loop.estimate_errors import NO_ERRORS
from tandemlift.simulation.loop.external_inputs import InputTables, input_tables_from, near_walls_from, push_kind
from tandemlift.simulation.loop.fault_tolerant_perception import (
    FaultySensors,
    FaultySensorsState,
    WatchedEstimators,
    WatchedEstimatorsState,
    with_faults,
    with_watchdogs,
)
from tandemlift.simulation.loop.perception import Estimators, EstimatorState
from tandemlift.simulation.loop.random_numbers import key_from_seed
from tandemlift.simulation.loop.running_metrics import EMPTY, NO_EFFORT, RunningMetrics
from tandemlift.simulation.loop.sources import MAPS, READS, Delayed, DelayLines, PilotSources
from tandemlift.simulation.loop.step import FlightModel, FlightState, StepInputs, StepNoise
from tandemlift.simulation.preparation.limits import (
    crash_limits_from,
    finding_limits_from,
    start_crash,
    start_detectors,
)
from tandemlift.simulation.preparation.start_pilot import start_estimators, start_pilot

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


def delays_from(
    sensors: SensorsTable, actuators: ActuatorsTable, person: PersonTable, step: float
) -> NDArray[np.int64]:
    """Delays in steps, in the order of `DelayLines`: of IMU, motion, commands, sight, and additional sensors."""
    simulated, real = sensors.model == "simulated", actuators.model == "rotors"
    seconds = [sensors.delay * simulated, sensors.motion.delay * simulated, actuators.delay * real]
    steps = [round(s / step) for s in seconds]
    sight = round(person.delay / step) - 1  # a step of delay is inherent
    accompanied = person.model not in ("none", "virtual-hand")
    more = [round(s.delay / step) * simulated for s in sensors.additional]
    return np.array([*steps, max(sight, 0) * accompanied, *more], dtype=np.int64)


def delay_lines_from(names: Sequence[str], delays: NDArray[np.int64]) -> DelayLines | Absent:
    """The delay lines of these delays, the last of which are of additional sensors; `Absent` if all are 0."""
    if not delays.any():
        return Absent()
    imu, motion, command, view, *more = [Delayed() if d else Absent() for d in delays]
    return DelayLines(imu, motion, command, view, by_name(tuple(names))(*more))


def start_metrics(far: Clearance | Absent, person: PersonState | Absent, *, counted: bool) -> RunningMetrics:
    """The running metrics before the first step.

    `far`: the clearance before the first search for walls. `counted`: whether errors of the estimated push are.
    """
    effort, errors = person if isinstance(person, Absent) else NO_EFFORT, NO_ERRORS if counted else Absent()
    return EMPTY._replace(clearance=far, effort=effort, estimate=errors)


class StartedPerception(NamedTuple):
    """Sensors with their memory, noise and first readings, and estimators with theirs; each may be `Absent`."""

    devices: Sensors | FaultySensors | Absent
    sensing: SensorState | FaultySensorsState | Absent
    noise: SensorNoise | Absent
    readings: Readings | Absent
    estimators: WatchedEstimators | Estimators | Absent
    known: WatchedEstimatorsState | EstimatorState | Absent


def start_perception(
    mission: Mission, vehicle: Vehicle, state: State, chance: Any, at_rest: Callable[[], Any], floor: float | None
) -> StartedPerception:
    """Sensors and estimators before the first step; `at_rest` gives the perfect readings at the start.

    `floor`: height z [m] of a floor with ground effect, or None.
    """
    step = mission.mission.step
    devices, noise = sensors_from(mission.sensors, vehicle.count, step, chance)
    sensing: Any = Absent()
    readings: Any = Absent()
    if not isinstance(devices, Absent):
        waits = first_samples(mission.sensors, step)
        sensing = start_sensing(devices, state, at_rest(), state.attitude, waits)
        readings = readings_of(sensing)
    estimators, known = start_estimators(mission, vehicle, state, readings, floor)
    if mission.supervision.model != "none":
        watchdog = mission.supervision.watchdog
        estimators, known = with_watchdogs(watchdog, mission.sensors, step, estimators, known, readings)
    if mission.sensor_faults:
        names = [s.name for s in mission.sensors.additional]
        joints = vehicle.count if mission.sensors.joints.model != "none" else 0
        faults = sensor_faults_from(mission.sensor_faults, joints, names, step)
        devices, sensing = with_faults(faults, devices, sensing)
    return StartedPerception(
        devices=devices, sensing=sensing, noise=noise, readings=readings, estimators=estimators, known=known
    )


def assemble(mission: Mission) -> AssembledFlight:
    """Assemble the flight of a mission at t = 0.

    Raises:
        InputError: a part of the mission cannot be built.
    """
    vehicle, step, seed = Vehicle.from_settings(mission.vehicle), mission.mission.step, mission.mission.seed
    chance, delays = np.random.default_rng(seed), delays_from(mission.sensors, mission.actuators, mission.person, step)
    pilot, memory = start_pilot(mission, vehicle)
    state, plant = start_state(mission), plant_from(mission, vehicle)
    grip = Absent() if isinstance(plant.floor, Absent) else _grip(plant.floor, state)
    weights, over = mission.allocation.weights, plant.floor.height if mission.ground.effect else None
    given: Any = {"weights": weights, "floor": over, "delayed": bool(delays[2]), "scale": mission.plant.thrust_scale}
    rotors, spinning, thrusts = start_rotors(mission.actuators, mission.faults, vehicle, step, **given)
    wind, wind_state = start_wind(mission.wind, vehicle, step, chance)  # before the sensors: bits hang on the order
    near, hand = near_walls_from(plant.walls), push_kind(mission.pushes, mission.person)
    at_rest = lambda: readings_at_rest(plant, state, grip, near, thrusts, hand)  # noqa: E731
    senses = start_perception(mission, vehicle, state, chance, at_rest, over)
    waypoints = waypoints_from(mission.person, mission.corridor)
    walk = Walk(waypoints, state, mission.initial.euler[2], mission.phases.height)
    person, memory_of_person, tremor_noise = start_person(mission.person, vehicle, step, walk)
    far, counted = _clearance(plant.walls, near, plant.frame, state), mission.estimator.error_metrics
    mass, floor = vehicle.mass * mission.plant.mass_scale, mission.ground.model != "none"
    limits = crash_limits_from(mission.crash, mission.supervision, mass, floor=floor)
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
        metrics=start_metrics(far, memory_of_person, counted=counted and mission.sensors.model != "none"),
        impulse=Absent() if isinstance(limits.strike, Absent) else 0.0,
        crash=start_crash(limits, state),
        ended=FLIES,
        detectors=start_detectors(mission.actuators),
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
        delays=delay_lines_from([s.name for s in mission.sensors.additional], delays),
        limits=limits,
        finding_limits=finding_limits_from(mission, vehicle),
    )
    inputs = StepInputs(hand, ZERO, StepNoise(wind_noise_of(wind), senses.noise, tremor_noise), memory_of_person)
    legs, seeds = path_legs_from(mission.person, person, walk), np.array(key_from_seed(seed))
    tables = input_tables_from(mission.pushes, mission.wind, mission.all_walls, legs)
    return AssembledFlight(model, inputs, tables, delays, seeds)
