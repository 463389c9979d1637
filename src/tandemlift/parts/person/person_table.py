"""The table of a person who guides the vehicle by hand: path, model, strength and delay."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field

from tandemlift.core.algebra import where
from tandemlift.core.errors import CheckResult, refused, warned
from tandemlift.core.keys import Delay, NonNegative, Positive, Share, Table, key
from tandemlift.core.low_pass import LowPassState, low_pass
from tandemlift.core.part import Part
from tandemlift.core.trajectories import PhasesTable
from tandemlift.core.types import Number, filled, number
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3
from tandemlift.parts.contact.corridor import CorridorTable, Point2
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.mechanics.rigid_body import InitialTable, State
from tandemlift.parts.mechanics.rotation import heading_from
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.person.person import (
    Arm,
    PathFollowing,
    PathLeg,
    Person,
    PersonSettings,
    PersonState,
    guided_point,
    person_view,
)
from tandemlift.parts.person.tremor import NO_TREMOR_NOISE, STILL, tremor
from tandemlift.parts.person.virtual_hand import HAND_RELEASED, VirtualHand, VirtualHandState


class WaypointTable(Table, keys_act={"heading": 'person.model = "two-hands"'}):
    """`[[person.path]]`: waypoints, one table each, joined by straight lines."""

    point: Point2 = key(
        ..., "m", "x and y, of the grip for 'pull' and 'hold', otherwise of the centre of mass", example=[5.0, 0.0]
    )
    rise: float = key(0.0, "m", "height above the height of flight")
    heading: float | None = key(
        None,
        "rad",
        "heading of the vehicle on the path there; only model 'two-hands' rotates it",
        unset="the heading is kept",
        example=0.0,
    )
    dwell: NonNegative = key(0.0, "s", "time for which the person keeps the vehicle there")


class PersonTable(
    Table,
    acts='person.model = "pull" or "steer" or "two-hands" or "hold"',
    keys_act={
        "yaw_gain yaw_damping max_couple": 'person.model = "two-hands"',
        "grip": 'person.model = "pull" or "steer" or "hold"',
    },
):
    """`[person]`: a person in the loop, who sees the vehicle with a delay and leads it by hand along a path.

    The person's view is delayed by `delay`. The person predicts the vehicle's present place from it. The desired force
    is `gain` times the missing speed towards the point of the path that lies `look_ahead` farther on. The hand moves
    to the place where the arm's `stiffness` gives this force, through the muscles' `lag`; stiffness and damping act
    between hand and grip without delay. The person begins after `start_time`, once the vehicle has been lifted. At the
    last waypoint, when the vehicle is slow, the person requests a landing (interactive guidance obeys) and lets go.

    Model "virtual-hand" is a hand that is moved from outside. It holds on to a point of the vehicle by a spring of
    `stiffness` to a target, smoothed by twice `lag`, brakes that point by `damping`, or pushes with a given force,
    always within `max_force`; the other keys do not apply. Its movement is the file `recording`, a NumPy archive (.npz)
    with `engine` (the engine that was flown in, the default of `tandemlift run`), `step` (n,) int64, rising, and `hand`
    (n, 14) float64, which holds from that step on: holding on (1 or 0); grip [m, body axes, from the centre of mass];
    its target [m] and a force [N], world axes; requests to lift, to land and to stop; whether the vehicle may respond
    to a push.
    """

    model: Literal["none", "pull", "steer", "two-hands", "hold", "virtual-hand"] = key(
        "none",
        None,
        "model of the person, and the point that is led along the path",
        rule='"pull" to "hold" need [[person.path]] or a corridor',
        choices={
            "none": "no person",
            "pull": "one hand leads the grip, and the vehicle follows like a trailer",
            "steer": "one hand at the grip leads the centre of mass",
            "two-hands": "two hands lead the payload's centre and rotate the vehicle to each leg's heading",
            "hold": "the hand moves to the waypoints and stays there, whatever it sees: for tests of passivity",
            "virtual-hand": "a hand that is moved from outside, as by the live page or a recording",
        },
    )
    grip: float = key(
        0.0,
        "m",
        "place where one hand holds the payload, along body y from the payload's centre",
        rule="on the payload",
    )
    stiffness: Positive = key(10.0, "N/m", "stiffness of the arm between hand and grip", source="chosen: a light hold")
    damping: NonNegative = key(1.0, "N s/m", "damping of the arm between hand and grip", source="chosen: a light hold")
    lag: Annotated[float, Field(gt=0.0, le=1.0)] = key(
        0.1, "s", "lag of the muscles: two equal time constants of this size", source="chosen"
    )
    delay: Delay = key(
        0.2,
        "s",
        "delay from the view to the action, rounded to whole steps, at least one",
        rule="at most 10,000 steps",
        source="chosen: about a visual reaction time",
    )
    tremor: NonNegative = key(
        0.05,
        "N",
        "standard deviation of the hand's tremor along each axis, nine tenths of it between 8 Hz and 12 Hz",
        source="band: Elble and Randall, 1978; size chosen",
    )
    max_force: Positive = key(8.0, "N", "largest force of the person", source="chosen")
    max_couple: NonNegative = key(0.8, "N m", "largest couple of two hands about the vertical", source="chosen")
    speed: Positive = key(
        1.0, "m/s", "desired speed; the vehicle is slower, because the force needs a missing speed", source="chosen"
    )
    gain: Positive = key(3.0, "N s/m", "force per missing speed", source="chosen")
    look_ahead: Positive = key(
        1.0, "m", "distance along the path to the point to which the person steers", source="chosen"
    )
    approach_gain: Positive = key(0.8, "1/s", "desired speed near a stop, over the remaining distance", source="chosen")
    breakaway_force: NonNegative = key(
        0.3,
        "N",
        "force that is needed to move the vehicle, which the person adds",
        source="the threshold of the paper mission's admittance",
    )
    trim_rate: NonNegative = key(
        0.5,
        "1/s",
        "rate of the person's integral action, against wind: across the path, and near a stop in all directions",
        source="chosen",
    )
    corner_distance: Positive = key(
        0.5, "m", "distance to a waypoint at which the person changes to the next leg", source="chosen"
    )
    arrival_radius: Positive = key(0.3, "m", "distance to a stop at which it counts as reached", source="chosen")
    landing_speed: Positive = key(
        0.1, "m/s", "speed at the last waypoint below which the person requests a landing", source="chosen"
    )
    yaw_gain: NonNegative = key(1.5, "N m/rad", "couple of two hands for each rad of heading error", source="chosen")
    yaw_damping: NonNegative = key(2.0, "N m s", "couple of two hands against the yaw rate", source="chosen")
    start_time: NonNegative = key(
        0.0, "s", "time before which the person does not push", rule="after the tare, or a warning says so"
    )
    height_fraction: Share = key(
        0.9, "1", "fraction of the lift's height below which the person does not push", source="chosen"
    )
    path: tuple[WaypointTable, ...] = ()
    recording: str | None = key(
        None,
        None,
        'file of a recorded hand, for model "virtual-hand"; its path is relative to the mission file',
        unset="the hand does not hold the vehicle",
        example="hand.npz",
    )


def person_settings_from(p: PersonTable) -> PersonSettings:
    """The person's parameters of following the path, from the mission."""
    hands = 1.0 if p.model == "two-hands" else 0.0
    at_grip, stays = 0.0 if p.model == "steer" else 1.0, 1.0 if p.model == "hold" else 0.0
    return PersonSettings(at_grip, hands * p.yaw_gain, hands * p.yaw_damping, stays)


def waypoints_from(p: PersonTable, corridor: CorridorTable) -> tuple[WaypointTable, ...]:
    """The path of the person: their own, or the centreline of the corridor."""
    return p.path or tuple(WaypointTable.model_construct(point=point) for point in corridor.centreline)


def grip_from(p: PersonTable, vehicle: Vehicle) -> Vec3:
    """The point that the person holds [m, body axes, from the centre of mass]."""
    along = 0.0 if p.model == "two-hands" else p.grip
    return vec3(vehicle.origin) + Vec3(0.0, along, 0.0)


class Walk(NamedTuple):
    """The data besides the person on which a path depends.

    Attributes:
        waypoints: of the path.
        state: of the vehicle at t = 0.
        heading: at t = 0 [rad].
        lift: height [m] by which the vehicle is lifted.
    """

    waypoints: Sequence[WaypointTable]
    state: State
    heading: Number
    lift: Number


def walk_from(
    person: PersonTable, corridor: CorridorTable, state: State, initial: InitialTable, phases: PhasesTable
) -> Walk:
    """The data of a mission on which a path depends."""
    return Walk(waypoints_from(person, corridor), state, initial.euler[2], phases.height)


def path_legs_from(p: PersonTable, person: Person | Absent, walk: Walk) -> list[PathLeg]:
    """The legs of the path, from the initial position of the steered point; none without a person."""
    if not isinstance(person, Person):
        return []
    at, _ = guided_point(person.settings, person_view(person.grip, walk.state))
    at, heading, legs = Vec3(at.x, at.y, at.z + walk.lift), walk.heading, list[PathLeg]()
    level = at.z
    for place, w in enumerate(walk.waypoints):
        end = Vec3(number(w.point[0]), number(w.point[1]), level + w.rise)
        heading = heading_from(heading if w.heading is None else w.heading)
        stops = 1.0 if place == len(walk.waypoints) - 1 else where(w.dwell > 0.0, 1.0, 0.0)
        radius = where(stops > 0.0, p.arrival_radius, p.corner_distance)
        legs.append(PathLeg(at, end, heading, w.dwell, stops, radius, float(place)))
        at = end
    return legs


def start_virtual_hand(p: PersonTable, step: float) -> tuple[VirtualHand, VirtualHandState]:
    """The virtual hand and its state at t = 0."""
    nothing, still = LowPassState(ZERO, ZERO), LowPassState(0.0, 0.0)
    grab = VirtualHand(HAND_RELEASED, p.stiffness, p.damping, low_pass(1.0 / p.lag, step), p.max_force)
    return grab, VirtualHandState(nothing, still, nothing, 0.0, 0.0, 0.0, 0.0, 1.0)


def start_person(table: PersonTable, vehicle: Vehicle, step: float, walk: Walk) -> tuple[Any, Any]:
    """The person and their state at t = 0, for steps of `step` [s]."""
    p = table
    if p.model == "virtual-hand":
        return start_virtual_hand(p, step)
    grip = grip_from(p, vehicle)
    lag = low_pass(1.0 / p.lag, step)
    arm = filled(Arm, p, lag=lag, tremor=tremor(p.tremor, step), horizon=p.delay + 2.0 * p.lag)
    height = walk.state.position.z + p.height_fraction * walk.lift
    following = filled(PathFollowing, p, height=height, last=float(len(walk.waypoints) - 1))
    person = Person(grip, arm, following, person_settings_from(p))
    view = person_view(grip, walk.state)
    nothing = LowPassState(0.0, 0.0)
    memory = PersonState(
        view=view,
        index=0.0,
        leg=path_legs_from(p, person, walk)[0],
        place=LowPassState(view.grip, ZERO),
        couple=nothing,
        grasp=nothing,
        trim=ZERO,
        dwelled=0.0,
        begun=0.0,
        landing=0.0,
        tremor=STILL,
    )
    return person, memory


def tremor_noise_of(person: Any) -> Any:
    """The layout of a person's standard normals."""
    return NO_TREMOR_NOISE if isinstance(person, Person) else Absent()


def person_refusals(table: PersonTable, corridor: CorridorTable, nominal: Vehicle) -> Iterator[CheckResult]:
    """Refusals of a person without a path, or with a grip beside the payload."""
    p, box = table, nominal.payload.box
    low, high = box[0][1], box[1][1]
    if p.recording is not None and p.model != "virtual-hand":
        yield refused(f'person.recording = "{p.recording}": must be left out where person.model is "{p.model}"')
    if p.model in ("none", "virtual-hand"):
        return
    if not p.path and not corridor.centreline:
        yield refused(
            f'person.model = "{p.model}": must be "none" without a path; give [[person.path]] or corridor.centreline'
        )
    if not low <= p.grip <= high:
        yield refused(f"person.grip = {p.grip}: must be on the payload, from {low:g} m to {high:g} m of its origin")


def person_checks(table: PersonTable, guidance: str, push: str, estimator: EstimatorTable) -> Iterator[CheckResult]:
    """Check for a person whom a pilot with this guidance does not obey, or who pushes before the tare ends."""
    p = table
    if p.model == "virtual-hand":
        return
    if guidance != "interactive":
        yield warned('the landing request of [person] has no effect: pilot.guidance is not "interactive"')
    if push == "truth" or estimator.tare_start is None:
        return
    tared = estimator.tare_start + estimator.tare_duration
    if p.start_time < tared:
        start = f"person.start_time = {p.start_time}"
        yield warned(f"{start} is before the tare ends at {tared:g} s, which treats the push as a bias")


PERSON = Part(
    *("person", "body", "person", f'{PersonTable.acts} or "virtual-hand"', start_person),
    refusals=person_refusals,
    checks=person_checks,
    begins=lambda table: table.start_time,
)
