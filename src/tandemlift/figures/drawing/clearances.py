"""How far a logged flight was from the walls, and where the person held on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.algebra.vector import Quat, Vec3, vec3
from tandemlift.common.types import Array
from tandemlift.figures.drawing.vehicle import vehicle_of
from tandemlift.flight.record import Flight
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.loads import parts_layout
from tandemlift.laws.mechanics.rectangle import edges_of, offset, offset_from_top, wall
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.laws.mechanics.walls import beam_axis, on_beam, point_by_edge, point_by_top
from tandemlift.settings import wall_tables


class Clearances(NamedTuple):
    """Least distance from walls (T) [m]: of the guards, and of the beam; none without one."""

    guards: Array
    beam: Array | None


def state_of(flight: Flight) -> State:
    """The state of all samples, each number an array (T)."""
    names = zip(("position", "velocity", "attitude", "rates"), (Vec3, Vec3, Quat, Vec3), strict=True)
    return State(*[kind(*flight[name].T) for name, kind in names])


def _length(o: Vec3) -> Array:
    return np.sqrt(o.x * o.x + o.y * o.y + o.z * o.z)


def clearances(flight: Flight) -> Clearances:
    """How far guards and beam were from the nearest wall, below zero where they were in it."""
    vehicle, s = vehicle_of(flight), state_of(flight)
    upright = [wall(w["start"], w["end"], w["top"]) for w in wall_tables(flight.mission)]
    R = rotation_from_quaternion(s.attitude)
    guards = np.full(len(flight.time), np.inf)
    for quadrotor, arm in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        x, y, z = (sum(row[i] * arm[i] for i in range(3)) for row in R)
        place = Vec3(s.position.x + x, s.position.y + y, s.position.z + z)
        for one in upright:
            guards = np.minimum(guards, _length(offset(one, place)) - quadrotor.guard_radius)
    payload = vehicle.payload
    if not (payload.length and payload.radius):
        return Clearances(guards, None)
    axis, half, beam = beam_axis(parts_layout(vehicle), s), 0.5 * payload.length, np.full(len(flight.time), np.inf)
    for one in upright:
        ways = [offset(one, on_beam(axis, end)) for end in (-half, half)]
        ways += [offset(edge, on_beam(axis, point_by_edge(axis, half, edge))) for edge in edges_of(one)]
        ways.append(offset_from_top(one, on_beam(axis, point_by_top(axis, half, one))))
        for way in ways:
            beam = np.minimum(beam, _length(way) - payload.radius)
    return Clearances(guards, beam)


def grips(flight: Flight) -> Array | None:
    """Where the person of [person] holds on (T, 3) [m, world axes], or None without one."""
    person = flight.mission.get("person", {"model": "none"})
    if person["model"] in ("none", "grab"):
        return None
    along = 0.0 if person["model"] == "two-hands" else person["grip"]
    arm = vec3(np.array([0.0, along, 0.0]) - vehicle_of(flight).center_of_mass)
    R = rotation_from_quaternion(Quat(*flight["attitude"].T))
    ways = np.column_stack([row.x * arm.x + row.y * arm.y + row.z * arm.z for row in R])
    return flight["position"] + ways
