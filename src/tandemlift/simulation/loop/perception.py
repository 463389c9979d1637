"""Perception: the readings of the sensors, the estimates from them, and which of both the pilot uses."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra.law import choice, law
from tandemlift.core.algebra.vector import Nothing, Quat, Vec3, apply_transposed, cross
from tandemlift.core.phases import LAND
from tandemlift.parts.estimation.contact_detection import Around, contact_step, explained_push, shaken
from tandemlift.parts.estimation.contact_evidence import ContactDetector, PushReading
from tandemlift.parts.estimation.navigation import Navigator, navigate
from tandemlift.parts.estimation.push_confirmation import SampledPush, confirm, refuted_push
from tandemlift.parts.estimation.push_estimate import PushEstimate, PushEstimator, estimate
from tandemlift.parts.guidance.contact_hold import contact_of
from tandemlift.parts.guidance.phases import in_the_air, is_in
from tandemlift.parts.mechanics.push import push_moment
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.sensors.readings import Readings, Sensors, sense

NOTHING_AROUND = Around(Nothing(), 0.0, 0.0, 0.0)


class TruthSource(NamedTuple):
    """The pilot uses the true values."""


class MeasurementSource(NamedTuple):
    """The pilot uses the measured values."""


class EstimateSource(NamedTuple):
    """The pilot uses the estimates."""


class PushWrench(NamedTuple):
    """A push: force [N, world axes] and moment about the system's centre of mass [N·m, body axes]."""

    force: Vec3
    moment: Vec3


class PerceptionData(NamedTuple):
    """The readings, and the estimates from them."""

    readings: Any
    known: Any


class KnownWalls(NamedTuple):
    """The pilot knows the walls."""


class PilotSources(NamedTuple):
    """The source of the state that the pilot uses, and that of the push; `map`: `KnownWalls`, or `Nothing`."""

    state: Any
    push: Any
    map: Any


class NominalVehicle(NamedTuple):
    """The nominal vehicle.

    The payload's centre of mass from the system's [m, body axes], and linear drag, which loads the joints like a push:
    of force on world velocity [N·s/m], of moment on body rates [N·m·s].
    """

    payload: Vec3
    drag_force: Vec3
    drag_moment: Vec3


class Estimators(NamedTuple):
    """The estimators of push and state, the nominal vehicle, when the tare begins, and what checks the push.

    That is the detector of contacts, and the confirmation by what else acts on the vehicle.
    """

    push: PushEstimator
    state: Navigator
    vehicle: NominalVehicle
    tare: Any
    contact: Any
    confirmation: Any


class TareAtTime(NamedTuple):
    """The tare begins at a set time."""


class TareInHover(NamedTuple):
    """The tare begins in steady hover."""


class EstimatorState(NamedTuple):
    """Memory of the estimators."""

    push: Any
    state: Any
    contact: Any
    confirmation: Any


class Estimates(NamedTuple):
    """The estimates of push and state, the nominal vehicle, and the contact; `Nothing` if it is not estimated."""

    push: PushEstimate
    state: State
    vehicle: NominalVehicle
    contact: Any


@choice(absent=("sensors", "memory"))
def measure(sensors: Any, memory: Any, state: State, perfect: Any, believed: Quat, noise: Any) -> Any:
    """(Readings of a step, the sensors' memory)."""


@measure.register(Sensors)
def _sensed(sensors: Sensors, memory: Any, state: State, perfect: Any, believed: Quat, noise: Any) -> Any:
    return sense(sensors, memory, state, perfect, believed, noise)


@choice
def tare_begun(tare: Any, guidance: Any, t: Any) -> Any:
    """The time [s] on the clock of the tare; `guidance`: its memory."""


@tare_begun.register(TareAtTime)
def _by_clock(tare: TareAtTime, guidance: Any, t: Any) -> Any:
    return t


@tare_begun.register(TareInHover)
def _in_hover(tare: TareInHover, guidance: Any, t: Any) -> Any:
    return guidance.phase.hover_time


@choice(absent="t")
def tare_time(estimators: Any, guidance: Any, t: Any) -> Any:
    """The time [s] by which the estimators tare."""


@tare_time.register(Estimators)
def _tare(estimators: Estimators, guidance: Any, t: Any) -> Any:
    return tare_begun(estimators.tare, guidance, t)


@choice(absent=("estimators", "memory"))
def estimate_all(estimators: Any, memory: Any, readings: Any, around: Around, commands: Any, t: Any, dt: Any) -> Any:
    """(the estimates from readings, the estimators' memory) at time t [s].

    `around`: what is known of obstacles; `commands`: the last thrusts of all rotors [N].
    """


@estimate_all.register(Estimators)
def _estimated(
    estimators: Estimators, memory: Any, readings: Any, around: Around, commands: Any, t: Any, dt: Any
) -> Any:
    push, push_memory = estimate(estimators.push, memory.push, readings.imu, t)
    state, state_memory = navigate(estimators.state, memory.state, readings)
    seen = PushReading(readings.imu, push_memory.angular, push)
    contact, contact_memory = contact_step(estimators.contact, memory.contact, estimators.push, seen, state, around, dt)
    sampled, explained = SampledPush(readings.imu, estimators.push, push_memory), shaken(contact_memory)
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
    return estimates, EstimatorState(push_memory, state_memory, contact_memory, confirmation)


@choice(absent=NOTHING_AROUND)
def surroundings_of(estimators: Any, sources: PilotSources, near: Any, guidance: Any) -> Any:
    """What the estimators know of obstacles; `near`: the walls near the vehicle, `guidance`: its memory."""


@choice(absent=Nothing())
def walls_known(known: Any, near: Any) -> Any:
    """The walls near the vehicle, if the pilot knows them."""


@walls_known.register(KnownWalls)
def _known(known: KnownWalls, near: Any) -> Any:
    return near


@choice(absent=NOTHING_AROUND)
def known_around(contact: Any, sources: PilotSources, near: Any, guidance: Any) -> Any:
    """The same, for the detector of contacts that the estimators have."""


@known_around.register(ContactDetector)
def _around(contact: ContactDetector, sources: PilotSources, near: Any, guidance: Any) -> Around:
    m = guidance.phase
    return Around(walls_known(sources.map, near), in_the_air(m), is_in(m, LAND), m.ground)


@surroundings_of.register(Estimators)
def _surroundings(estimators: Estimators, sources: PilotSources, near: Any, guidance: Any) -> Any:
    return known_around(estimators.contact, sources, near, guidance)


@choice(absent="readings")
def usable(known: Any, readings: Any) -> Any:
    """The readings that may be used."""


@usable.register(Estimates)
def _as_given(known: Estimates, readings: Any) -> Any:
    return readings


@choice
def read_state(reads: Any, true: State, readings: Any, known: Any) -> Any:
    """The state that the pilot uses."""


@read_state.register(TruthSource)
def _true_state(reads: TruthSource, true: State, readings: Any, known: Any) -> Any:
    return true


@read_state.register(MeasurementSource)
def _measured_state(reads: MeasurementSource, true: State, readings: Any, known: Any) -> Any:
    motion = readings.motion
    return State(motion.position, motion.velocity, motion.attitude, readings.imu.rates)


@read_state.register(EstimateSource)
def _estimated_state(reads: EstimateSource, true: State, readings: Any, known: Any) -> Any:
    return known.state


@choice
def read_push(reads: Any, true: Any, state: State, known: Any) -> Any:
    """The push that the pilot uses, a `PushWrench`, with the state that it uses; `true`: the true push."""


@read_push.register(TruthSource)
def _true_push(reads: TruthSource, true: Any, state: State, known: Any) -> Any:
    return PushWrench(true.force, push_moment(true, state.attitude))


@read_push.register(MeasurementSource)
def _measured_push(reads: MeasurementSource, true: Any, state: State, known: Any) -> Any:
    p = known.push
    return push_without_drag(known.vehicle, state, p.measured, p.measured_moment, p.trusted * p.armed)


@read_push.register(EstimateSource)
def _estimated_push(reads: EstimateSource, true: Any, state: State, known: Any) -> Any:
    p = known.push
    return push_without_drag(known.vehicle, state, p.force, p.moment, p.trusted * p.armed)


@law
def push_without_drag(vehicle: NominalVehicle, state: State, force: Vec3, moment: Vec3, usable: Any) -> PushWrench:
    """A push on the payload, less the drag, about the system's centre of mass; zero if it is not `usable` (0).

    `force` [N, world axes]; `moment` [N·m, body axes] is about the payload's centre of mass.
    """
    push = force + vehicle.drag_force * state.velocity
    arm = cross(vehicle.payload, apply_transposed(rotation_from_quaternion(state.attitude), push))
    return PushWrench(push * usable, (moment + vehicle.drag_moment * state.rates + arm) * usable)


@refuted_push.register(Estimates)
def _refuted(known: Estimates) -> Vec3:
    return known.push.withheld * known.push.refuted


@contact_of.register(PerceptionData)
def _contact(what: PerceptionData) -> Any:
    return what.known.contact


@choice(absent="readings")
def all_sensed(readings: Any, known: Any) -> Any:
    """`PerceptionData`, or `Nothing` without sensors."""


@all_sensed.register(Readings)
def _some_sensed(readings: Readings, known: Any) -> Any:
    return PerceptionData(readings, known)


READS = {"truth": TruthSource(), "measurement": MeasurementSource(), "estimate": EstimateSource()}
MAPS = {"none": Nothing(), "walls": KnownWalls()}
