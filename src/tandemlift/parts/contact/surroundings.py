"""Floor and walls around a flown vehicle, for figures and scores: from a flight's tables, in many states at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import ZERO, Quat, Vec3, apply, vec3
from tandemlift.parts.contact.beam_axis import BeamAxis, beam_axis, beam_point, point_by_edge, point_by_top
from tandemlift.parts.contact.clearance import sphere_distance
from tandemlift.parts.contact.corridor import CorridorTable, WallTable
from tandemlift.parts.contact.standing import GroundTable, floor_under
from tandemlift.parts.contact.wall_geometry import edges_of, offset, offset_from_top, wall
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

__all__ = ["CorridorTable", "WallDistances", "WallTable", "floor_height_of", "wall_distances"]


def floor_height_of(vehicle: Vehicle, mission: Mapping[str, Any]) -> float | None:
    """Height z of the floor [m] by the tables of a resolved mission; None where there is none."""
    ground = GroundTable.model_validate(mission.get("ground", {}))
    if ground.model == "none" or ground.height is not None:
        return ground.height if ground.model != "none" else None
    scale, start = mission.get("plant", {}).get("mass_scale", 1.0), mission["initial"]["position"][2]
    return float(floor_under(vehicle, ground, scale, mission["mission"]["step"], start).height)


class WallDistances(NamedTuple):
    """Least distance from walls (T) [m]: of the guards, and of the payload; none without a shape.

    Of a box, a mesh or bodies it is that of corners and edges.
    """

    guards: Array
    beam: Array | None


def wall_distances(
    vehicle: Vehicle, walls: Iterable[Mapping[str, Any]], position: Array, attitude: Array
) -> WallDistances:
    """Distance of guards and payload from the nearest wall in many states at once; below zero where they are in it.

    It tries every wall in every state, where `clearance` remembers the nearest.

    Args:
        vehicle: which flew.
        walls: as of a flight: `start`, `end` and `top`.
        position: of the centre of mass (T, 3) [m, world axes].
        attitude: unit quaternions (T, 4).
    """
    s = State(Vec3(*position.T), ZERO, Quat(*attitude.T), ZERO)
    upright, R = [wall(w["start"], w["end"], w["top"]) for w in walls], rotation_from_quaternion(s.attitude)
    guards, beam = (np.full(len(position), np.inf) for _ in range(2))
    for quadrotor, arm in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        place = s.position + apply(R, vec3(arm))
        for one in upright:
            guards = np.minimum(guards, sphere_distance(offset(one, place), quadrotor.guard_radius))
    axes, radius = _payload_axes(vehicle, s), vehicle.payload.radius or 0.0
    if not axes:
        return WallDistances(guards, None)
    for one, (axis, half) in product(upright, axes):
        ways = [offset(one, beam_point(axis, end)) for end in (-half, half)]
        ways += [offset(edge, beam_point(axis, point_by_edge(axis, half, edge))) for edge in edges_of(one)]
        ways.append(offset_from_top(one, beam_point(axis, point_by_top(axis, half, one))))
        for way in ways:
            beam = np.minimum(beam, sphere_distance(way, radius))
    return WallDistances(guards, beam)


def _payload_axes(vehicle: Vehicle, s: State) -> list[tuple[BeamAxis, float]]:
    """The axis of a beam, or the edges of a body, each with half its length [m]; none without a shape."""
    payload, R = vehicle.payload, rotation_from_quaternion(s.attitude)
    if payload.length and payload.radius:
        return [(beam_axis(vec3(vehicle.origin), s), 0.5 * payload.length)]
    found = []
    for a, b in (ends for hull in payload.hulls for ends in hull.corners[hull.edges]):
        half = 0.5 * float(np.linalg.norm(b - a))
        center = s.position + apply(R, vec3(vehicle.origin + 0.5 * (a + b)))
        found.append((BeamAxis(center, s.velocity, apply(R, vec3(0.5 * (b - a) / half)), s.rates), half))
    return found
