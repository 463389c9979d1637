"""The pilot's sources of state, push and walls: the truth, the measurement or the estimate.

And the parts of them that come late, or are held from sample to sample, with their places in a flight's flat array.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol, TypeAlias

from tandemlift.core.law import choice, law
from tandemlift.core.types import Number, leaves
from tandemlift.core.vector import Absent, Vec3, apply_transposed, cross
from tandemlift.parts.estimation.contact_detection import ContactEstimate
from tandemlift.parts.estimation.push_estimate import PushEstimate
from tandemlift.parts.mechanics.push import Push, push_moment
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.sensors.readings import Readings


class TruthSource(NamedTuple):
    """The pilot uses the true values."""


class MeasurementSource(NamedTuple):
    """The pilot uses the measured values."""


class EstimateSource(NamedTuple):
    """The pilot uses the estimates."""


Source: TypeAlias = TruthSource | MeasurementSource | EstimateSource


class PushWrench(NamedTuple):
    """A push: force [N, world axes] and moment about the system's centre of mass [N·m, body axes]."""

    force: Vec3
    moment: Vec3


class KnownWalls(NamedTuple):
    """The pilot has a map of the walls."""


class PilotSources(NamedTuple):
    """The source of the state that the pilot uses, and that of the push; `map`: `KnownWalls`, or `Absent`."""

    state: Source
    push: Source
    map: KnownWalls | Absent


class NominalVehicle(NamedTuple):
    """The nominal vehicle.

    The payload's centre of mass from the system's [m, body axes], and linear drag, which loads the joints like a push:
    of force on world velocity [N·s/m], of moment on body rates [N·m·s].
    """

    payload: Vec3
    drag_force: Vec3
    drag_moment: Vec3


class EstimatedFlight(Protocol):
    """Estimates, with watchdogs or without."""

    @property
    def push(self) -> PushEstimate:
        """The push."""

    @property
    def state(self) -> State:
        """The state."""

    @property
    def vehicle(self) -> NominalVehicle:
        """The nominal vehicle."""

    @property
    def contact(self) -> ContactEstimate | Absent:
        """The contact, if it is estimated."""


@choice(instead={TruthSource: "true"})
def read_state(reads: Source, true: State, readings: Readings | Absent, known: EstimatedFlight | Absent) -> State:
    """The state that the pilot uses."""


@read_state.register(MeasurementSource)
def _measured_state(
    reads: MeasurementSource, true: State, readings: Readings, known: EstimatedFlight | Absent
) -> State:
    motion = readings.motion
    return State(motion.position, motion.velocity, motion.attitude, readings.imu.rates)


@read_state.register(EstimateSource)
def _estimated_state(reads: EstimateSource, true: State, readings: Readings, known: EstimatedFlight) -> State:
    return known.state


@choice
def read_push(reads: Source, true: Push, state: State, known: EstimatedFlight | Absent) -> PushWrench:
    """The push that the pilot uses, a `PushWrench`, with the state that it uses; `true`: the true push."""


@read_push.register(TruthSource)
def _true_push(reads: TruthSource, true: Push, state: State, known: EstimatedFlight | Absent) -> PushWrench:
    return PushWrench(true.force, push_moment(true, state.attitude))


@read_push.register(MeasurementSource)
def _measured_push(reads: MeasurementSource, true: Push, state: State, known: EstimatedFlight) -> PushWrench:
    p = known.push
    return push_without_drag(known.vehicle, state, p.measured, p.measured_moment, p.trusted * p.armed)


@read_push.register(EstimateSource)
def _estimated_push(reads: EstimateSource, true: Push, state: State, known: EstimatedFlight) -> PushWrench:
    p = known.push
    return push_without_drag(known.vehicle, state, p.force, p.moment, p.trusted * p.armed)


@law
def push_without_drag(vehicle: NominalVehicle, state: State, force: Vec3, moment: Vec3, usable: Number) -> PushWrench:
    """A push on the payload, less the drag, about the system's centre of mass; zero if it is not `usable` (0).

    `force` [N, world axes]; `moment` [N·m, body axes] is about the payload's centre of mass.
    """
    push = force + vehicle.drag_force * state.velocity
    arm = cross(vehicle.payload, apply_transposed(rotation_from_quaternion(state.attitude), push))
    return PushWrench(push * usable, (moment + vehicle.drag_moment * state.rates + arm) * usable)


READS: dict[str, Source] = {"truth": TruthSource(), "measurement": MeasurementSource(), "estimate": EstimateSource()}
MAPS: dict[str, KnownWalls | Absent] = {"none": Absent(), "walls": KnownWalls()}


# ---- Delay lines: of readings on their way to the pilot, of commands to the rotors, of the view of a person


class Delayed(NamedTuple):
    """Marks a delayed signal; the number of steps is data of the loop."""


class DelayLines(NamedTuple):
    """Delays of the IMU and motion readings, of the rotor commands and of the person's view.

    Each is `Delayed` or `Absent`; those of additional sensors' readings by name.
    """

    imu: Delayed | Absent
    motion: Delayed | Absent
    command: Delayed | Absent
    view: Delayed | Absent
    additional: tuple[Delayed | Absent, ...] = Absent()


# ---- Places of a flight's parts in its flat array: of any part, of delayed ones, and of those that are held


class LeafSpan(NamedTuple):
    """A span of leaves: the first one, and their number."""

    at: int
    size: int


NONE = LeafSpan(0, 0)


class DelayedSpans(tuple[LeafSpan, ...]):
    """The delayed parts of a flight, in the order of `DelayLines`; additional sensors one by one.

    Each is a span of the flight's numbers, empty without delay. A row of the delay lines holds them one after another.
    """

    @property
    def size(self) -> int:
        """Numbers in a row."""
        return sum(span.size for span in self)


def leaf_offset(value: Any, *path: str) -> LeafSpan:
    """The span of a part of a nested value; an empty one where the path ends in `Absent`."""
    at = 0
    for name in path:
        if name not in value._fields:
            return NONE
        i = value._fields.index(name)
        at += sum(map(leaves, value[:i]))
        value = value[i]
    return LeafSpan(at, leaves(value))


def delayed_spans(model: Any) -> DelayedSpans:
    """The delayed parts of flights like this one."""
    late = model.delays
    if isinstance(late, Absent):
        return DelayedSpans()
    paths: list[tuple[str, ...]] = [
        ("readings", "imu"),
        ("readings", "motion"),
        ("rotors", "arriving"),
        ("person", "view"),
    ]
    paths += [("readings", "additional", name) for name in late.additional._fields]
    return DelayedSpans(
        NONE if isinstance(delay, Absent) else leaf_offset(model, "flight_state", *path)
        for delay, path in zip((*late[:-1], *late.additional), paths, strict=True)
    )


class HeldPart(NamedTuple):
    """Numbers of the state that change only in steps in which a sample is taken, or used.

    Attributes:
        fresh: place of the number that is not 0 after such a step.
        places: of the numbers.
        copies: places of other numbers, with those that are copied to them then.
        noise: the span of the step's random numbers that serve them; empty for estimates.
    """

    fresh: int
    places: list[int]
    copies: dict[int, int]
    noise: LeafSpan


def held_parts(model: Any, noise: Any) -> list[HeldPart]:
    """The held parts of flights: the estimates, then every device that does not sample in each step.

    A device's sample is copied to the pilot's readings, unless it is delayed or may be faulty.
    """
    found, late = list[HeldPart](), {span.at for span in delayed_spans(model) if span.size}
    flight = model.flight_state
    known = "flight_state", "estimator", *(["estimators"] if hasattr(flight.estimator, "estimators") else [])
    fresh, (at, size) = leaf_offset(model, *known, "held", "fresh"), leaf_offset(model, *known)
    if fresh.size:
        found.append(HeldPart(fresh.at, [i for i in range(at, at + size) if i != fresh.at], {}, NONE))
    is_faulty = hasattr(flight.sensing, "faults")
    devices = flight.sensing.sensing if is_faulty else flight.sensing
    names = list[tuple[str, ...]]([] if isinstance(devices, Absent) else [("joints",), ("imu",), ("motion",)])
    names += [("additional", name) for name in getattr(getattr(devices, "additional", None), "_fields", ())]
    for name in names:
        device = getattr(devices.additional if len(name) > 1 else devices, name[-1])
        if isinstance(getattr(device, "seldom", Absent()), Absent):
            continue
        path = "flight_state", "sensing", *(["sensing"] if is_faulty else []), *name
        (at, size), drift = leaf_offset(model, *path, "reading"), leaf_offset(model, *path, "drift")
        to = leaf_offset(model, "flight_state", "readings", *name)
        passed_on = 0 if is_faulty or to.at in late else max(to.size - 1, 0)
        found.append(
            HeldPart(
                fresh=at + size - 1,
                places=[*range(at, at + size - 1), *range(drift.at, drift.at + drift.size)],
                copies={to.at + i: at + i for i in range(passed_on)},
                noise=leaf_offset(noise, "sensors", *name),
            )
        )
    return found
