"""Distances of a logged flight from the walls, and where the person holds the payload."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Quat, Vec3, vec3
from tandemlift.flight.record import Flight
from tandemlift.parts.contact.beam_axis import beam_axis, beam_point, point_by_edge, point_by_top
from tandemlift.parts.contact.wall_geometry import edges_of, offset, offset_from_top, wall
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.figures.drawing.vehicle import body_to_world


class Clearances(NamedTuple):
    """Least distance from walls (T) [m]: of the guards, and of the beam; none without one."""

    guards: Array
    beam: Array | None


def logged_states(flight: Flight) -> State:
    """The state of all samples, each number an array (T)."""
    names = zip(("position", "velocity", "attitude", "rates"), (Vec3, Vec3, Quat, Vec3), strict=True)
    return State(*[kind(*flight[name].T) for name, kind in names])


def _length(o: Vec3) -> Array:
    return np.sqrt(o.x * o.x + o.y * o.y + o.z * o.z)


def clearances(flight: Flight) -> Clearances:
    """Distance of guards and beam from the nearest wall; below zero where they are in it."""
    vehicle, s = Vehicle.from_mission(flight.mission), logged_states(flight)
    upright = [wall(w["start"], w["end"], w["top"]) for w in flight.walls]
    R = body_to_world(flight["attitude"])
    guards = np.full(len(flight.time), np.inf)
    for quadrotor, arm in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        place = Vec3(*(flight["position"] + R @ arm).T)
        for one in upright:
            guards = np.minimum(guards, _length(offset(one, place)) - quadrotor.guard_radius)
    payload = vehicle.payload
    if not (payload.length and payload.radius):
        return Clearances(guards, None)
    axis, half = beam_axis(vec3(vehicle.origin), s), 0.5 * payload.length
    beam = np.full(len(flight.time), np.inf)
    for one in upright:
        ways = [offset(one, beam_point(axis, end)) for end in (-half, half)]
        ways += [offset(edge, beam_point(axis, point_by_edge(axis, half, edge))) for edge in edges_of(one)]
        ways.append(offset_from_top(one, beam_point(axis, point_by_top(axis, half, one))))
        for way in ways:
            beam = np.minimum(beam, _length(way) - payload.radius)
    return Clearances(guards, beam)


def grips(flight: Flight) -> Array | None:
    """The place at which the person of [person] holds the payload (T, 3) [m, world axes], or None without one."""
    person = flight.mission.get("person", {"model": "none"})
    if person["model"] in ("none", "virtual-hand"):
        return None
    along = 0.0 if person["model"] == "two-hands" else person["grip"]
    arm = np.array([0.0, along, 0.0]) + Vehicle.from_mission(flight.mission).origin
    return flight["position"] + body_to_world(flight["attitude"]) @ arm
