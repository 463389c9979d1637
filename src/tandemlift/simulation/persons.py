"""The person of a mission: their path as a table of legs, and how they are before the first step."""

from __future__ import annotations

from typing import Any

from tandemlift.algebra.vector import ZERO, Nothing, Vec3, vec3
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.person.person import Arm, Leg, Manner, Partner, Partnering, Walk, sight, steered
from tandemlift.laws.person.tremor import STILL, TWITCH, tremor
from tandemlift.laws.person.virtual_hand import NOBODY_HOLDS, Grab, Grabbing
from tandemlift.laws.signals.low_pass import Smoothed, low_pass
from tandemlift.settings import Mission
from tandemlift.settings.person import PartnerTable, WaypointTable
from tandemlift.vehicle import Vehicle


def manner_of(p: PartnerTable) -> Manner:
    """How a person of a mission leads."""
    hands = 1.0 if p.model == "two-hands" else 0.0
    at_grip, stays = 0.0 if p.model == "steer" else 1.0, 1.0 if p.model == "hold" else 0.0
    return Manner(at_grip, hands * p.yaw_gain, hands * p.yaw_damping, stays)


def waypoints_of(mission: Mission) -> tuple[WaypointTable, ...]:
    """The path of a mission's person: their own, or the corridor's centreline."""
    centreline = mission.corridor.centreline
    return mission.person.path or tuple(WaypointTable(point=point) for point in centreline)


def grip_of(mission: Mission, vehicle: Vehicle) -> Vec3:
    """Where the person holds on [m, body axes, from the centre of mass]."""
    along = 0.0 if mission.person.model == "two-hands" else mission.person.grip
    return vec3([0.0, along, 0.0] - vehicle.center_of_mass)


def legs_of(mission: Mission, partner: Any, state: State) -> list[Leg]:
    """The legs of a mission's path, from where what is steered is at the start; none without a person."""
    if not isinstance(partner, Partner):
        return []
    p, waypoints = mission.person, waypoints_of(mission)
    at, _ = steered(partner.manner, sight(partner.grip, state))
    at, heading, legs = Vec3(at.x, at.y, at.z + mission.phases.height), mission.initial.euler[2], list[Leg]()
    level = at.z
    for number, w in enumerate(waypoints):
        end = Vec3(float(w.point[0]), float(w.point[1]), level + w.rise)
        heading = heading if w.heading is None else w.heading
        stops = 1.0 if w.dwell > 0.0 or number == len(waypoints) - 1 else 0.0
        radius = p.arrival_radius if stops else p.corner_distance
        legs.append(Leg(at, end, heading, w.dwell, stops, radius, float(number)))
        at = end
    return legs


def start_grab(p: PartnerTable, step: float) -> tuple[Grab, Grabbing]:
    """A hand that is moved from outside, and its memory at t = 0."""
    nothing, still = Smoothed(ZERO, ZERO), Smoothed(0.0, 0.0)
    grab = Grab(NOBODY_HOLDS, p.stiffness, p.damping, low_pass(1.0 / p.lag, step), p.max_force)
    return grab, Grabbing(nothing, still, nothing, 0.0, 0.0, 0.0, 0.0, 1.0)


def start_partner(mission: Mission, vehicle: Vehicle, state: State) -> tuple[Any, Any, Any]:
    """The person of a mission, their memory at t = 0 and the layout of their noise; or `Nothing` three times."""
    p, step = mission.person, mission.mission.step
    if p.model == "none":
        return Nothing(), Nothing(), Nothing()
    if p.model == "grab":
        return *start_grab(p, step), Nothing()
    grip = grip_of(mission, vehicle)
    arm = Arm(
        stiffness=p.stiffness,
        damping=p.damping,
        lag=low_pass(1.0 / p.lag, step),
        tremor=tremor(p.tremor, step),
        most=p.max_force,
        most_couple=p.max_couple,
        horizon=p.delay + 2.0 * p.lag,
    )
    height = mission.initial.position[2] + p.height_fraction * mission.phases.height
    last = float(len(waypoints_of(mission)) - 1)
    walk = Walk(
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
    partner = Partner(grip, arm, walk, manner_of(p))
    seen = sight(grip, state)
    quiet = Smoothed(0.0, 0.0)
    leg = legs_of(mission, partner, state)[0]
    memory = Partnering(seen, 0.0, leg, Smoothed(seen.grip, ZERO), quiet, quiet, ZERO, 0.0, 0.0, 0.0, STILL)
    return partner, memory, TWITCH
