"""Vehicles thrown among walls, and how near the middle of any part came to a wall: none may get to the other side.

Distances are found by points and segments in NumPy, between the steps too, and share nothing with the contact laws.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation, Slerp
from ten_crashes import THROWN

import tandemlift as tl
from tandemlift.core.vector import vec3
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission
from tandemlift.parts.contact.corridor import WallTable
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle

BELOW = -100.0  # m, where a wall ends


def thrown(changes: dict[str, Any], duration: float = 0.5, step: float = 0.001) -> Mission:
    """`iris` with still rotors, thrown above a far floor, every step logged."""
    table = {"mission.duration": duration, "mission.step": step, "mission.log_interval": step, "ground.height": -4.0}
    return tl.load_mission("iris", THROWN | table | {"crash.tilt": 3.14, "crash.impulse": 1e6} | changes)


def upright(start: Any, end: Any, top: float = 9.0) -> dict[str, Any]:
    """A wall as a mission's table has it."""
    return {"start": [float(x) for x in start], "end": [float(x) for x in end], "top": float(top)}


def from_point(p: np.ndarray, wall: WallTable) -> np.ndarray:
    """Distances of points (T, 3) from a wall [m]."""
    a, along = np.array(wall.start), np.subtract(wall.end, wall.start)
    share = np.clip((p[:, :2] - a) @ along / (along @ along), 0.0, 1.0)
    offset = p[:, :2] - a - share[:, None] * along
    return np.sqrt((offset**2).sum(1) + np.maximum(p[:, 2] - wall.top, 0.0) ** 2)


def from_segment(p: np.ndarray, q: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Distances of segments p q (T, 3) from the segment a b [m] (Ericson, section 5.1.9)."""
    u, v, r = q - p, b - a, p - a
    uu, vv, uv, ur, vr = (u * u).sum(1), v @ v, u @ v, (u * r).sum(1), r @ v
    sine = np.maximum(uu * vv - uv * uv, 1e-12)
    there = np.clip((np.clip((uv * vr - ur * vv) / sine, 0.0, 1.0) * uv + vr) / vv, 0.0, 1.0)
    here = np.clip((there * uv - ur) / uu, 0.0, 1.0)
    return np.linalg.norm(r + here[:, None] * u - there[:, None] * v, axis=1)


def from_beam(p: np.ndarray, q: np.ndarray, wall: WallTable) -> np.ndarray:
    """Distances of the beam's axis between its ends p and q (T, 3) from a wall [m]."""
    a, b = np.array([*wall.start, wall.top]), np.array([*wall.end, wall.top])
    edges = [(a, b), *((end, np.array([*end[:2], BELOW])) for end in (a, b))]
    return np.min([from_point(p, wall), from_point(q, wall), *(from_segment(p, q, *edge) for edge in edges)], axis=0)


def nearest(vehicle: Vehicle, walls: list[WallTable], poses: np.ndarray, between: int = 16) -> tuple[float, float]:
    """The least distances of guards' centres and of the beam's axis from walls [m].

    Args:
        vehicle: of which the parts are.
        walls: at least one.
        poses: position and attitude (T, 7) of every step.
        between: places looked at in each step.
    """
    times = np.arange(len(poses))
    fine = np.linspace(0.0, times[-1], between * times[-1] + 1)
    R = Slerp(times, Rotation.from_quat(poses[:, 3:], scalar_first=True))(fine).as_matrix()
    at = np.stack([np.interp(fine, times, axis) for axis in poses[:, :3].T], axis=1)
    half = np.array([0.0, 0.5 * vehicle.payload.length, 0.0])
    guards = [at + R @ center for center in vehicle.lever_arms]
    ends = [at + R @ (end - vehicle.center_of_mass) for end in (-half, half)]
    return min(from_point(p, w).min() for p in guards for w in walls), min(from_beam(*ends, w).min() for w in walls)


def nearest_of(flight: Flight, mission: Mission) -> tuple[float, float]:
    """`nearest`, of a flight with every step logged."""
    poses = np.hstack([flight["position"], flight["attitude"]])
    return nearest(Vehicle.from_settings(mission.vehicle), mission.all_walls, poses)


def random_wall(rng: np.random.Generator, way: np.ndarray) -> WallTable:
    """A post, or a low, long or high wall, about a way of the vehicle [m]."""
    length, turn = rng.choice([0.01, 0.4, 2.5, 6.0]), rng.uniform(0.0, np.pi)
    middle, along = way + rng.normal(0.0, 1.2, 2), 0.5 * length * np.array([np.cos(turn), np.sin(turn)])
    return WallTable(**upright(middle - along, middle + along, rng.choice([9.0, rng.uniform(-1.0, 0.3)])))


def random_throws(seed: int, count: int, changes: dict[str, Any], step: float) -> list[Mission]:
    """Vehicles at 2 to 10 m/s towards posts, edges, low and long walls and corners, in any attitude, touching none."""
    rng, found = np.random.default_rng(seed), list[Mission]()
    vehicle = Vehicle.from_settings(thrown(changes).vehicle)
    for _ in range(count):
        way = rng.standard_normal(3)
        velocity = way * rng.uniform(2.0, 10.0) / np.linalg.norm(way)
        angles, walls = [*rng.uniform(-1.2, 1.2, 2), rng.uniform(-3.0, 3.0)], list[WallTable]()
        q = quaternion_from_euler(vec3(angles))
        pose = np.array([[0.0, 0.0, 0.0, *q]] * 2)
        while len(walls) < 6:
            one = random_wall(rng, 0.15 * velocity[:2])
            if len(walls) == 1 and rng.random() < 0.5:
                one = one.model_copy(update={"start": walls[0].end})  # a corner
            guards, beam = nearest(vehicle, [one], pose, 1)
            if guards > 0.4 and beam > 0.07 and math.dist(one.start, one.end) > 0.005:
                walls.append(one)
        table = [upright(w.start, w.end, w.top) for w in walls]
        start = {"initial.velocity": velocity.tolist(), "initial.rates": (2.0 * rng.standard_normal(3)).tolist()}
        found.append(thrown(changes | start | {"initial.euler": angles, "walls": table}, step=step))
    return found
