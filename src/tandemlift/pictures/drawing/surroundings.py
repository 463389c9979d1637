"""The walls in a scene: those near the displayed points, cut off beyond them, and transparent; and the floor."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from matplotlib.collections import LineCollection

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.parts.contact.surroundings import WallTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.scene import NEAR, Scene3D, on_paper
from tandemlift.pictures.drawing.style import EDGE, GLASS
from tandemlift.pictures.drawing.vehicle import body_to_world

RANGE_MARGIN = 0.15  # of the longest side of the displayed points: range around them in which walls are drawn
EDGE_TOLERANCE = 1e-6  # m: a wall on the box's edge is in it
PARTS = 4  # of a wall in a cell of the grid: each stands before the path or behind it
OPACITY = 0.4
BACK_ORDER, FRONT_ORDER = 2.0, 42.0  # in the order of drawing, in which the path and all on it come between


class WallOutline(NamedTuple):
    """A wall as it is drawn: its rim from end to end (2, 3) [m, world axes], and which of the ends are its own."""

    rim: Array
    ends: tuple[bool, bool]


def _cut(start: Array, end: Array, low: Array, high: Array) -> tuple[float, float] | None:
    """The first and last share of the way from start to end (2) that lies in a rectangle, or None."""
    # Liang and Barsky, A new concept and method for line clipping, ACM Transactions on Graphics 3 (1984)
    along = end - start
    if np.any((along == 0.0) & ((start < low) | (start > high))):
        return None
    moving = along != 0.0
    sides = np.array([(low - start)[moving] / along[moving], (high - start)[moving] / along[moving]]).reshape(2, -1)
    first = max(0.0, *sides.min(axis=0)) if moving.any() else 0.0
    last = min(1.0, *sides.max(axis=0)) if moving.any() else 1.0
    return (float(first), float(last)) if first <= last else None


def walls_in(tables: Sequence[Mapping[str, Any]], low: Array, high: Array) -> list[WallOutline]:
    """The walls of a mission as far as they are in a box with a lowest and a highest corner (3) [m, world axes]."""
    found = []
    for table in map(WallTable.model_validate, tables):
        start, end = np.array(table.start), np.array(table.end)
        shares = _cut(start, end, low[:2] - EDGE_TOLERANCE, high[:2] + EDGE_TOLERANCE)
        if shares is not None and table.top > low[2]:
            points = start + np.outer(shares, end - start)
            rim = np.column_stack([points, np.full(2, min(table.top, high[2]))])
            found.append(WallOutline(rim, (shares[0] == 0.0, shares[1] == 1.0)))
    return found


def walls_near(tables: Sequence[Mapping[str, Any]], around: Array) -> list[WallOutline]:
    """The walls of a mission as far as they are near points (n, 3) [m, world axes]."""
    low, high = around.min(axis=0), around.max(axis=0)
    room = RANGE_MARGIN * float((high - low).max())
    return walls_in(tables, low - room, high + room)


def _stretches(wall: WallOutline, path: Array, cell: float) -> Iterator[tuple[bool, Array]]:
    """The stretches (2, 3) of a wall's rim that stand before the path (n, 3), or behind it, one after another."""
    length = float(np.linalg.norm(wall.rim[1] - wall.rim[0]))
    points = np.linspace(wall.rim[0], wall.rim[1], max(2, 1 + int(np.ceil(PARTS * length / cell))))
    middles = (points[1:] + points[:-1]) / 2.0
    nearest = [path[np.argmin(((path - middle)[:, :2] ** 2).sum(axis=1))] for middle in middles]
    before = ((middles - nearest)[:, :2] @ NEAR[:2] > 0.0).tolist()
    at = 0
    for nearer, group in groupby(before):
        size = len(list(group))
        yield nearer, points[[at, at + size]]
        at += size


def draw_walls(scene: Scene3D, tables: Sequence[Mapping[str, Any]], path: Array) -> list[WallOutline]:
    """Draw the walls in the scene's bounds, before the path (n, 3) [m, world axes] or behind it. Returns them."""
    walls, floor = walls_in(tables, *scene.bounds.T), scene.box[2, 0]
    thin = path[:: max(1, len(path) // 500)]
    for wall in walls:
        for nearer, rim in _stretches(wall, thin, scene.cell):
            foot = np.column_stack([rim[:, :2], np.full(2, floor)])
            order = FRONT_ORDER if nearer else BACK_ORDER
            scene.fill(np.concatenate([rim, foot[::-1]]), facecolor=GLASS, alpha=OPACITY, zorder=order, gid="wall")
            sides = [(rim[i], foot[i]) for i in (0, 1) if wall.ends[i] and np.array_equal(rim[i], wall.rim[i])]
            lines = list(on_paper([(rim[0], rim[1]), (foot[0], foot[1]), *sides]))
            scene.axes.add_collection(LineCollection(lines, colors=EDGE, lw=0.6, clip_on=False, zorder=order))
    return walls


# ---- The floor


def clearance(flight: Flight, height: float) -> Array:
    """The height of the lowest sole (T) over a floor at a height [m]."""
    soles = Vehicle.from_mission(flight.mission).soles.reshape(-1, 3)
    below = body_to_world(flight["attitude"])[:, 2] @ soles.T
    return flight["position"][:, 2] + below.min(axis=1) - height
