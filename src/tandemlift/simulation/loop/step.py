"""The closed loop of pilot and body: one step of a flight, and its log sample.

At time t_k the pilot reads the state and the person's push, or their measurements and estimates, and decides; the
rotors respond; the body then moves for one step with their thrusts held and the push continuous. The pilot receives the
sensor readings of a step at the next one, or later. A part that a mission does not have is `Absent`, and costs nothing.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import where
from tandemlift.core.law import law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Quarters, Quat, Vec3
from tandemlift.engines.compiled import BodyStep, advance
from tandemlift.engines.compiled_contact import CompiledPlant
from tandemlift.engines.touches import touches_in
from tandemlift.parts.contact.feet import FootGrip
from tandemlift.parts.contact.touches import Touches, of_turning_rotors
from tandemlift.parts.contact.walls import NearWalls
from tandemlift.parts.guidance.requests import UNKNOWN_STATUS, operator_request
from tandemlift.parts.mechanics.push import Push, PushSamples
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.turbulence import TurbulenceState, WindNoise
from tandemlift.parts.mechanics.wind import WindModel, WindOutput, wind_loads
from tandemlift.parts.person.person import Person, PersonState, landing_request, person_step
from tandemlift.parts.person.tremor import TremorNoise
from tandemlift.parts.person.virtual_hand import VirtualHandState
from tandemlift.parts.pilot.pilot import (
    Decision,
    PilotInput,
    PilotMemory,
    PilotParameters,
    decide,
    last_thrusts,
    with_thrusts,
)
from tandemlift.parts.rotors.rotors import Rotors, RotorState, rotors_step
from tandemlift.parts.sensors.readings import Readings, SensorNoise, Sensors, SensorState
from tandemlift.simulation.loop.caller_inputs import (
    CallerInput,
    OutsidePush,
    commanded_thrusts,
    lead_of,
    with_caller_push,
)
from tandemlift.simulation.loop.detectors import Detectors, FindingLimits, detect
from tandemlift.simulation.loop.ending import (
    CrashLimits,
    CrashMemory,
    ending_number,
    impulse_after,
    unless_crashed,
    until_crash,
    with_aftermath,
)
from tandemlift.simulation.loop.fault_tolerant_perception import (
    CheckedEstimates,
    FaultySensors,
    FaultySensorsState,
    WatchedEstimators,
    WatchedEstimatorsState,
)
from tandemlift.simulation.loop.log_sample import Sample, log_sample
from tandemlift.simulation.loop.perception import (
    Estimates,
    Estimators,
    EstimatorState,
    all_sensed,
    estimate_all,
    measure,
    surroundings_of,
    tare_time,
    usable,
)
from tandemlift.simulation.loop.running_metrics import RunningMetrics, contribution_of, count
from tandemlift.simulation.loop.sources import DelayLines, PilotSources, read_push, read_state


class FlightState(NamedTuple):
    """The state of a flight; `ended`: 0 while it goes on, else the number of its ending (`core.phases`)."""

    state: State
    memory: PilotMemory
    wind: TurbulenceState | Absent
    grip: Quarters[FootGrip] | Absent
    near: NearWalls | Absent
    touches: Touches | Absent
    sensing: SensorState | FaultySensorsState | Absent
    estimator: WatchedEstimatorsState | EstimatorState | Absent
    rotors: RotorState | Absent
    readings: Readings | Absent
    person: PersonState | VirtualHandState | Absent
    metrics: RunningMetrics
    impulse: Number | Absent
    crash: CrashMemory | Absent
    ended: Number
    detectors: Detectors


class FlightModel(NamedTuple):
    """One flight: its state, and the parameters that stay. Its type is the variant of the compiled loop.

    `sources`: those of the pilot's state and push. `delays`: a `DelayLines`. `limits`: a `CrashLimits`.
    """

    flight_state: FlightState
    pilot: PilotParameters
    plant: CompiledPlant
    rotors: Rotors | Absent
    wind: WindModel | Absent
    sensors: Sensors | FaultySensors | Absent
    estimator: WatchedEstimators | Estimators | Absent
    sources: PilotSources
    person: Person | Absent
    delays: DelayLines | Absent
    limits: CrashLimits
    finding_limits: FindingLimits


class StepNoise(NamedTuple):
    """Standard normals of one step: of the wind, of the sensors, of the person."""

    wind: WindNoise | Absent
    sensors: SensorNoise | Absent
    person: TremorNoise | Absent


class StepInputs(NamedTuple):
    """The inputs of a step: the push, gusts [m/s], standard normals, and the person's memory once they have pushed.

    `external` is the input of a caller who steps the flight, else `Absent`. `outside` is the push that the body's own
    simulator applied; it is known once the body has moved, and is `Absent` if there is no such push.
    """

    hand: PushSamples[Push]
    gust: Vec3
    noise: StepNoise
    person: PersonState | VirtualHandState | Absent
    external: CallerInput | Absent = Absent()
    outside: OutsidePush | Absent = Absent()


class PilotOutput(NamedTuple):
    """The pilot's part of a step: estimates, the attitude that it uses, its decision, and the memories after it."""

    estimates: CheckedEstimates | Estimates | Absent
    attitude: Quat
    decision: Decision
    memory: PilotMemory
    estimator: WatchedEstimatorsState | EstimatorState | Absent


class Actuation(NamedTuple):
    """Inputs of the body over a step: rotor thrusts [N] and wind loads; with the rotors' memory."""

    thrusts: PerRotor
    rotors: RotorState | Absent
    wind: WindOutput


@law
def with_person(model: FlightModel, inputs: StepInputs, t: Number, dt: Number) -> StepInputs:
    """The inputs of a step, with the push of its caller and that of the person who guides the vehicle."""
    before, noise, push = model.flight_state, inputs.noise.person, with_caller_push(inputs.external, inputs.hand)
    hand, person = person_step(model.person, before.person, push, before.state, noise, t, dt)
    return inputs._replace(hand=hand, person=person)


@law
def perceive(
    model: FlightModel, inputs: StepInputs, t: Number, dt: Number
) -> tuple[CheckedEstimates | Estimates | Absent, PilotInput, WatchedEstimatorsState | EstimatorState | Absent]:
    """(estimates, the pilot's input, the estimators' memory) at time t [s]."""
    before, sources, push = model.flight_state, model.sources, inputs.hand.start
    since, commands = tare_time(model.estimator, before.memory.guidance, t), last_thrusts(before.memory.allocation)
    around = surroundings_of(model.estimator, sources, before.near, before.memory.guidance)
    estimates, memory = estimate_all(model.estimator, before.estimator, before.readings, around, commands, since, dt)
    readings = usable(estimates, before.readings)
    state = read_state(sources.state, before.state, readings, estimates)
    wrench = read_push(sources.push, push, state, estimates)
    pilot_input = PilotInput(
        state=state,
        push=wrench.force,
        moment=wrench.moment,
        land=landing_request(before.person),
        sensed=all_sensed(readings, estimates),
        operator=operator_request(before.person),
        status=UNKNOWN_STATUS,
        lead=lead_of(inputs.external),
    )
    return estimates, pilot_input, memory


@law
def run_pilot(model: FlightModel, inputs: StepInputs, t: Number, dt: Number) -> PilotOutput:
    """The pilot's part of a step."""
    estimates, pilot_input, estimator = perceive(model, inputs, t, dt)
    decision, memory = decide(model.pilot, model.flight_state.memory, pilot_input, t, dt)
    return PilotOutput(estimates, pilot_input.state.attitude, decision, memory, estimator)


@law
def with_caller_thrusts(output: PilotOutput, external: CallerInput | Absent) -> PilotOutput:
    """The pilot's part of a step, with the thrusts that the caller gives in place of the pilot's."""
    decision = output.decision
    return output._replace(decision=with_thrusts(decision, commanded_thrusts(external, decision.thrusts)))


@law
def actuate(model: FlightModel, thrusts: PerRotor, inputs: StepInputs, t: Number) -> Actuation:
    """The response of the rotors to commanded thrusts [N] over the step from time t [s], and the wind over it."""
    before = model.flight_state
    commanded = unless_crashed(before.crash, thrusts)
    driven, rotors = rotors_step(model.rotors, before.rotors, commanded, before.state, t)
    driven = of_turning_rotors(before.touches, driven)
    wind = wind_loads(model.wind, before.wind, model.plant.frame, before.state, inputs.gust, inputs.noise.wind)
    return Actuation(driven, rotors, wind)


@law
def finish_sample(
    model: FlightModel,
    output: PilotOutput,
    acting: Actuation,
    moved: BodyStep,
    inputs: StepInputs,
    t: Number,
    dt: Number,
) -> tuple[FlightState, Sample]:
    """The end of a step from t [s] by dt [s], once the body has moved: (`FlightState` after it, `Sample` at its start).

    The detectors come last in the state: compiled loops write them only where they changed.
    """
    before, noise = model.flight_state, inputs.noise.sensors
    readings, sensing = measure(model.sensors, before.sensing, before.state, moved.readings, output.attitude, noise)
    sample = log_sample(model, output, acting, moved, inputs)
    impulse = impulse_after(model.limits.strike, before.impulse, moved.readings.contact_force, dt)
    number = ending_number(model.limits, moved.state, impulse)
    crash, ended = with_aftermath(model.limits.aftermath, before.crash, number, moved.state, impulse, t, dt)
    metrics = count(before.metrics, contribution_of(model, output, sample, inputs.outside, t))
    after = FlightState(
        state=moved.state,
        memory=output.memory,
        wind=acting.wind.memory,
        grip=moved.grip,
        near=before.near,
        touches=moved.touches,
        sensing=sensing,
        estimator=output.estimator,
        rotors=acting.rotors,
        readings=readings,
        person=inputs.person,
        metrics=until_crash(before.crash, before.metrics, metrics),
        impulse=impulse,
        crash=crash,
        ended=where(before.ended > 0.0, before.ended, ended),
        detectors=until_crash(before.crash, before.detectors, detect(model, output, sample, t, dt)),
    )
    return after, sample


@law
def step_body(
    plant: CompiledPlant, before: FlightState, acting: Actuation, hand: PushSamples[Push], t: Number, dt: Number
) -> BodyStep:
    """The body's part of a step."""
    loads = acting.wind.loads
    moved = advance(plant, before.state, before.grip, before.near, acting.thrusts, loads, hand, dt)
    touches = touches_in(before.touches, plant, before.near, before.state, t, dt)
    return moved._replace(touches=touches)


@law
def finish_step(
    model: FlightModel, output: PilotOutput, inputs: StepInputs, t: Number, dt: Number
) -> tuple[FlightState, Sample]:
    """The rest of a step once the pilot has decided: (`FlightState` after it, `Sample` at its start)."""
    output = with_caller_thrusts(output, inputs.external)
    acting = actuate(model, output.decision.thrusts, inputs, t)
    moved = step_body(model.plant, model.flight_state, acting, inputs.hand, t, dt)
    return finish_sample(model, output, acting, moved, inputs, t, dt)


@law
def step_flight(model: FlightModel, inputs: StepInputs, t: Number, dt: Number) -> tuple[FlightState, Sample]:
    """One step of a flight from time t [s] by dt [s]: (`FlightState` after it, `Sample` at its start)."""
    inputs = with_person(model, inputs, t, dt)
    return finish_step(model, run_pilot(model, inputs, t, dt), inputs, t, dt)
