"""The path in space, with arrows where the person pushed, and the vehicle at a few instants.

An arrow starts where the push acts at its peak; its length is proportional to the force. The path's shadow lies on the
floor straight below it. Walls are transparent, and drawn before or behind the path as they are nearer to the reader or
farther away.
"""
# paper: fig5, b

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch, Patch

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, all_flights
from tandemlift.pictures.drawing.overlay import Flights, legend_of_flights, look
from tandemlift.pictures.drawing.panels import Mask, decimate, drawable, legend_above
from tandemlift.pictures.drawing.scene import NEAR, Scene3D, on_paper
from tandemlift.pictures.drawing.style import (
    BEHIND_TEXT,
    BLUE,
    DIM,
    EDGE,
    GLASS,
    GREY,
    INK,
    PAPER,
    VERMILLION,
    journal,
    points,
    styled,
)
from tandemlift.pictures.drawing.surroundings import WallOutline, draw_walls, walls_near
from tandemlift.pictures.drawing.vehicle import Skeleton, body_to_world, floor_height, skeleton

CAPTION = Caption(
    "Path",
    "The path of the centre of mass, with an arrow for each push of the person: it starts where the push acts at its "
    "peak, and its length is proportional to the force, which stands beside it. The vehicle is drawn to scale at a few "
    "instants, bold at the start and at the end. Dotted lines lead from the pushes straight down to the bottom of "
    "the box, where the path has its shadow; a floor that the vehicle can stand on is filled. Walls are transparent.",
    "Three-dimensional view of the flown path with an arrow for each push, the vehicle at a few instants, and the "
    "floor and walls if there are any.",
)
IN_FLIGHTS = all_flights

COUNT = 6  # vehicles drawn
SPACING = 1.2  # vehicle spans of path from one vehicle drawn to the next, at least
VISIBLE = 0.02  # of the longest side of the scene: a smaller vehicle would be a blot
MOST_NUMBERED = 12  # pushes: of more, only the longest has its size beside it
ARROW_RATIO = 0.13  # of the longest side of the scene: the longest arrow
DEPTH = 0.5  # of the longest side of the scene: a floor farther below is not drawn


class PushArrow(NamedTuple):
    """A push at the time of its peak: where it acted (3) [m] and its force (3) [N], world axes."""

    point: Array
    force: Array


def pushes(flight: Flight) -> list[PushArrow]:
    """The pushes whose peak lies within the time flown."""
    found = []
    for push in flight.mission.get("pushes", []):
        if not len(flight.time) or not flight.time[0] <= push["time"] <= flight.time[-1]:
            continue
        k = int(np.argmin(np.abs(flight.time - push["time"])))
        point = flight["position"][k] + body_to_world(flight["attitude"][k]) @ push["point"]
        found.append(PushArrow(point, np.array(push["force"])))
    return [p for p in found if np.isfinite(p.point).all() and p.force.any()]


def instants(path: Array, span: float) -> list[int]:
    """Samples at which to draw a vehicle of a span [m]: the first, the last, and some at even steps along the path."""
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    count = min(COUNT, 1 + int(way[-1] / (SPACING * span)))
    if count == 1:
        return [len(path) - 1] if way[-1] < span / 4.0 else [0, len(path) - 1]
    between = np.searchsorted(way, np.linspace(0.0, way[-1], count)[1:-1])
    return [0, *map(int, between), len(path) - 1]


def _draw_vehicle(scene: Scene3D, body: Skeleton, color: str, order: float) -> None:
    """Draw one vehicle: rotor discs, arms, struts and payload."""
    common: dict[str, Any] = {"zorder": order, "clip_on": False}
    discs = PolyCollection(list(on_paper(body.rotors)), facecolor=PAPER, edgecolor=color, lw=0.5, alpha=0.85, **common)
    bars = LineCollection(list(on_paper([*body.arms, *body.struts])), colors=color, lw=0.7, **common)
    scene.axes.add_collection(discs)
    scene.axes.add_collection(bars)
    look: dict[str, Any] = (
        {"lw": body.width(2.4), "solid_capstyle": "round"} if len(body.beam) > 1 else {"marker": "s", "ms": 4.0}
    )
    scene.line(body.beam, color=color, zorder=order, gid="payload", **look)


def _draw_pushes(scene: Scene3D, found: list[PushArrow], tips: Array) -> None:
    """Draw the arrows, each with a thin line down to the floor that shows where above it the push acted."""
    floor = scene.box[2, 0]
    look: dict[str, Any] = {
        "arrowstyle": "-|>,head_length=4,head_width=2",
        "mutation_scale": 1.0,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    sizes = [float(np.linalg.norm(push.force)) for push in found]
    numbered = sizes if len(sizes) <= MOST_NUMBERED else [max(sizes)]
    for push, tip, size in zip(found, tips, sizes, strict=True):
        scene.line(np.array([push.point, [*push.point[:2], floor]]), color=GREY, lw=0.5, ls=(0, (1, 2)), zorder=1)
        ends = on_paper([push.point, tip])
        arrow = FancyArrowPatch(*ends, color=VERMILLION, lw=1.6, zorder=40, clip_on=False, gid="push", **look)
        scene.axes.add_patch(arrow)
        if size in numbered:
            _number(scene, ends, size)


def _number(scene: Scene3D, ends: Array, newtons: float) -> None:
    """Write the size of a push beside the middle of its arrow (2, 2) [m on paper], above it, or left of an upright."""
    way = np.diff(ends, axis=0)[0]
    aside = np.array([-way[1], way[0]]) / max(float(np.hypot(*way)), 1e-12)
    aside *= 1.0 if aside[1] > 0.2 or (aside[1] > -0.2 and aside[0] < 0.0) else -1.0
    sides: dict[str, Any] = {"ha": "right" if aside[0] < -0.3 else "left" if aside[0] > 0.5 else "center"}
    sides["va"] = "bottom" if aside[1] > 0.4 else "center"
    look: dict[str, Any] = {
        "textcoords": "offset points",
        "annotation_clip": False,
        "fontsize": points(7.5),
        "zorder": 43,
        "bbox": BEHIND_TEXT,
    }
    scene.axes.annotate(f"{newtons:.3g} N", ends.mean(axis=0), tuple(3.5 * aside), color=VERMILLION, **sides, **look)


def _legend(scene: Scene3D, found: list[PushArrow], walls: list[WallOutline], handles: list[Any]) -> None:
    labels = ["path", "its shadow on the floor" if scene.stands else "its shadow", "start", "end"]
    if found:
        handles = [*handles, Line2D([], [], color=VERMILLION, lw=1.6, marker=">", ms=4)]
        labels.append("push")
    if walls:
        handles = [*handles, Patch(facecolor=GLASS, edgecolor=EDGE, lw=0.6)]
        labels.append("wall")
    legend_above(scene.figure, handles, labels, "upper left")


def _draw_path(scene: Scene3D, path: Array, look: dict[str, Any]) -> list[Any]:
    """Draw the path (T, 3) [m] with a look, its shadow, start and end; returns the handles for the legend."""
    thin = path[decimate(path)]
    shadow = np.column_stack([thin[:, :2], np.full(len(thin), scene.box[2, 0])])
    ends: dict[str, Any] = {"color": look["color"], "mfc": PAPER, "ms": 4, "ls": "none", "zorder": 41}
    return [
        scene.line(thin, zorder=3, gid="path", **look),
        scene.line(shadow, color=GREY, lw=0.8, zorder=1),
        scene.line(path[:1], marker="o", **ends),
        scene.line(path[-1:], marker="s", **ends),
    ]


def _floor(flight: Flight, around: Array) -> float | None:
    """Height of the floor [m] if there is one not far below the points (n, 3) that are shown."""
    height = floor_height(flight)
    return height if height is not None and around[:, 2].min() - height < DEPTH * np.ptp(around, axis=0).max() else None


def _sound(flight: Flight) -> Mask:
    """The samples (T) whose position and attitude can be drawn."""
    rotations = np.abs(np.linalg.norm(flight["attitude"], axis=1) - 1.0) < 0.01  # false for NaN
    return np.isfinite(drawable(flight["position"])).all(axis=1) & rotations


@styled
def draw_paths(flights: Flights) -> Figure:
    """Draw the paths [m, world axes] of several flights, with shadow, start and end, among the first one's walls."""
    first, paths = next(iter(flights.values())), [flight["position"][_sound(flight)] for flight in flights.values()]
    around = np.concatenate([*paths, np.zeros((0 if any(map(len, paths)) else 1, 3))])
    reach = np.concatenate([around, *(wall.rim for wall in walls_near(first.walls, around))])
    scene = Scene3D(reach, _floor(first, around))
    for place, path in enumerate(paths):
        if len(path):
            _draw_path(scene, path, look(place))
    draw_walls(scene, first.walls, around)
    legend_of_flights(scene.figure, flights, "upper left")
    return scene.figure


OVERLAY = draw_paths


@journal
def draw(flight: Flight) -> Figure:
    """Draw the path [m, world axes] with the pushes and the vehicle."""
    sound = _sound(flight)
    path, attitudes = flight["position"][sound], flight["attitude"][sound]
    body = skeleton(flight.vehicle)
    span = float(np.ptp(body.points, axis=0).max())
    visible = len(path) and span > VISIBLE * np.ptp(path, axis=0).max()
    shown = instants(path, span) if visible else []
    vehicles = [body.placed(path[k], attitudes[k]) for k in shown]
    around = np.concatenate([path, *(v.points for v in vehicles)]) if len(path) else body.points
    found = pushes(flight)
    per_newton = ARROW_RATIO * np.ptp(around, axis=0).max() / max([np.linalg.norm(p.force) for p in found], default=1.0)
    tips = np.array([p.point + per_newton * p.force for p in found]).reshape(-1, 3)
    around = np.concatenate([around, tips])

    tables = flight.walls
    reach = np.concatenate([around, *(wall.rim for wall in walls_near(tables, around))])
    scene = Scene3D(reach, _floor(flight, around))
    handles = _draw_path(scene, path, {"color": BLUE, "lw": 1.3})
    for order, k in enumerate(sorted(range(len(shown)), key=lambda k: float(path[shown[k]] @ NEAR))):
        _draw_vehicle(scene, vehicles[k], INK if shown[k] in (0, len(path) - 1) else DIM, 4.0 + order)
    _draw_pushes(scene, found, tips)
    walls = draw_walls(scene, tables, path if len(path) else around)
    _legend(scene, found, walls, handles)
    return scene.figure
