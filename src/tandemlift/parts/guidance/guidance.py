"""Guidance, from the pilot's input to the reference: input, output, and the common signature of the laws.

The paper's scheduled guidance is in `scheduled_guidance`, interactive guidance with phases in `hand_guidance`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple, TypeVar

from tandemlift.core.algebra import where
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import Table, key
from tandemlift.core.law import Absent, choice, law
from tandemlift.core.trajectories import PhasesTable, Reference, Trajectory
from tandemlift.core.types import NEVER, Number, PerRotor
from tandemlift.core.vector import Vec3
from tandemlift.parts.guidance.compliance import AssumedPayload
from tandemlift.parts.guidance.disturbance_observer import DisturbanceEstimate
from tandemlift.parts.guidance.requests import (
    NO_REQUEST,
    UNKNOWN_STATUS,
    OperatorRequest,
    ReferenceVelocity,
    VehicleStatus,
)
from tandemlift.parts.mechanics.rigid_body import State

M = TypeVar("M")
Reading = Literal["truth", "measurement", "estimate"]


class PilotTable(Table):
    """`[pilot]`: the guidance of the vehicle, and the inputs of the pilot."""

    guidance: Literal["scheduled", "interactive"] = key(
        "scheduled",
        None,
        "guidance of the vehicle",
        choices={
            "scheduled": "lift and landing at set times, and the admittance between them",
            "interactive": "phases and requests, and `[compliance]` around the admittance",
        },
    )
    state: Reading = key(
        "truth",
        None,
        "source of position, velocity, attitude and rates",
        rule='"truth" without sensors',
        choices={
            "truth": "the simulation",
            "measurement": "the last samples of motion measurement and gyroscope",
            "estimate": "an estimator that also uses the accelerometer",
        },
    )
    push: Reading = key(
        "truth",
        None,
        "source of the person's force",
        rule='"truth" without sensors',
        choices={
            "truth": "the simulation",
            "measurement": "the last sample of the joints' force sensors",
            "estimate": "that sample after a low-pass filter, zero before the tare ends and while the joints disagree",
        },
    )
    map: Literal["none", "walls"] = key(
        "none",
        None,
        "map of the surroundings that the pilot uses",
        choices={
            "none": "nothing",
            "walls": 'the walls, which distinguish a contact from a push more reliably (with `contact.model = "on"`)',
        },
    )


class PilotInput(NamedTuple):
    """The pilot's input at a sample.

    The state; the person's push: force [N, world axes] and moment about the centre of mass [N·m, body axes]; 1 if the
    person requests a landing, else 0; readings and estimates, or `Absent`; the operator's requests; the status of the
    vehicle; a velocity of the reference from a caller, or `Absent`.
    """

    state: State
    push: Vec3
    moment: Vec3
    land: Number
    sensed: object
    operator: OperatorRequest = NO_REQUEST
    status: VehicleStatus = UNKNOWN_STATUS
    lead: ReferenceVelocity | Absent = Absent()


class LoadOfWall(NamedTuple):
    """The estimated force of a wall on a guard [N, world axes], its moment about the centre of mass [N·m, body axes].

    `touching`: 1 while any part touches, else 0.
    """

    force: Vec3
    moment: Vec3
    touching: Number


class TimeSpan(NamedTuple):
    """From `start` until before `stop` [s]."""

    start: Number
    stop: Number


class ThrustFraction(NamedTuple):
    """The fraction of every thrust that is commanded: 1 while the rotors run, else 0."""

    value: Number


class Guidance(NamedTuple):
    """The output of a guidance.

    The gated force [N, world axes]; T_r with its derivatives; the reference; the push that the controller compensates:
    force [N, world axes] and moment [N·m, body axes]; the fraction of the thrusts that is commanded; 1 in flight, else
    0; 1 while observers may learn, else 0, as where the feet may press on the ground; the channels. `wall`: load of a
    wall, a `LoadOfWall`, or `Absent`. `inertial`: force [N] of an identified mass beyond the assumed one, or `Absent`.
    """

    force: Vec3
    admittance: Trajectory
    reference: Reference
    push: Vec3
    moment: Vec3
    running: ThrustFraction | Absent
    flying: Number
    learning: Number
    channels: object
    wall: LoadOfWall | Absent = Absent()
    inertial: Vec3 | Absent = Absent()


@choice(absent="nominal")
def identified_payload(sensed: object, nominal: Number) -> Number:
    """The mass of the payload [kg] that the tare identified; `nominal` before it, and where none is estimated."""


@law(absent=Absent())
def inertial_force(assumed: AssumedPayload, sensed: object, acceleration: Vec3) -> Vec3:
    """−(m̂ − m_L) a [N]: what a payload of another mass m̂ than assumed resists an acceleration a [m/s²] with."""
    return acceleration * (assumed.mass - identified_payload(sensed, assumed.mass))


@law(absent="push")
def with_force(force: Vec3, push: Vec3) -> Vec3:
    """A push [N] with a further force."""
    return push + force


@choice
def guide(
    g: object,
    m: M,
    pilot_input: PilotInput,
    disturbance: DisturbanceEstimate,
    rotor_failed: Number,
    t: Number,
    dt: Number,
) -> tuple[Guidance, M]:
    """(`Guidance`, the new memory) at time t [s].

    Args:
        g: the guidance, whose type picks the law.
        m: its memory.
        pilot_input: a `PilotInput` that `checked_input` has checked.
        disturbance: a `DisturbanceEstimate`.
        rotor_failed: 1 once a rotor has failed, else 0.
        t: time [s].
        dt: since the last sample [s].
    """


@choice
def checked_input(g: object, m: object, pilot_input: PilotInput, thrust: Number, rotor_failed: Number) -> PilotInput:
    """The pilot's input, made usable; with the thrust of all rotors [N], and 1 once a rotor has failed, else 0."""


@law(absent="pilot_input")
def with_wall(wall: LoadOfWall, pilot_input: PilotInput) -> PilotInput:
    """The pilot's input with the load of a wall added to the push, so that it is no disturbance."""
    return pilot_input._replace(push=pilot_input.push + wall.force, moment=pilot_input.moment + wall.moment)


@law(absent=1.0)
def untouched(wall: LoadOfWall) -> Number:
    """1 while no wall acts, else 0."""
    return 1.0 - wall.touching


@law(absent="thrusts")
def running(rotors: ThrustFraction, thrusts: PerRotor) -> PerRotor:
    """Thrusts [N] as commanded while the rotors run, or none while they are stopped."""
    return thrusts * rotors.value


@law(absent=1.0)
def thrust_fraction(rotors: ThrustFraction) -> Number:
    """The fraction of every thrust that is commanded."""
    return rotors.value


@law(absent=1.0)
def is_within(span: TimeSpan, t: Number) -> Number:
    """1 at a time t [s] within a span, else 0."""
    return where(t < span.start, 0.0, where(t < span.stop, 1.0, 0.0))


@law(absent="rotors")
def run(rotors: TimeSpan, t: Number) -> ThrustFraction:
    """`Absent` or a `ThrustFraction`, for `running`: whether rotors run at time t [s]."""
    return ThrustFraction(is_within(rotors, t))


def flight_spans(p: PhasesTable, ground: str) -> tuple[TimeSpan, TimeSpan] | tuple[Absent, Absent]:
    """The scheduled flight over a floor, with and without lift and landing; `ground`: `ground.model`."""
    if ground == "none":
        return Absent(), Absent()
    land = NEVER if p.land_start is None else p.land_start
    return TimeSpan(p.lift_start, land + p.land_duration), TimeSpan(p.lift_start + p.lift_duration, land)


def reading_checks(pilot: PilotTable, sensors: str) -> Iterator[CheckResult]:
    """Check for a pilot that reads sensors that a mission does not have; `sensors`: `sensors.model`."""
    for name, reading in (("state", pilot.state), ("push", pilot.push)):
        if sensors != "simulated" and reading != "truth":
            yield refused(
                f'pilot.{name} = "{reading}": must be "truth" without sensors, or sensors.model must be "simulated"'
            )
