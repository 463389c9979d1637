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
from tandemlift.core.vector import ZERO, Absent, each, vec3
from tandemlift.engines.compiled import plant_from, readings_at_rest, start_shape, start_state
from tandemlift.missions import Mission
from tandemlift.missions.facts import Facts
from tandemlift.parts.contact.clearance import Clearance, clearance
from tandemlift.parts.contact.feet import start_foot_grip
from tandemlift.parts.contact.touches import start_touches
from tandemlift.parts.controllers import controller
from tandemlift.parts.estimation.fused_push import start_push_estimator
from tandemlift.parts.estimation.navigation import navigator_from, start_navigation
from tandemlift.parts.estimation.wrench_push import PushInputs, push_and_state
from tandemlift.parts.guidance.guidance import flight_spans
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.structure import seen_state
from tandemlift.parts.mechanics.wind import wind_noise_of
from tandemlift.parts.person.person import PersonState
from tandemlift.parts.person.person_table import PersonTable, Walk, path_legs_from, tremor_noise_of, waypoints_from
from tandemlift.parts.pilot.pilot import PilotMemory, PilotParameters
from tandemlift.parts.rotors.allocation import start_allocation
from tandemlift.parts.rotors.rotors import ActuatorsTable, start_rotors
from tandemlift.parts.sensors.readings import (
    Readings,
    SensorNoise,
    by_name,
    readings_of,
    start_sensing,
)
from tandemlift.parts.sensors.sensor_faults import sensor_faults_from
from tandemlift.parts.sensors.sensors_table import SensorsTable, first_samples, steps_of
from tandemlift.parts.sensors.start_sensors import sensors_from
from tandemlift.simulation.loop import perception
from tandemlift.simulation.loop.estimate_errors import NO_ERRORS
from tandemlift.simulation.loop.external_inputs import InputTables, input_tables_from, near_walls_from, push_kind
from tandemlift.simulation.loop.fault_tolerant_perception import (
    with_faults,
    with_watchdogs,
)
from tandemlift.simulation.loop.random_numbers import key_from_seed
from tandemlift.simulation.loop.running_metrics import EMPTY, NO_EFFORT, RunningMetrics
from tandemlift.simulation.loop.sources import MAPS, READS, Delayed, DelayLines, NominalVehicle, PilotSources
from tandemlift.simulation.loop.step import FlightModel, FlightState, StepInputs, StepNoise
from tandemlift.simulation.preparation.limits import (
    crash_limits_from,
    finding_limits_from,
    start_crash,
    start_detectors,
)

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


def start_pilot(facts: Facts) -> tuple[PilotParameters, PilotMemory]:
    """The pilot of a mission before its first sample, for its nominal vehicle.

    Raises:
        InputError: the controller is not registered, or the allocation weights do not fit the vehicle.
    """
    table, vehicle = facts["controller"], facts["vehicle"]
    gains, memory = controller(table.name).start(table, vehicle, facts["step"])
    allocation, allocated = start_allocation(facts["allocation"], vehicle, facts["known"])
    parts, memories = facts.started("pilot")
    parameters = PilotParameters(controller=gains, allocation=allocation, **parts)
    return parameters, PilotMemory(controller=memory, allocation=allocated, **memories)


def start_estimators(
    facts: Facts, state: State, readings: Readings | Absent, floor: float | None
) -> tuple[perception.Estimators | Absent, perception.EstimatorState | Absent]:
    """The estimators of a mission and their memory at t = 0, for the nominal vehicle; or `Absent`.

    `floor`: height z [m] of a floor with ground effect, or None.
    """
    if isinstance(readings, Absent):
        return Absent(), Absent()
    e, s, vehicle, step, interval = (facts[name] for name in ("estimator", "sensors", "vehicle", "step", "interval"))
    push, pushed = start_push_estimator(
        e, s, vehicle, readings.imu, interval, facts["observer"].rotor_delay + s.delay, floor
    )
    stopped = each(vehicle.rotor_count)(*[0.0] * vehicle.rotor_count)
    observer = navigator_from(e, s, vehicle.center_of_mass, step)
    navigation, inputs = start_navigation(observer, state), PushInputs(readings, stopped, 0.0, 0.0, interval)
    parts, memories = facts.started("estimators")
    held: perception.HeldEstimates | Absent = Absent()
    if steps_of(s.interval, step) > 1:
        first, contact = push_and_state(push, pushed, observer, navigation, inputs).push, memories["contact"]
        touching = contact if isinstance(contact, Absent) else contact.contact
        held = perception.HeldEstimates(first, state, touching, 0.0)
    drag = vehicle.drag
    estimators = perception.Estimators(
        push=push,
        state=observer,
        vehicle=NominalVehicle(vec3(vehicle.payload_center), vec3(drag.force), vec3(drag.moment)),
        tare=perception.TareInHover() if e.tare == "hover" else perception.TareAtTime(),
        sampling=Absent() if isinstance(held, Absent) else perception.Sampling(interval),
        hover=Absent() if facts["interactive"] else flight_spans(facts["phases"], facts["ground"].model)[1],
        **parts,
    )
    return estimators, perception.EstimatorState(pushed, navigation, held=held, **memories)


def start_perception(
    facts: Facts, state: State, at_rest: Callable[[], Any], floor: float | None
) -> tuple[dict[str, Any], dict[str, Any], SensorNoise | Absent]:
    """Parameters and memory of sensors and estimators before the first step, and the layout of their noise.

    `at_rest` gives the perfect readings at the start. `floor`: height z [m] of a floor with ground effect, or None.
    """
    sensors, faulty, step, count = facts["sensors"], facts["sensor_faults"], facts["step"], facts["vehicle"].count
    devices, noise = sensors_from(sensors, count, step, facts["chance"])
    sensing: Any = Absent()
    readings: Any = Absent()
    if not isinstance(devices, Absent):
        waits = first_samples(sensors, step)
        sensing = start_sensing(devices, state, at_rest(), state.attitude, waits)
        readings = readings_of(sensing)
    estimators, known = start_estimators(facts, state, readings, floor)
    if facts["supervised"]:
        watchdog = facts["supervision"].watchdog
        estimators, known = with_watchdogs(watchdog, sensors, step, estimators, known, readings)
    if faulty:
        names = [s.name for s in sensors.additional]
        faults = sensor_faults_from(faulty, count if sensors.joints.model != "none" else 0, names, step)
        devices, sensing = with_faults(faults, devices, sensing)
    memory = {"sensing": sensing, "readings": readings, "estimator": known}
    return {"sensors": devices, "estimator": estimators}, memory, noise


def assemble(mission: Mission) -> AssembledFlight:
    """Assemble the flight of a mission at t = 0.

    Raises:
        InputError: a part of the mission cannot be built.
    """
    facts, step, seed = Facts(mission), mission.mission.step, mission.mission.seed
    vehicle = facts["vehicle"]
    delays = facts.call(delays_from)
    pilot, memory = start_pilot(facts)
    state, plant = start_state(mission), plant_from(mission, vehicle)
    grip = Absent() if isinstance(plant.floor, Absent) else _grip(plant.floor, state)
    weights, over = mission.allocation.weights, plant.floor.height if mission.ground.effect else None
    given: Any = {"weights": weights, "floor": over, "delayed": bool(delays[2]), "scale": mission.plant.thrust_scale}
    rotors, spinning, thrusts = start_rotors(mission.actuators, mission.faults, vehicle, step, **given)
    waypoints = waypoints_from(mission.person, mission.corridor)
    walk = Walk(waypoints, state, mission.initial.euler[2], mission.phases.height)
    facts.update(chance=np.random.default_rng(seed), walk=walk)
    around, states = facts.started("body")  # the wind is drawn before the sensors: bits hang on the order
    person = around["person"]
    bends = mission.vehicle.payload.is_elastic
    near, hand = near_walls_from(plant.walls), push_kind(mission.pushes, mission.person, bends=bends)
    shape = start_shape(plant, state, grip, near, thrusts, hand)
    at_rest = lambda: readings_at_rest(plant, state, shape, grip, near, thrusts, hand)  # noqa: E731
    senses, sensed, noise = start_perception(facts, seen_state(plant.structure, shape, state), at_rest, over)
    far, counted = _clearance(plant.walls, near, plant.frame, state), mission.estimator.error_metrics
    mass, floor = vehicle.mass * mission.plant.mass_scale, mission.ground.model != "none"
    limits = crash_limits_from(mission.crash, mission.supervision, mass, floor=floor)
    flight_state = FlightState(
        state=state,
        memory=memory,
        shape=shape,
        grip=grip,
        near=near,
        touches=start_touches(plant.floor, plant.walls, vehicle.rotor_count),
        rotors=spinning,
        metrics=start_metrics(far, states["person"], counted=counted and mission.sensors.model != "none"),
        impulse=Absent() if isinstance(limits.strike, Absent) else 0.0,
        crash=start_crash(limits, state),
        ended=FLIES,
        detectors=start_detectors(mission.actuators, thrusts, elastic=not isinstance(shape, Absent)),
        **(states | sensed),
    )
    model = FlightModel(
        flight_state=flight_state,
        pilot=pilot,
        plant=plant,
        rotors=rotors,
        sources=PilotSources(READS[mission.pilot.state], READS[mission.pilot.push], MAPS[mission.pilot.map]),
        delays=delay_lines_from([s.name for s in mission.sensors.additional], delays),
        limits=limits,
        finding_limits=finding_limits_from(mission),
        **(around | senses),
    )
    noises = StepNoise(wind_noise_of(around["wind"]), noise, tremor_noise_of(person))
    inputs = StepInputs(hand, ZERO, noises, states["person"])
    legs, seeds = path_legs_from(mission.person, person, walk), np.array(key_from_seed(seed))
    tables = input_tables_from(mission.pushes, mission.wind, mission.all_walls, legs)
    return AssembledFlight(model, inputs, tables, delays, seeds)
