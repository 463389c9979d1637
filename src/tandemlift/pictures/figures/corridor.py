"""View from above of the path among walls, with the vehicle and the person's pushes; below, the clearance.

The vehicle is drawn to scale at equal distances: its beam, and its guards as circles. An arrow starts where the person
holds the payload at that time and has the direction and, to scale, the size of the horizontal push.
"""
# paper: fig9

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.clearances import clearances, grips
from tandemlift.pictures.drawing.figure import Caption, current_style, with_walls
from tandemlift.pictures.drawing.panels import decimate, drawable, extent, legend_above, line, value_ticks
from tandemlift.pictures.drawing.style import BEHIND_TEXT, BLUE, GREY, INK, VERMILLION, journal, page_figure, points
from tandemlift.pictures.drawing.vehicle import skeleton
from tandemlift.pictures.figures.path import pushes

CAPTION = Caption(
    "Walls and clearance",
    "Top: view from above of the walls, the path of the centre of mass and the path that the person was to follow, "
    "with the vehicle to scale at equal distances, bold at the start and at the end: its beam, and the guards around "
    "its quadrotors. Arrows show the horizontal push of the person at these instants; the largest has its "
    "size beside it. Bottom: distance of guards and "
    "beam from the nearest wall, over the distance flown, and its minimum; they touch a wall below zero.",
    "Two panels: view from above of walls, path, vehicle and pushes; clearance of guards and beam over the distance "
    "flown.",
)
IN_FLIGHTS = with_walls
OVERLAY = None  # vehicles and arrows of several flights would hide each other

MARGIN = 1.2  # m, shown around the path and the vehicle
SPACING = 1.1  # vehicle spans from one vehicle drawn to the next
MAX_VEHICLES, MAX_HEIGHT, MIN_HEIGHT = 14, 5.0, 1.5  # vehicles; in, of the view from above
LOWER_HEIGHT, FRAME_HEIGHT = 1.25, 0.75  # in: height of the lower panel, and of what is around them
NEWTON = 0.75  # m of the view, for a newton
MIN_PUSH = 0.05  # N: a weaker push is not drawn
BEAM: dict[str, Any] = {"color": VERMILLION, "lw": 1.0, "ls": (0, (5, 1.5))}


def instants(flight: Flight) -> list[int]:
    """Samples at which the vehicle is drawn: the first, the last, and some at equal distances."""
    path = flight["position"][:, :2]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    span = float(np.ptp(skeleton(flight.vehicle).points, axis=0).max())
    count = min(MAX_VEHICLES, 2 + int(way[-1] / (SPACING * span)))
    return sorted({0, *map(int, np.searchsorted(way, np.linspace(0.0, way[-1], count)[1:-1])), len(path) - 1})


def _vehicle(ax: Axes, flight: Flight, k: int, color: str) -> None:
    """Draw the vehicle of sample k from above: its beam and the guards about its quadrotors."""
    body = skeleton(flight.vehicle).placed(flight["position"][k], flight["attitude"][k])
    centers, vehicle = body.struts[:, 1, :2], flight.vehicle
    ax.add_collection(LineCollection([*body.arms[:, :, :2]], colors=color, lw=0.4, zorder=4))
    if len(body.beam) > 1:
        ax.plot(*body.beam[:, :2].T, color=color, lw=body.width(1.6), solid_capstyle="round", zorder=4)
    across = [2.0 * q.guard_radius for q in vehicle.quadrotors]
    rings = EllipseCollection(
        across,
        across,
        np.zeros(len(across)),
        units="xy",
        offsets=centers,
        transOffset=ax.transData,
        facecolor="none",
        edgecolor=color,
        lw=0.6,
        zorder=4,
    )
    ax.add_collection(rings)


def arrows(flight: Flight, shown: list[int]) -> list[tuple[Array, Array]]:
    """(start (2) [m], horizontal force (2) [N]) of the pushes to be drawn."""
    held = grips(flight)
    if held is None:
        return [(p.point[:2], p.force[:2]) for p in pushes(flight)]
    found = [(held[k, :2], flight["push_force"][k, :2]) for k in shown]
    return [(point, force) for point, force in found if np.linalg.norm(force) > MIN_PUSH]


def _pushes(ax: Axes, found: list[tuple[Array, Array]]) -> None:
    look: dict[str, Any] = {
        "arrowstyle": "-|>,head_length=3,head_width=1.6",
        "mutation_scale": 1.0,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    for point, force in found:
        ends = (tuple(point), tuple(point + NEWTON * force))
        ax.add_patch(FancyArrowPatch(*ends, color=VERMILLION, lw=1.2, zorder=6, gid="push", **look))
    if found:
        point, force = max(found, key=lambda push: float(np.linalg.norm(push[1])))
        sides: dict[str, Any] = {
            "ha": "left" if force[0] >= 0.0 else "right",
            "va": "bottom" if force[1] >= 0.0 else "top",
        }
        text, (x, y) = f"{np.linalg.norm(force):.3g} N", point + NEWTON * force
        ax.annotate(text, (x, y), color=VERMILLION, fontsize=points(7.5), zorder=7, bbox=BEHIND_TEXT, **sides)


def _desired(flight: Flight) -> Array:
    """The corners (n, 2) of the path that the person was to follow [m]; none without one."""
    person, corridor = flight.mission.get("person", {}), flight.mission.get("corridor", {})
    own = [w["point"] for w in person.get("path", [])] or corridor.get("centreline", [])
    return np.array(own if person.get("model", "none") not in ("none", "virtual-hand") else []).reshape(-1, 2)


def _bounds(flight: Flight, shown: list[int]) -> Array:
    """Lowest and highest x and y (2, 2) [m] of the view."""
    body = skeleton(flight.vehicle)
    seen = [body.placed(flight["position"][k], flight["attitude"][k]).points[:, :2] for k in shown]
    points = np.concatenate([*seen, flight["position"][:, :2]])
    return np.array([points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN])


def _from_above(ax: Axes, flight: Flight, shown: list[int], found: list[tuple[Array, Array]]) -> None:
    for w in flight.walls:
        ax.plot(*np.array([w["start"], w["end"]]).T, color=INK, lw=1.6, solid_capstyle="round", zorder=3, gid="wall")
    ax.plot(*_desired(flight).T, color=GREY, lw=0.7, ls=(0, (4, 3)), zorder=1, gid="desired")
    for k in shown:
        _vehicle(ax, flight, k, INK if k in (shown[0], shown[-1]) else GREY)
    path = flight["position"][:, :2]
    ax.plot(*path[decimate(path)].T, color=BLUE, lw=1.2, zorder=5, gid="path")
    _pushes(ax, found)
    ax.set_aspect("equal")
    ax.set_xlabel("$x$ (m)")
    ax.set_ylabel("$y$ (m)")


def _clearance(ax: Axes, flight: Flight) -> None:
    """The clearances over the distance flown; a dot at the smallest."""
    path, far = flight["position"][:, :2], clearances(flight)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    known = [(far.guards, {"color": BLUE, "lw": 1.2})] + ([] if far.beam is None else [(far.beam, BEAM)])
    for values, look in known:
        line(ax, way, values, zorder=3, **look)
    least, k = min((float(np.nanmin(v)), int(np.nanargmin(v))) for v, _ in known)
    ax.plot(way[k], least, marker="o", ms=3.5, color=INK, zorder=4, gid="least")
    text = f"{least:.2f} m"
    right = way[k] < 0.85 * way[-1]
    offset, side = ((5, -3), "left") if right else ((-5, -3), "right")
    ax.annotate(text, (way[k], least), offset, textcoords="offset points", ha=side, va="top", fontsize=points(7.5))
    high = 1.08 * min(extent(*[v for v, _ in known])[1], 4.0 * max(least, 0.3))
    ax.set_ylim(min(0.0, least) - 0.12 * high, high)
    ax.yaxis.set_major_locator(value_ticks())
    ax.axhline(0.0, color=INK, lw=1.2, zorder=2)
    ax.set_xlim(-0.012 * max(way[-1], 0.1), max(way[-1], 0.1))
    ax.set_xlabel("distance flown (m)")
    ax.set_ylabel("clearance (m)")


@journal
def draw(flight: Flight) -> Figure:
    """Draw the path from above [m] with the pushes [N], and the clearance [m] over the distance flown."""
    keep = np.isfinite(drawable(np.column_stack([flight["position"], flight["attitude"]]))).all(axis=1)
    flight = Flight(
        flight.time[keep], {n: v[keep] for n, v in flight.channels.items()}, flight.mission, {}, flight.ending
    )
    shown = instants(flight)
    found, (low, high) = arrows(flight, shown), _bounds(flight, shown)
    size = high - low
    tall = float(np.clip((current_style().page - 0.5) * size[1] / size[0], MIN_HEIGHT, MAX_HEIGHT))
    figure = page_figure(tall + LOWER_HEIGHT + FRAME_HEIGHT)
    above, below = figure.subplots(2, 1, height_ratios=[tall, LOWER_HEIGHT])
    _from_above(above, flight, shown, found)
    above.set_xlim(low[0], high[0])
    above.set_ylim(low[1], high[1])
    _clearance(below, flight)
    handles: list[Any] = [
        Line2D([], [], color=INK, lw=1.6),
        Line2D([], [], color=BLUE, lw=1.2),
        Line2D([], [], color=GREY, lw=0.7, ls=(0, (4, 3))),
        Line2D([], [], color=VERMILLION, lw=1.2, marker=">", ms=3.5),
        Line2D([], [], **BEAM),
    ]
    names = ["wall", "centre of mass; guards", "desired path", f"push (1 N: {NEWTON:g} m)", "beam"]
    legend_above(figure, handles, names)
    return figure
