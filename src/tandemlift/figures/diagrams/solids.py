"""A vehicle as solid shapes on paper, seen from a direction: its beam, its quadrotors with arms, rotors and struts.

Everything has the size and the place that the mission's `vehicle` table gives it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.patches import Polygon

from tandemlift.common.types import Array
from tandemlift.figures.diagrams.canvas import Canvas
from tandemlift.figures.drawing.style import BLUE, DIM, EDGE, GROUND, INK, LIGHT_BLUE, TAN, VERMILLION
from tandemlift.vehicle import Vehicle

CORNERS = 72
OUTLINE: dict[str, Any] = {"edgecolor": EDGE, "lw": 0.7, "joinstyle": "round"}
DISC = 0.45  # opacity of a rotor
HUB = 0.035  # m, radius of a motor
BODY = 0.075  # m, radius of a quadrotor's body
SPIN_COLORS = {1: BLUE, -1: VERMILLION}


class VehicleView(NamedTuple):
    """A parallel projection: the eye's azimuth and elevation [rad], inches for a metre, the origin's place [in]."""

    azimuth: float
    elevation: float
    scale: float
    origin: tuple[float, float]

    @property
    def directions(self) -> Array:
        """To the right, upward and towards the eye (3, 3), body axes."""
        a, e = self.azimuth, self.elevation
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        near = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        return np.array([right, np.cross(near, right), near])

    def on_paper(self, points: Any) -> Array:
        """Points (…, 3) [m, body axes] on paper (…, 2) [in]."""
        return np.asarray(points) @ self.directions[:2].T * self.scale + np.array(self.origin)

    def along(self, vector: Any) -> Array:
        """A direction and length (3) [m] on paper (2) [in]."""
        return self.on_paper(vector) - np.array(self.origin)


def _ring(centre: Any, radius: float, normal: int) -> Array:
    """Points (n, 3) of a circle about a centre [m], across one of the body axes."""
    turn = np.linspace(0.0, 2.0 * np.pi, CORNERS)
    points = np.zeros((CORNERS, 3))
    points[:, (normal + 1) % 3], points[:, (normal + 2) % 3] = np.cos(turn), np.sin(turn)
    return np.asarray(centre) + radius * points


def _hull(points: Array) -> Array:
    """The corners of the convex hull of points (n, 2), in order (Andrew's monotone chain)."""
    ordered = sorted(map(tuple, points))

    def chain(given: Any) -> list[Any]:
        kept: list[Any] = []
        for p in given:
            while len(kept) > 1 and _left_of(kept[-2], kept[-1], p) <= 0.0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return np.array(chain(ordered) + chain(reversed(ordered)))


def _left_of(a: Any, b: Any, c: Any) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _fill(canvas: Canvas, points: Array, color: Any, order: float, **look: Any) -> None:
    canvas.axes.add_patch(Polygon(points, closed=True, facecolor=color, zorder=order, **{**OUTLINE, **look}))


def _bar(canvas: Canvas, view: VehicleView, start: Any, end: Any, order: float) -> None:
    canvas.line(view.on_paper([start, end]), color=DIM, lw=2.6, zorder=order)


def draw_beam(
    canvas: Canvas, view: VehicleView, vehicle: Vehicle, centre: Any = (0.0, 0.0, 0.0), order: float = 2.0
) -> None:
    """Draw the beam about a centre (3) [m]; a payload without a length is a ball."""
    length, radius = vehicle.beam or (0.0, 0.1)
    half = np.array([0.0, length / 2.0, 0.0])
    ends = [view.on_paper(_ring(np.asarray(centre) + s * half, radius, 1)) for s in (1.0, -1.0)]
    _fill(canvas, _hull(np.concatenate(ends)), TAN, order, alpha=0.75)
    nearer = ends[0] if view.directions[2][1] > 0.0 else ends[1]
    _fill(canvas, nearer, GROUND, order + 0.1)


def draw_quadrotor(
    canvas: Canvas, view: VehicleView, vehicle: Vehicle, number: int, centre: Any, order: float = 3.0
) -> None:
    """Draw quadrotor `number` (from 0) about its centre of mass (3) [m]: body, arms, rotors with their sense."""
    quadrotor = vehicle.quadrotors[number]
    middle = np.asarray(centre, dtype=float)
    hubs = middle + np.array(vehicle.rotor_hubs[number])
    for hub in hubs:
        _bar(canvas, view, middle, hub * [1.0, 1.0, 0.0] + middle * [0.0, 0.0, 1.0], order)
    top = middle + np.array([0.0, 0.0, 0.03])
    body = np.concatenate([view.on_paper(_ring(c, BODY, 2)) for c in (middle, top)])
    _fill(canvas, _hull(body), EDGE, order + 0.1)
    far_first = sorted(zip(hubs, quadrotor.spins, strict=True), key=lambda one: float(one[0] @ view.directions[2]))
    for k, (hub, spin) in enumerate(far_first):
        post = np.concatenate([view.on_paper(_ring(hub - [0.0, 0.0, 0.02], HUB, 2)), view.on_paper(_ring(hub, HUB, 2))])
        disc = view.on_paper(_ring(hub, quadrotor.rotor_radius, 2))
        _fill(
            canvas, disc, (LIGHT_BLUE, DISC), order + 0.2 + 0.01 * k, lw=0.8, edgecolor=SPIN_COLORS[int(np.sign(spin))]
        )
        _fill(canvas, _hull(post), EDGE, order + 0.205 + 0.01 * k)


def draw_strut(canvas: Canvas, view: VehicleView, vehicle: Vehicle, number: int, order: float = 2.5) -> None:
    """Draw the strut between the beam (its centre is the origin) and quadrotor `number`."""
    place = np.array(vehicle.quadrotors[number].position)
    foot = np.array([0.0, place[1], 0.0])
    _bar(canvas, view, foot, place, order)


def draw_axes(
    canvas: Canvas, view: VehicleView, origin: Any, size: float, names: tuple[str, str, str], **look: Any
) -> None:
    """Draw three axes of a length [m] from a point (3) [m], with their names."""
    start = view.on_paper(origin)
    for axis, name in zip(np.eye(3), names, strict=True):
        reach = view.along(size * axis)
        canvas.arrow(start, start + reach, **{"lw": 0.9, "zorder": 12, **look})
        beside = reach + 0.11 * reach / np.linalg.norm(reach)
        canvas.text(start + beside, name, color=look.get("color", INK), fontsize=8)
