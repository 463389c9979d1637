"""The scene: what a viewer must know of a mission before frames mean anything. JSON-able, SI units.

Of the vehicle everything is in body axes (the beam lies along y) from the system's centre of mass; the rest is in world
axes, z up. The vehicle is the one that the pilot believes in.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tandemlift import __version__
from tandemlift.algebra.vector import Nothing
from tandemlift.common.types import Array
from tandemlift.flight.channels import PHASES
from tandemlift.laws.guidance.fault_reactions import FAULTS, alarm_name
from tandemlift.laws.mechanics.contact import soles_below
from tandemlift.laws.sensors.health import KINDS
from tandemlift.live.frames import RATE, fields_of
from tandemlift.missions import tables_of
from tandemlift.models.surroundings import floor_from
from tandemlift.settings import Mission, Quadrotor, wall_tables
from tandemlift.vehicle import Vehicle

SPRING = {"stiffness": 8.0, "damping": 2.0, "max_force": 8.0}  # N/m, N s/m, N: of a page's hand unless told otherwise
WALL_THICKNESS = 0.02  # m, as drawn; walls have none
SHAPELESS = 0.2  # m, edge of the box drawn for a payload without length
THIN = 0.03  # m, radius drawn for a beam without one


def scene_of(
    mission: Mission,
    engine: str,
    *,
    controls: Sequence[Mapping[str, Any]] = (),
    spring: Mapping[str, float] = SPRING,
) -> dict[str, Any]:
    """The scene of a mission.

    Args:
        mission: what is flown.
        engine: where its body lives.
        controls: what a viewer may change: key, label, group, value, and unit with min and max, or choices.
        spring: stiffness [N/m], damping [N s/m] and max_force [N] of the hand by which a page pulls.
    """
    vehicle = Vehicle.from_settings(mission.vehicle)
    floor = floor_from(mission, vehicle)
    height = _lowest(mission, vehicle) if isinstance(floor, Nothing) else float(floor.height)
    scene = scene_of_tables(tables_of(mission), vehicle, engine, height)
    return {**scene, "spring": dict(spring), "controls": [dict(c) for c in controls]}


def scene_of_tables(tables: Mapping[str, Any], vehicle: Vehicle, engine: str, floor: float) -> dict[str, Any]:
    """The scene of a mission given as nested tables, with its floor, or a level to draw one at, at z = `floor` [m]."""
    corridor = tables.get("corridor", {})
    return {
        "mission": tables["mission"]["name"],
        "engine": engine,
        "version": __version__,
        "step": tables["mission"]["step"],
        "rate": RATE,
        "vehicle": _vehicle(vehicle),
        "ground": tables.get("ground", {}).get("model", "none") != "none",
        "floor": floor,
        "walls": [_wall(w, floor) for w in wall_tables(tables) if w["top"] > floor],
        "corridor": {k: corridor[k] for k in ("centreline", "width", "height")} if corridor.get("centreline") else None,
        "threshold": list(tables["admittance"]["threshold"]),
        "spring": dict(SPRING),
        "phases": list(PHASES),
        "alarms": alarm_names(),
        "fields": [list(field) for field in fields_of(vehicle.rotor_count)],
        "controls": [],
    }


def alarm_names() -> list[str]:
    """An alarm's words at the place of its number; "" where no alarm has that number, as 0 for none."""
    names = [""] * (10 * len(FAULTS) + len(KINDS) + 1)
    for fault in range(1, len(FAULTS) + 1):
        for kind in range(len(KINDS) + 1):
            names[10 * fault + kind] = alarm_name(10 * fault + kind)
    return names


def _lowest(mission: Mission, vehicle: Vehicle) -> float:
    """Height of the soles as the flight begins, were it level [m]."""
    fleet = vehicle.quadrotors
    soles = soles_below(vehicle.lever_arms, [q.feet_spread for q in fleet], [q.feet_depth for q in fleet])
    return float(mission.initial.position[2] + np.min(soles[:, 2]))


def _vehicle(vehicle: Vehicle) -> dict[str, Any]:
    payload = vehicle.payload
    if payload.length:
        length, across = payload.length, 2.0 * (payload.radius or THIN)
    else:
        length, across = SHAPELESS, SHAPELESS
    parts = zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)
    return {
        "quadrotors": [_quadrotor(q, center, -vehicle.center_of_mass) for q, center in parts],
        "payload": {"position": _list(-vehicle.center_of_mass), "length": length, "width": across, "height": across},
        "mass": vehicle.mass,
    }


def _quadrotor(quadrotor: Quadrotor, center: Array, payload: Array) -> dict[str, Any]:
    """Of one quadrotor: its arm is the mean distance of its rotors; its guard is a sphere; its joint is on the beam."""
    rotors = [
        {
            "position": _list(center + np.array([x, y, 0.0])),
            "spin": spin,
            "radius": quadrotor.rotor_radius,
            "max_thrust": quadrotor.max_thrust,
        }
        for (x, y), spin in zip(quadrotor.rotors, quadrotor.spins, strict=True)
    ]
    return {
        "position": _list(center),
        "joint": _list(payload + np.array(quadrotor.joint_position)),
        "arm": float(np.linalg.norm(quadrotor.rotors, axis=1).mean()),
        "guard": quadrotor.guard_radius,
        "feet": {"spread": quadrotor.feet_spread, "depth": quadrotor.feet_depth},
        "rotors": rotors,
    }


def _wall(wall: Mapping[str, Any], floor: float) -> dict[str, Any]:
    """An upright box from the floor to a wall's top, its length along `heading` [rad] from world x."""
    (x, y), (end_x, end_y), top = wall["start"], wall["end"], wall["top"]
    return {
        "center": [(x + end_x) / 2.0, (y + end_y) / 2.0, (floor + top) / 2.0],
        "size": [math.hypot(end_x - x, end_y - y), WALL_THICKNESS, top - floor],
        "heading": math.atan2(end_y - y, end_x - x),
    }


def _list(values: Array) -> list[float]:
    return [float(v) + 0.0 for v in values]
