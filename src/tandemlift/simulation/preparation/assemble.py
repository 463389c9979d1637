"""Assembles the flight of a mission: state and parameters at t = 0, and external inputs.

All random numbers derive from the mission's seed: constant errors and the initial turbulence are drawn here, the rest
step by step by a counter-based generator with the seed's key.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
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
from tandemlift.parts.mechanics.structure import seen_state
from tandemlift.parts.mechanics.wind import wind_noise_of
from tandemlift.parts.person.person import PersonState
from tandemlift.parts.person.person_table import PersonTable, path_legs_from, tremor_noise_of, walk_from
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


def start_estimators(facts: Facts, readings: Readings | Absent) -> tuple[Any, Any]:
    """The estimators of a mission and their memory at t = 0, for the nominal vehicle; or `Absent`."""
    if isinstance(readings, Absent):
        return Absent(), Absent()
    e, s, vehicle, step, interval = (facts[name] for name in ("estimator", "sensors", "vehicle", "step", "interval"))
    push, pushed = start_push_estimator(
        e, s, vehicle, readings.imu, interval, facts["observer"].rotor_delay + s.delay, facts["floor_height"]
    )
    stopped = each(vehicle.rotor_count)(*[0.0] * vehicle.rotor_count)
    observer, state = navigator_from(e, s, vehicle.center_of_mass, step), facts["state"]
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


def start_perception(facts: Facts) -> tuple[dict[str, Any], dict[str, Any], SensorNoise | Absent]:
    """Parameters and memory of sensors and estimators before the first step, and the layout of their noise."""
    sensors, faulty, step, count = facts["sensors"], facts["sensor_faults"], facts["step"], facts["vehicle"].count
    devices, noise = sensors_from(sensors, count, step, facts["chance"])
    sensing: Any = Absent()
    readings: Any = Absent()
    if not isinstance(devices, Absent):
        body, waits = facts["body"], first_samples(sensors, step)
        perfect = facts.call(readings_at_rest, {"plant": body, "s": facts["state"]})
        state = seen_state(body.structure, facts["shape"], facts["state"])
        sensing = start_sensing(devices, state, perfect, state.attitude, waits)
        readings = readings_of(sensing)
    estimators, known = start_estimators(facts, readings)
    if facts["supervised"]:
        watchdog = facts["supervision"].watchdog
        estimators, known = with_watchdogs(watchdog, sensors, step, estimators, known, readings)
    if faulty:
        names = [s.name for s in sensors.additional]
        faults = sensor_faults_from(faulty, count if sensors.joints.model != "none" else 0, names, step)
        devices, sensing = with_faults(faults, devices, sensing)
    memory = {"sensing": sensing, "readings": readings, "estimator": known}
    return {"sensors": devices, "estimator": estimators}, memory, noise


STARTED: Mapping[str, Callable[..., Any]] = {
    "state": start_state,
    "body": plant_from,
    "grip": lambda body, state: Absent() if isinstance(body.floor, Absent) else _grip(body.floor, state),
    "near": lambda body: near_walls_from(body.walls),
    "hand": push_kind,
    "floor_height": lambda ground, body: body.floor.height if ground.effect else None,  # m: of one with ground effect
    "delays": delays_from,
    "rotors": start_rotors,
    "weights": lambda allocation: allocation.weights,
    "delayed": lambda delays: bool(delays[2]),
    "scale": lambda plant: plant.thrust_scale,
    "thrusts": lambda rotors: rotors[2],
    "shape": start_shape,
    "elastic": lambda shape: not isinstance(shape, Absent),
    "seed": lambda mission: mission.seed,
    "chance": lambda seed: np.random.default_rng(seed),
    "walk": walk_from,
}
"""What is made of a mission's facts at t = 0: the true body, its surroundings, its rotors, the person's way."""


def assemble(mission: Mission) -> AssembledFlight:
    """Assemble the flight of a mission at t = 0.

    Raises:
        InputError: a part of the mission cannot be built.
    """
    facts = Facts(mission, STARTED)
    pilot, memory = start_pilot(facts)
    around, states = facts.started("body")  # the wind is drawn before the sensors: bits hang on the order
    senses, sensed, noise = start_perception(facts)
    body, state, near, delays = (facts[name] for name in ("body", "state", "near", "delays"))
    (rotors, spinning, thrusts), person, limits = facts["rotors"], around["person"], facts.call(crash_limits_from)
    flight_state = FlightState(
        state=state,
        memory=memory,
        shape=facts["shape"],
        grip=facts["grip"],
        near=near,
        touches=start_touches(body.floor, body.walls, facts["vehicle"].rotor_count),
        rotors=spinning,
        metrics=start_metrics(
            _clearance(body.walls, near, body.frame, state),
            states["person"],
            counted=mission.estimator.error_metrics and mission.sensors.model != "none",
        ),
        impulse=Absent() if isinstance(limits.strike, Absent) else 0.0,
        crash=start_crash(limits, state),
        ended=FLIES,
        detectors=start_detectors(mission.actuators, thrusts, elastic=facts["elastic"]),
        **(states | sensed),
    )
    model = FlightModel(
        flight_state=flight_state,
        pilot=pilot,
        plant=body,
        rotors=rotors,
        sources=PilotSources(READS[mission.pilot.state], READS[mission.pilot.push], MAPS[mission.pilot.map]),
        delays=delay_lines_from([s.name for s in mission.sensors.additional], delays),
        limits=limits,
        finding_limits=facts.call(finding_limits_from),
        **(around | senses),
    )
    noises = StepNoise(wind_noise_of(around["wind"]), noise, tremor_noise_of(person))
    inputs = StepInputs(facts["hand"], ZERO, noises, states["person"])
    legs = path_legs_from(mission.person, person, facts["walk"])
    tables = input_tables_from(mission.pushes, mission.wind, mission.all_walls, legs)
    return AssembledFlight(model, inputs, tables, delays, np.array(key_from_seed(facts["seed"])))
