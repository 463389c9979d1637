"""The person of a mission: the path as a table of legs, and the person's state at t = 0."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra.ops import where
from tandemlift.core.algebra.types import number
from tandemlift.core.algebra.vector import ZERO, Nothing, Vec3, vec3
from tandemlift.core.settings import Mission
from tandemlift.core.settings.person import PersonTable, WaypointTable
from tandemlift.parts.mechanics.rigid_body import State
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
from tandemlift.parts.signals.low_pass import LowPassState, low_pass
from tandemlift.parts.vehicle import Vehicle


def person_settings_from(p: PersonTable) -> PersonSettings:
    """The person's way of leading, from the mission."""
    hands = 1.0 if p.model == "two-hands" else 0.0
    at_grip, stays = 0.0 if p.model == "steer" else 1.0, 1.0 if p.model == "hold" else 0.0
    return PersonSettings(at_grip, hands * p.yaw_gain, hands * p.yaw_damping, stays)


def waypoints_from(mission: Mission) -> tuple[WaypointTable, ...]:
    """The path of the person: their own, or the centreline of the corridor."""
    centreline = mission.corridor.centreline
    return mission.person.path or tuple(WaypointTable.model_construct(point=point) for point in centreline)


def grip_from(mission: Mission, vehicle: Vehicle) -> Vec3:
    """The point that the person holds [m, body axes, from the centre of mass]."""
    along = 0.0 if mission.person.model == "two-hands" else mission.person.grip
    return vec3([0.0, along, 0.0] - vehicle.center_of_mass)


def path_legs_from(mission: Mission, person: Any, state: State) -> list[PathLeg]:
    """The legs of the path, from the initial position of the steered point; none without a person."""
    if not isinstance(person, Person):
        return []
    p, waypoints = mission.person, waypoints_from(mission)
    at, _ = guided_point(person.settings, person_view(person.grip, state))
    at, heading, legs = Vec3(at.x, at.y, at.z + mission.phases.height), mission.initial.euler[2], list[PathLeg]()
    level = at.z
    for place, w in enumerate(waypoints):
        end = Vec3(number(w.point[0]), number(w.point[1]), level + w.rise)
        heading = heading if w.heading is None else w.heading
        stops = 1.0 if place == len(waypoints) - 1 else where(w.dwell > 0.0, 1.0, 0.0)
        radius = where(stops > 0.0, p.arrival_radius, p.corner_distance)
        legs.append(PathLeg(at, end, heading, w.dwell, stops, radius, float(place)))
        at = end
    return legs


def start_virtual_hand(p: PersonTable, step: float) -> tuple[VirtualHand, VirtualHandState]:
    """The virtual hand and its state at t = 0."""
    nothing, still = LowPassState(ZERO, ZERO), LowPassState(0.0, 0.0)
    grab = VirtualHand(HAND_RELEASED, p.stiffness, p.damping, low_pass(1.0 / p.lag, step), p.max_force)
    return grab, VirtualHandState(nothing, still, nothing, 0.0, 0.0, 0.0, 0.0, 1.0)


def start_person(mission: Mission, vehicle: Vehicle, state: State) -> tuple[Any, Any, Any]:
    """The person of a mission, their state at t = 0 and the layout of their noise; or `Nothing` three times."""
    p, step = mission.person, mission.mission.step
    if p.model == "none":
        return Nothing(), Nothing(), Nothing()
    if p.model == "virtual-hand":
        return *start_virtual_hand(p, step), Nothing()
    grip = grip_from(mission, vehicle)
    arm = Arm(
        stiffness=p.stiffness,
        damping=p.damping,
        lag=low_pass(1.0 / p.lag, step),
        tremor=tremor(p.tremor, step),
        max_force=p.max_force,
        max_couple=p.max_couple,
        horizon=p.delay + 2.0 * p.lag,
    )
    height = mission.initial.position[2] + p.height_fraction * mission.phases.height
    last = float(len(waypoints_from(mission)) - 1)
    following = PathFollowing(
        speed=p.speed,
        gain=p.gain,
        look_ahead=p.look_ahead,
        approach_gain=p.approach_gain,
        breakaway_force=p.breakaway_force,
        trim_rate=p.trim_rate,
        landing_speed=p.landing_speed,
        start_time=p.start_time,
        height=height,
        last=last,
    )
    person = Person(grip, arm, following, person_settings_from(p))
    view = person_view(grip, state)
    nothing = LowPassState(0.0, 0.0)
    memory = PersonState(
        view=view,
        index=0.0,
        leg=path_legs_from(mission, person, state)[0],
        place=LowPassState(view.grip, ZERO),
        couple=nothing,
        grasp=nothing,
        trim=ZERO,
        dwelled=0.0,
        begun=0.0,
        landing=0.0,
        tremor=STILL,
    )
    return person, memory, NO_TREMOR_NOISE
