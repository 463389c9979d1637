"""The room that walls leave a vehicle: the widest path through, for any pilot and person.

Level, a vehicle with two quadrotors is a place and a heading. On a grid of these the clearance of guards and beam from
all walls is known; the most that some connected way from the start to the end keeps everywhere is the bound.

    python benchmarks/room.py
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label, map_coordinates

import tandemlift as tl
from tandemlift.parts.contact.corridor import sides
from tandemlift.parts.mechanics.vehicle import Vehicle

Array = NDArray[np.float64]

CELL, TURNS = 0.05, 72  # m, headings in half a turn: turned by half a turn it is the same
AROUND = 4.0  # m, beyond the walls, and of what keeps the way from leading around a corridor
MISSIONS = ("zigzag", "narrow", "narrow-zigzag", "doorway")


def walls_of(mission: tl.Mission) -> list[tuple[Array, Array]]:
    """The walls (start, end) [m], with others that lead away from a corridor's open ends."""
    found = [(np.array(w.start), np.array(w.end)) for w in mission.all_walls]
    if mission.corridor.centreline:
        left, right = sides(mission.corridor.centreline, mission.corridor.width)
        for i in (0, -1):
            out = (left[i] - right[i]) / mission.corridor.width * AROUND
            found += [(left[i], left[i] + out), (right[i], right[i] - out)]
    return found


def field(walls: list[tuple[Array, Array]], low: Array, high: Array) -> Array:
    """Distance to the nearest wall [m] on a grid of places."""
    x, y = (np.arange(a, b, CELL) for a, b in zip(low, high, strict=True))
    X, Y = np.meshgrid(x, y, indexing="ij")
    far = np.full(X.shape, np.inf)
    for start, end in walls:
        along = end - start
        share = np.clip(((X - start[0]) * along[0] + (Y - start[1]) * along[1]) / (along @ along), 0.0, 1.0)
        far = np.minimum(far, np.hypot(X - start[0] - share * along[0], Y - start[1] - share * along[1]))
    return far


def room(mission: tl.Mission, heading: float | None = None) -> float:
    """The most clearance [m] that a way from the mission's start to the last waypoint can keep everywhere.

    Args:
        mission: with walls about a vehicle of two quadrotors on a beam along body y.
        heading: [rad] to keep all the way; any, if None.
    """
    vehicle = Vehicle.from_settings(mission.vehicle)
    path = [w.point for w in mission.person.path] or list(mission.corridor.centreline)
    start, end = np.array(mission.initial.position[:2]), np.array(path[-1])
    walls = walls_of(mission)
    corners = np.array([start, end, *(p for ends in walls for p in ends)])
    low, high = corners.min(axis=0) - np.array([AROUND, 0.0]), corners.max(axis=0) + np.array([AROUND, 0.0])
    far = field(walls, low, high)
    headings = np.arange(TURNS) * np.pi / TURNS if heading is None else np.array([heading])
    cells = np.indices(far.shape)
    clear = np.full((len(headings), *far.shape), np.inf)
    guard, half = mission.vehicle.quadrotors[0].guard_radius, mission.vehicle.payload.length / 2.0
    reach = float(np.abs(vehicle.lever_arms[:, 1]).max())
    parts = [(s * reach, guard) for s in (-1.0, 1.0)]
    parts += [(s, mission.vehicle.payload.radius) for s in np.linspace(-half, half, 41)]
    for own, psi in zip(clear, headings, strict=True):
        for along, radius in parts:
            places = [cells[0] - along * np.sin(psi) / CELL, cells[1] + along * np.cos(psi) / CELL]
            np.minimum(own, map_coordinates(far, places, order=1, cval=-1.0) - radius, out=own)
    at = [tuple(np.round((p - low) / CELL).astype(int)) for p in (start, end)]
    least, most = -0.4, 3.0
    while most - least > 0.002:
        middle = (least + most) / 2.0
        if _connected(clear >= middle, at):
            least = middle
        else:
            most = middle
    return least


def _connected(free: NDArray[np.bool_], at: list[tuple[int, ...]]) -> bool:
    """Whether free cells join the start with the end, in whatever heading; the last heading is next to the first."""
    again = np.concatenate([free, free[:1]]) if len(free) > 1 else free
    names, _ = label(again, structure=np.ones((3, 3, 3)))
    parent = {int(n): int(n) for n in np.unique(names)}

    def root(n: int) -> int:
        while parent[n] != n:
            n = parent[n]
        return n

    for a, b in {(int(a), int(b)) for a, b in zip(names[0].ravel(), names[-1].ravel(), strict=True) if a and b}:
        parent[root(a)] = root(b)
    ends = [{root(int(n)) for n in names[(slice(None), *cell)] if n} for cell in at]
    return bool(ends[0] & ends[1])


if __name__ == "__main__":
    for name in sys.argv[1:] or MISSIONS:
        mission = tl.load_mission(name)
        kept = room(mission, mission.initial.euler[2])
        print(f"{name:14s} any heading {room(mission):6.3f} m, as it starts {kept:6.3f} m", flush=True)
