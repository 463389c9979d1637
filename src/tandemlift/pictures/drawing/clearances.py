"""Distances of a logged flight from the walls, and where the person holds the payload."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Quat, Vec3, vec3
from tandemlift.flight.record import Flight
from tandemlift.parts.contact.beam_axis import BeamAxis, beam_axis, beam_point, point_by_edge, point_by_top
from tandemlift.parts.contact.wall_geometry import edges_of, offset, offset_from_top, wall
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.vehicle import body_to_world


class Clearances(NamedTuple):
    """Least distance from walls (T) [m]: of the guards, and of the payload; none without a shape.

    Of a box, a mesh or bodies it is that of corners and edges.
    """

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
    beam, radius = np.full(len(flight.time), np.inf), vehicle.payload.radius or 0.0
    axes = _axes(vehicle, s, R)
    if not axes:
        return Clearances(guards, None)
    for one, (axis, half) in product(upright, axes):
        ways = [offset(one, beam_point(axis, end)) for end in (-half, half)]
        ways += [offset(edge, beam_point(axis, point_by_edge(axis, half, edge))) for edge in edges_of(one)]
        ways.append(offset_from_top(one, beam_point(axis, point_by_top(axis, half, one))))
        for way in ways:
            beam = np.minimum(beam, _length(way) - radius)
    return Clearances(guards, beam)


def _axes(vehicle: Vehicle, s: State, R: Array) -> list[tuple[BeamAxis, float]]:
    """The axis of a beam, or the edges of a box or a mesh, each with half its length [m]; none without a shape."""
    payload = vehicle.payload
    if payload.length and payload.radius:
        return [(beam_axis(vec3(vehicle.origin), s), 0.5 * payload.length)]
    found = []
    for a, b in (ends for hull in payload.hulls for ends in hull.corners[hull.edges]):
        half = 0.5 * float(np.linalg.norm(b - a))
        center = s.position + Vec3(*(R @ (vehicle.origin + 0.5 * (a + b))).T)
        found.append((BeamAxis(center, s.velocity, Vec3(*(R @ (0.5 * (b - a) / half)).T), s.rates), half))
    return found


def grips(flight: Flight) -> Array | None:
    """The place at which the person of [person] holds the payload (T, 3) [m, world axes], or None without one."""
    person = flight.mission.get("person", {"model": "none"})
    if person["model"] in ("none", "virtual-hand"):
        return None
    along = 0.0 if person["model"] == "two-hands" else person["grip"]
    arm = np.array([0.0, along, 0.0]) + Vehicle.from_mission(flight.mission).origin
    return flight["position"] + body_to_world(flight["attitude"]) @ arm
