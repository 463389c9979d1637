"""The vehicle to scale with its sizes and masses: two quadrotors above the ends of a beam."""
# paper: fig5, a

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tandemlift.figures.diagrams.canvas import WIDTH, Canvas, Point
from tandemlift.figures.diagrams.solids import VehicleView, draw_axes, draw_beam, draw_quadrotor, draw_strut
from tandemlift.figures.drawing.figure import Caption
from tandemlift.figures.drawing.style import DIM, VERMILLION, styled
from tandemlift.vehicle import Vehicle

CAPTION = Caption(
    "The vehicle to scale",
    "The quadrotors are rigidly fixed above the ends of the beam. The cross marks the centre of mass of the whole "
    "vehicle. Rings in blue turn the quadrotor about +z, rings in red about −z.",
    "The vehicle seen from the front right and above, with its lengths and masses.",
)

HEIGHT = 3.05  # in
SIDE_STEP = np.array([0.0, -0.34])  # in, from what is measured to its line of dimension


def _dimension(canvas: Canvas, ends: tuple[Point, Point], offset: Point, words: str, beside: Point) -> None:
    """A line of dimension with an arrow at either end, and words beside its middle."""
    start, end = ends
    a, b = np.asarray(start) + offset, np.asarray(end) + offset
    for point, moved in ((start, a), (end, b)):
        canvas.line([point, moved + 0.12 * np.asarray(offset)], color=DIM, lw=0.5)
    middle = (a + b) / 2.0
    canvas.arrow(middle, a, color=DIM, lw=0.8)
    canvas.arrow(middle, b, color=DIM, lw=0.8)
    canvas.text(middle + beside, words, fontsize=8)


def _masses(canvas: Canvas, view: VehicleView, vehicle: Vehicle) -> None:
    for i, quadrotor in enumerate(vehicle.quadrotors, 1):
        place = np.add(view.on_paper(quadrotor.position), (0.0, 0.68))
        above = f"{1e3 * quadrotor.position[2]:g} mm above the beam's axis"
        canvas.text(place, f"quadrotor {i}: {quadrotor.mass:g} kg,\n{above}", fontsize=8)


@styled
def draw(mission: Mapping[str, Any]) -> Figure:
    """Draw a mission's vehicle with its sizes."""
    vehicle = Vehicle.from_mission(mission)
    canvas = Canvas(HEIGHT)
    view = VehicleView(np.radians(24.0), np.radians(24.0), 2.5, (WIDTH / 2.0, 1.5))
    draw_beam(canvas, view, vehicle)
    for number, quadrotor in enumerate(vehicle.quadrotors):
        draw_strut(canvas, view, vehicle, number)
        draw_quadrotor(canvas, view, vehicle, number, quadrotor.position)
    _masses(canvas, view, vehicle)
    if vehicle.beam:
        half, radius = vehicle.beam[0] / 2.0, vehicle.beam[1]
        ends = view.on_paper((0.0, -half, -radius)), view.on_paper((0.0, half, -radius))
        words = f"beam: {vehicle.payload.mass:g} kg, length {2.0 * half:g} m, radius {radius:g} m"
        _dimension(canvas, ends, SIDE_STEP, words, (-0.9, -0.12))
    _arm(canvas, view, vehicle)
    centre = view.on_paper(vehicle.center_of_mass)
    canvas.axes.plot(*centre, marker="x", ms=6, mew=1.6, color=VERMILLION, zorder=15)
    words = f"centre of mass: {vehicle.mass:g} kg, {1e3 * vehicle.center_of_mass[2]:.1f} mm above the beam's axis"
    canvas.text((WIDTH / 2.0 + 0.2, HEIGHT - 0.25), words, fontsize=8, color=VERMILLION)
    canvas.line([(WIDTH / 2.0, HEIGHT - 0.36), np.add(centre, (0.0, 0.07))], color=VERMILLION, lw=0.5)
    draw_axes(canvas, view._replace(origin=(0.55, 0.42)), (0.0, 0.0, 0.0), 0.2, ("$x$", "$y$", "$z$"))
    return canvas.figure


def _arm(canvas: Canvas, view: VehicleView, vehicle: Vehicle) -> None:
    """The arm of the first quadrotor that points most to the right."""
    place, hubs = np.array(vehicle.quadrotors[0].position), np.array(vehicle.rotor_hubs[0])
    across = int(np.argmax(hubs @ view.directions[0]))
    ends = view.on_paper(place), view.on_paper(place + hubs[across])
    length = float(np.linalg.norm(hubs[across][:2]))
    _dimension(canvas, ends, np.array([0.1, -0.52]), f"arm {length:g} m", (0.05, -0.15))
