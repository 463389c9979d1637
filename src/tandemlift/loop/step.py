"""The closed loop, the only place where the pilot and a body meet: what one step is, and what it shows.

At time t_k the pilot reads the state and the person's push, or what sensors and estimators make of them, and decides;
the rotors answer; the body then moves for one step with their thrusts held and the push continuous. What sensors read
during a step is known to the pilot at the next one, or later. What a mission does not have is `Nothing`, and costs
nothing.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import absolute, maximum, where
from tandemlift.algebra.vector import Nothing, Quat, dot
from tandemlift.engines.compiled import BodyStep, advance
from tandemlift.engines.compiled_contact import CompiledPlant
from tandemlift.laws.guidance.requests import UNAWARE, operator_of
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.push import Push, PushSamples
from tandemlift.laws.mechanics.rotation import sine_of_roll
from tandemlift.laws.person.caller_inputs import pushed, thrusts_of
from tandemlift.laws.person.person import asks_to_land, person_step
from tandemlift.laws.rotors.rotors import rotors_step
from tandemlift.loop.log_sample import errors_of, log_sample
from tandemlift.loop.perception import all_sensed, estimate_all, measure, read_push, read_state, tare_time, usable
from tandemlift.loop.running_metrics import RunningMetrics, count
from tandemlift.loop.wind_loads import wind_loads
from tandemlift.pilot.pilot import Decision, PilotInput, PilotMemory, PilotParameters, decide, with_thrusts

SIN_ROLL_LIMIT = 0.9998476951563913  # sin 89°
FAR = 1000.0  # m


class FlightState(NamedTuple):
    """What changes from step to step; `lost` becomes 1 when the state is no longer sound."""

    state: State
    memory: PilotMemory
    wind: Any
    grip: Any
    near: Any
    sensing: Any
    estimator: Any
    rotors: Any
    readings: Any
    partner: Any
    tally: RunningMetrics
    lost: Any


class FlightModel(NamedTuple):
    """One flight: what changes, and the numbers that do not. Its type is the compiled loop's variant."""

    moving: FlightState
    pilot: PilotParameters
    plant: CompiledPlant
    rotors: Any
    weather: Any
    sensors: Any
    estimator: Any
    reads: Any
    partner: Any
    delays: Any


class StepNoise(NamedTuple):
    """Standard normals of one step: of the wind, of the sensors, of the person."""

    wind: Any
    sensors: Any
    partner: Any


class StepInputs(NamedTuple):
    """What a step is given from outside: the push, gusts [m/s], standard normals; a person's memory, once they push.

    `external` is what a caller adds who steps the flight by hand, else `Nothing`.
    """

    hand: PushSamples
    gust: Any
    noise: Any
    partner: Any
    external: Any = Nothing()


class PilotOutput(NamedTuple):
    """The pilot's part of a step: what is estimated, the attitude believed in, the decision, what is remembered."""

    known: Any
    believed: Quat
    decision: Decision
    memory: PilotMemory
    estimator: Any


class Actuation(NamedTuple):
    """What acts on the body over a step: rotor thrusts [N] and moving air; and what rotors and wind remember."""

    thrusts: Any
    rotors: Any
    weather: Any


@law
def with_person(flying: FlightModel, given: StepInputs, t: Any, dt: Any) -> StepInputs:
    """What a step is given, with the push of its caller and of the person who guides the vehicle."""
    before, noise = flying.moving, given.noise.partner
    lent = person_step(flying.partner, before.partner, pushed(given.external, given.hand), before.state, noise, t, dt)
    return StepInputs(lent.hand, given.gust, given.noise, lent.memory, given.external)


@law
def perceive(flying: FlightModel, push: Push, t: Any, dt: Any) -> Any:
    """(what is estimated, what the pilot hears, the estimators' memory) at time t [s]; `push`: the true one."""
    before, reads = flying.moving, flying.reads
    since = tare_time(flying.estimator, before.memory.guidance, t)
    known, memory = estimate_all(flying.estimator, before.estimator, before.readings, since, dt)
    readings = usable(known, before.readings)
    state = read_state(reads.state, before.state, readings, known)
    touch = read_push(reads.push, push, state, known)
    land, sees = asks_to_land(before.partner), all_sensed(readings, known)
    asked = operator_of(before.partner)
    return known, PilotInput(state, touch.force, touch.moment, land, sees, asked, UNAWARE), memory


@law
def run_pilot(flying: FlightModel, push: Push, t: Any, dt: Any) -> PilotOutput:
    """The pilot's part of a step."""
    known, heard, estimator = perceive(flying, push, t, dt)
    decision, memory = decide(flying.pilot, flying.moving.memory, heard, t, dt)
    return PilotOutput(known, heard.state.attitude, decision, memory, estimator)


@law
def with_caller_thrusts(thought: PilotOutput, external: Any) -> PilotOutput:
    """The pilot's part of a step, with the thrusts that its caller gives in place of the pilot's."""
    decision = with_thrusts(thought.decision, thrusts_of(external, thought.decision.thrusts))
    return PilotOutput(thought.known, thought.believed, decision, thought.memory, thought.estimator)


@law
def actuate(flying: FlightModel, thrusts: Any, given: StepInputs, t: Any) -> Actuation:
    """What the rotors make of commanded thrusts [N] over the step from time t [s], and the wind over it."""
    before = flying.moving
    driven, rotors = rotors_step(flying.rotors, before.rotors, thrusts, before.state, t)
    blowing = wind_loads(flying.weather, before.wind, flying.plant.frame, before.state, given.gust, given.noise.wind)
    return Actuation(driven, rotors, blowing)


@law
def is_unsound(state: State) -> Any:
    """0 while the state is finite, within 89° of roll and 1 km of the origin, else 1."""
    far = where(dot(state.position, state.position) < FAR * FAR, 0.0, 1.0)
    return where(absolute(sine_of_roll(state.attitude)) < SIN_ROLL_LIMIT, far, 1.0)


@law
def finish_sample(
    flying: FlightModel, thought: PilotOutput, acting: Actuation, moved: BodyStep, given: StepInputs
) -> Any:
    """What a step comes to once the body has moved: (Moving after it, the Sample at its start)."""
    before, believed = flying.moving, thought.believed
    readings, sensing = measure(
        flying.sensors, before.sensing, before.state, moved.readings, believed, given.noise.sensors
    )
    sample = log_sample(flying, thought, acting, moved, given.hand)
    tally = count(before.tally, errors_of(flying, thought, sample))
    lost = maximum(before.lost, is_unsound(moved.state))
    after = FlightState(
        moved.state,
        thought.memory,
        acting.weather.memory,
        moved.grip,
        before.near,
        sensing,
        thought.estimator,
        acting.rotors,
        readings,
        given.partner,
        tally,
        lost,
    )
    return after, sample


@law
def step_body(plant: CompiledPlant, before: FlightState, acting: Actuation, hand: PushSamples, dt: Any) -> BodyStep:
    """The body's part of a step."""
    air = acting.weather.loads
    return advance(plant, before.state, before.grip, before.near, acting.thrusts, air, hand, dt)


@law
def finish_step(flying: FlightModel, thought: PilotOutput, given: StepInputs, t: Any, dt: Any) -> Any:
    """The rest of a step once the pilot has decided: (Moving after it, the Sample at its start)."""
    thought = with_caller_thrusts(thought, given.external)
    acting = actuate(flying, thought.decision.thrusts, given, t)
    return finish_sample(flying, thought, acting, step_body(flying.plant, flying.moving, acting, given.hand, dt), given)


@law
def step_flight(flying: FlightModel, given: StepInputs, t: Any, dt: Any) -> Any:
    """One step of a flight from time t [s] by dt [s]: (Moving after it, the Sample at its start)."""
    given = with_person(flying, given, t, dt)
    return finish_step(flying, run_pilot(flying, given.hand.start, t, dt), given, t, dt)
