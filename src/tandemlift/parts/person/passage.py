"""Checks of the path along which a person leads the vehicle: its duration, and the room between walls.

The vehicle is assumed to follow exactly. The quadrotors' guards must stay clear of all walls. The heading is
kept if one hand steers the centre of mass, and follows the path if two hands rotate the vehicle. If one end is pulled,
the vehicle trails behind the hand: the centre moves along the line to the grip (a tractrix).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import CheckResult, judged
from tandemlift.core.trajectories import PhasesTable
from tandemlift.core.types import Array
from tandemlift.parts.contact.corridor import CorridorTable, WallTable
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.person.person_table import PersonTable, waypoints_from

APART = 0.1  # m, between places on the path
MOST_PLACES = 4000  # places
ROOM_SHARE = 0.4  # of the room
TURNING = 0.7  # rad/s, at which two hands rotate the vehicle


class Places(NamedTuple):
    """Places on the path: the centre of mass [m] (n, 2), and the heading [rad] (n)."""

    centres: Array
    headings: Array


def passage_checks(
    person: PersonTable, corridor: CorridorTable, walls: Sequence[WallTable], initial: InitialTable, vehicle: Vehicle
) -> Iterator[CheckResult]:
    """Compare the required distance from all walls, the corridor's too, with the smallest one on the path."""
    places = places_of(person, corridor, initial, vehicle) if walls else None
    if places is None:
        return
    room, at = least_room(places, walls, vehicle)
    guard = max(q.guard_radius for q in vehicle.quadrotors)
    x, y = places.centres[at]
    how = {"pull": "trailing behind its end", "two-hands": "rotated by two hands"}.get(
        person.model, "with its heading kept"
    )
    text = (
        f"led {how}, near x = {x:.3g} m, y = {y:.3g} m a quadrotor of radius {guard:g} m comes to {room:.3g} m from a "
        f"wall and touches it: widen corridor.width or the gap by {2.0 * max(guard - room, 0.0):.2g} m or more, or "
        'lead it end on (person.model = "pull" or "two-hands")'
    )
    yield judged("passage", guard, room, "m", text, near=ROOM_SHARE)


def grip_along(p: PersonTable, vehicle: Vehicle) -> float:
    """The place at which a hand holds the payload, along body y from the vehicle's centre of mass [m]."""
    return float(p.grip + vehicle.origin[1])


def way_of(
    p: PersonTable, corridor: CorridorTable, initial: InitialTable, vehicle: Vehicle
) -> tuple[Array, list[float]]:
    """The path (n, 2) [m] of the steered point from the start, and the heading of each leg [rad]."""
    (x, y, _), yaw, waypoints = initial.position, initial.euler[2], waypoints_from(p, corridor)
    grip = grip_along(p, vehicle) if p.model in ("pull", "hold") else 0.0
    start = (x - grip * math.sin(yaw), y + grip * math.cos(yaw))
    headings, now = list[float](), yaw
    for w in waypoints:
        now = now if w.heading is None else w.heading
        headings.append(now)
    return np.array([start, *[w.point for w in waypoints]]), headings


def way_checks(
    p: PersonTable, corridor: CorridorTable, initial: InitialTable, phases: PhasesTable, landing: float, end: float
) -> Iterator[CheckResult]:
    """Check for a path that takes longer than the mission until its `end`, with `landing` [s], at the desired speed."""
    points = [w.point for w in waypoints_from(p, corridor)]
    if p.model not in ("pull", "steer", "two-hands") or not points:
        return
    length = sum(itertools.starmap(math.dist, itertools.pairwise([initial.position[:2], *points])))
    length = max(length - abs(p.grip) - p.arrival_radius, 0.0)
    begins = max(p.start_time, phases.lift_start + p.height_fraction * phases.lift_duration * 0.5)
    least = begins + length / p.speed + sum(w.dwell for w in p.path) + landing
    text = (
        f"the person's path of {length:.3g} m at person.speed = {p.speed:g} m/s and the landing take until "
        f"{least:.4g} s at the soonest, and mission.duration = {end:g} s: set it to more than {math.ceil(least)} s"
    )
    yield judged("schedule", least, end, "s", text, subject="person", near=0.1)


def places_of(p: PersonTable, corridor: CorridorTable, initial: InitialTable, vehicle: Vehicle) -> Places | None:
    """The path as places of the vehicle; None for a person whose path is not known in advance."""
    if p.model not in ("pull", "steer", "two-hands") or (p.model == "steer" and p.grip != 0.0):
        return None
    way, headings = way_of(p, corridor, initial, vehicle)
    legs = list(itertools.pairwise(way))
    lengths = [float(np.linalg.norm(b - a)) for a, b in legs]
    if not legs or sum(lengths) > MOST_PLACES * APART:
        return None
    points, turned = [way[:1]], [np.array([initial.euler[2]])]
    for (a, b), length, heading in zip(legs, lengths, headings, strict=True):
        n = max(math.ceil(length / APART), 1)
        share = np.arange(1, n + 1)[:, None] / n
        points.append(a + share * (b - a))
        turned.append(np.full(n, heading))
    if p.model == "pull":
        return trailing(np.vstack(points), grip_along(p, vehicle), initial.euler[2])
    return Places(np.vstack(points), turning(np.concatenate(turned), p.speed))


def turning(headings: Array, speed: float) -> Array:
    """Headings that follow those of the path at a rate of at most `TURNING`, at a speed [m/s]."""
    most, now, found = TURNING * APART / speed, headings[0], []
    for heading in headings:
        off = (heading - now + math.pi) % (2.0 * math.pi) - math.pi
        now += min(max(off, -most), most)
        found.append(now)
    return np.array(found)


def trailing(grips: Array, grip: float, yaw: float) -> Places | None:
    """The places of a vehicle behind a grip that is led along a path; None if the grip is at the centre."""
    if grip == 0.0:
        return None
    # the centre of mass is on the other side of the grip if the grip is at the other end
    behind = grips[0] - abs(grip) * math.copysign(1.0, grip) * np.array([-math.sin(yaw), math.cos(yaw)])
    centres, headings = [], []
    for at in grips:
        off = at - behind
        distance = float(np.linalg.norm(off))
        behind = at - off * (abs(grip) / distance) if distance > 0.0 else behind
        along = (at - behind) * math.copysign(1.0, grip)
        centres.append(behind)
        headings.append(math.atan2(-along[0], along[1]))
    return Places(np.array(centres), np.array(headings))


def quadrotors_at(places: Places, arms: Array) -> Array:
    """The quadrotors' centres (n, N, 2) [m] at places; arms (N, 2) [m, body axes]."""
    c, s = np.cos(places.headings), np.sin(places.headings)
    R = np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
    return places.centres[:, None, :] + np.einsum("nij,kj->nki", R, arms)


def least_room(places: Places, walls: Sequence[WallTable], vehicle: Vehicle) -> tuple[float, int]:
    """(The smallest distance from a wall to a quadrotor's centre, corrected for a smaller guard; its place)."""
    starts, ends = np.array([w.start for w in walls]), np.array([w.end for w in walls])
    along = ends - starts
    p = quadrotors_at(places, vehicle.lever_arms[:, :2])[:, :, None, :] - starts
    share = np.clip(np.sum(p * along, axis=-1) / np.maximum(np.sum(along * along, axis=-1), 1e-12), 0.0, 1.0)
    distance = np.linalg.norm(p - share[..., None] * along, axis=-1).min(axis=2)
    guards = np.array([q.guard_radius for q in vehicle.quadrotors])
    room = (distance + (guards.max() - guards)).min(axis=1)
    at = int(room.argmin())
    return float(room[at]), at
