"""Perception: the readings of the sensors, the estimates from them, and the pilot's choice of both."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeVar

from tandemlift.core.algebra import chosen, maximum
from tandemlift.core.law import choice, law
from tandemlift.core.phases import LAND
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Quat, Vec3
from tandemlift.parts.contact.walls import NearWalls
from tandemlift.parts.estimation.contact_detection import (
    ContactEstimate,
    ContactState,
    KnownSurroundings,
    contact_step,
    explained_push,
    shaken,
)
from tandemlift.parts.estimation.contact_evidence import ContactDetector, PushReading
from tandemlift.parts.estimation.fused_push import FusedPush, FusedPushState, by_joints, untouched
from tandemlift.parts.estimation.navigation import NavigationState, Navigator
from tandemlift.parts.estimation.push_confirmation import (
    ConfirmationState,
    PushConfirmation,
    SampledPush,
    confirm,
    refuted_push,
)
from tandemlift.parts.estimation.push_estimate import PushEstimate, PushEstimator, PushEstimatorState
from tandemlift.parts.estimation.wrench_push import PushInputs, WrenchPush, WrenchPushState, push_and_state
from tandemlift.parts.guidance.admittance import AdmittanceState
from tandemlift.parts.guidance.contact_hold import contact_of
from tandemlift.parts.guidance.guidance import TimeSpan, is_within
from tandemlift.parts.guidance.hand_guidance import HandGuidanceState
from tandemlift.parts.guidance.phases import in_the_air, is_in
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.off_center import about_center
from tandemlift.parts.sensors.readings import Readings, SensorNoise, Sensors, sense
from tandemlift.simulation.loop.sources import EstimatedFlight, KnownWalls, NominalVehicle, PilotSources

M = TypeVar("M")
NO_SURROUNDINGS = KnownSurroundings(Absent(), 0.0, 0.0, 0.0)


class PerceptionData(NamedTuple):
    """The readings, and the estimates from them."""

    readings: Readings
    known: EstimatedFlight


class Sampling(NamedTuple):
    """The estimators step with the IMU's samples, so many seconds apart, and not with the pilot."""

    interval: Number


class Estimators(NamedTuple):
    """The estimators of push and state, the nominal vehicle, the start of the tare, and the checks of the push.

    The checks are the detector of contacts, and the confirmation by other loads on the vehicle. `sampling` is `Absent`
    where the IMU samples at every step. `hover`: times between lift and landing if they are scheduled over a floor.
    """

    push: PushEstimator | WrenchPush | FusedPush
    state: Navigator
    vehicle: NominalVehicle
    tare: TareAtTime | TareInHover
    contact: ContactDetector | Absent
    confirmation: PushConfirmation | Absent
    sampling: Sampling | Absent
    hover: TimeSpan | Absent


class TareAtTime(NamedTuple):
    """The tare begins at a set time."""


class TareInHover(NamedTuple):
    """The tare begins in steady hover."""


class HeldEstimates(NamedTuple):
    """The last estimates of push, state and contact; `fresh` is 1 in a step in which a sample changed one, else 0."""

    push: PushEstimate
    state: State
    contact: ContactEstimate | Absent
    fresh: Number


class EstimatorState(NamedTuple):
    """Memory of the estimators; `held` is `Absent` where they run in every step."""

    push: PushEstimatorState | WrenchPushState | FusedPushState
    state: NavigationState
    contact: ContactState | Absent
    confirmation: ConfirmationState | Absent
    held: HeldEstimates | Absent = Absent()


class Estimates(NamedTuple):
    """The estimates of push and state, the nominal vehicle, and the contact; `Absent` if it is not estimated."""

    push: PushEstimate
    state: State
    vehicle: NominalVehicle
    contact: ContactEstimate | Absent


@choice(absent=("sensors", "memory"))
def measure(
    sensors: object, memory: M, state: State, perfect: PerfectReadings, believed: Quat, noise: SensorNoise | Absent
) -> tuple[Readings | Absent, M]:
    """(Readings of a step, the sensors' memory)."""


measure.register(Sensors)(sense)


@law(instead={TareAtTime: "t"})
def tare_begun(tare: TareInHover, guidance: HandGuidanceState, t: Number) -> Number:
    """The time [s] on the clock of the tare; `guidance`: its memory."""
    return guidance.phase.hover_time


@law(absent="t")
def tare_time(estimators: Estimators, guidance: AdmittanceState | HandGuidanceState, t: Number) -> Number:
    """The time [s] by which the estimators tare."""
    return tare_begun(estimators.tare, guidance, t)


@choice(absent=("estimators", "memory"))
def estimate_all(
    estimators: object,
    memory: M,
    readings: Readings | Absent,
    surroundings: KnownSurroundings,
    commands: PerRotor | Absent,
    t: Number,
    dt: Number,
) -> tuple[EstimatedFlight | Absent, M]:
    """(the estimates from readings, the estimators' memory) at time t [s].

    `surroundings`: known obstacles; `commands`: the last thrusts of all rotors [N].
    """


@law(absent="dt")
def time_between(sampling: Sampling, dt: Number) -> Number:
    """The time from one step of the estimators to the next [s]; `dt`: of the pilot."""
    return sampling.interval


@law(absent=("new", "after"))
def held_between(
    sampling: Sampling, memory: EstimatorState, readings: Readings, new: Estimates, after: EstimatorState
) -> tuple[Estimates, EstimatorState]:
    """(estimates, memory) in a step with these readings: the new ones of what they serve, else the last.

    State estimation steps with samples of IMU and motion measurement, all else with those of the IMU.
    """
    last: Any = memory.held  # never `Absent`: this is called where estimates are held
    by_imu = readings.imu.fresh
    by_any = maximum(by_imu, readings.motion.fresh)
    held = HeldEstimates(
        push=chosen(by_imu, new.push, last.push),
        state=chosen(by_any, new.state, last.state),
        contact=chosen(by_imu, new.contact, last.contact),
        fresh=by_any,
    )
    return new._replace(push=held.push, state=held.state, contact=held.contact), EstimatorState(
        push=chosen(by_imu, after.push, memory.push),
        state=chosen(by_any, after.state, memory.state),
        contact=chosen(by_imu, after.contact, memory.contact),
        confirmation=chosen(by_imu, after.confirmation, memory.confirmation),
        held=held,
    )


@estimate_all.register(Estimators)
def _estimated(
    estimators: Estimators,
    memory: EstimatorState,
    readings: Readings,
    surroundings: KnownSurroundings,
    commands: PerRotor | Absent,
    t: Number,
    dt: Number,
) -> tuple[Estimates, EstimatorState]:
    dt = time_between(estimators.sampling, dt)
    aloft = surroundings.aloft * is_within(estimators.hover, t)  # of a schedule, whose tare has no other clock
    inputs = PushInputs(readings, commands, untouched(estimators.push, aloft, memory.contact), t, dt)
    push, pushed, state, moved = push_and_state(estimators.push, memory.push, estimators.state, memory.state, inputs)
    used = by_joints(estimators.push)
    imu = about_center(used.off_center, readings.imu, pushed.angular)
    seen = PushReading(imu, pushed.angular, push)
    contact, contact_memory = contact_step(estimators.contact, memory.contact, used, seen, state, surroundings, dt)
    sampled, explained = SampledPush(imu, used, pushed), shaken(contact_memory)
    push, confirmation = confirm(
        estimators.confirmation,
        memory.confirmation,
        explained_push(contact_memory, push),
        sampled,
        commands,
        explained,
        dt,
    )
    estimates = Estimates(push, state, estimators.vehicle, contact)
    after = EstimatorState(pushed, moved, contact_memory, confirmation)
    return held_between(estimators.sampling, memory, readings, estimates, after)


@choice(absent=NO_SURROUNDINGS)
def surroundings_of(
    estimators: object,
    sources: PilotSources,
    near: NearWalls | Absent,
    guidance: AdmittanceState | HandGuidanceState,
) -> KnownSurroundings:
    """The estimators' knowledge of obstacles; `near`: the walls near the vehicle, `guidance`: its memory."""


@law(absent=Absent())
def walls_known(known: KnownWalls, near: NearWalls) -> NearWalls:
    """The walls near the vehicle, if the pilot has a map."""
    return near


@law(absent=NO_SURROUNDINGS)
def known_surroundings(
    contact: ContactDetector, sources: PilotSources, near: NearWalls | Absent, guidance: HandGuidanceState
) -> KnownSurroundings:
    """The same, for the detector of contacts that the estimators have."""
    m = guidance.phase
    return KnownSurroundings(walls_known(sources.map, near), in_the_air(m), is_in(m, LAND), m.ground)


@law(instead={AdmittanceState: 1.0})
def aloft(guidance: HandGuidanceState) -> Number:
    """1 in flight, except in lift and landing, else 0; 1 where guidance is scheduled: see `Estimators.hover`."""
    return in_the_air(guidance.phase)


@surroundings_of.register(Estimators)
def _surroundings(
    estimators: Estimators,
    sources: PilotSources,
    near: NearWalls | Absent,
    guidance: AdmittanceState | HandGuidanceState,
) -> KnownSurroundings:
    return known_surroundings(estimators.contact, sources, near, guidance)._replace(aloft=aloft(guidance))


@law(absent="readings")
def usable(known: Estimates, readings: Readings) -> Readings:
    """The readings that may be used."""
    return readings


@refuted_push.register(Estimates)
def _refuted(known: Estimates) -> Vec3:
    return known.push.withheld * known.push.refuted


@contact_of.register(PerceptionData)
def _contact(what: PerceptionData) -> ContactEstimate | Absent:
    return what.known.contact


@law(absent="readings")
def all_sensed(readings: Readings, known: EstimatedFlight) -> PerceptionData:
    """`PerceptionData`, or `Absent` without sensors."""
    return PerceptionData(readings, known)
