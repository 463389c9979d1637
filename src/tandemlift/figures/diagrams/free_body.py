"""The free bodies of the vehicle: payload and quadrotors apart, each with the forces and moments that act on it."""
# paper: fig1

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tandemlift.common.types import Array
from tandemlift.figures.diagrams.canvas import WIDTH, Canvas
from tandemlift.figures.diagrams.solids import VehicleView, draw_axes, draw_beam, draw_quadrotor
from tandemlift.figures.drawing.figure import Caption
from tandemlift.figures.drawing.style import BLUE, DIM, GREEN, GREY, INK, VERMILLION, styled
from tandemlift.vehicle import Vehicle

CAPTION = Caption(
    "Free bodies",
    "Payload and quadrotors, drawn apart, with the forces and moments on each: rotor thrusts, weights, and the joint's "
    "force and torque, which act on quadrotor and payload in opposite directions. The person's push acts on the "
    "payload. Rings in blue turn the quadrotor about +z, rings in red about −z.",
    "A beam below two quadrotors, with arrows for rotor thrusts, weights, joint forces, joint torques and the push.",
)

APART = 0.66  # m by which the quadrotors are raised above their place
UP, OUT = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
BELOW = 0.03  # m below a quadrotor's centre, where the joint holds it
HEIGHT = 4.35  # in


def joint_force(side: float) -> Array:
    """The force of a joint on the payload as it is drawn (3): upward, and inward from its end of the beam."""
    return 0.36 * UP - 0.2 * side * OUT


def _force(
    canvas: Canvas, view: VehicleView, at: Any, along: Any, name: str, color: str, offset: Any = (0.0, 0.1)
) -> None:
    """An arrow that acts at a point, and its name beside its tip."""
    start = view.on_paper(at)
    tip = start + view.along(along)
    canvas.arrow(start, tip, color=color, lw=1.5)
    canvas.text(tip + np.asarray(offset), name, color=color)


def _quadrotor(canvas: Canvas, view: VehicleView, vehicle: Vehicle, number: int) -> None:
    """A quadrotor above its place, with its loads."""
    i = number + 1
    centre = np.array(vehicle.quadrotors[number].position) + APART * UP
    draw_quadrotor(canvas, view, vehicle, number, centre)
    for j, hub in enumerate(centre + np.array(vehicle.rotor_hubs[number]), 1):
        _force(canvas, view, hub, 0.26 * UP, f"$f_{{{j}{i}}}$", BLUE)
    side = np.sign(centre[1]) or 1.0
    _force(canvas, view, centre, -0.36 * UP, f"$m_{i} g$", GREY, (0.0, -0.11))
    _force(canvas, view, centre - BELOW * UP, -joint_force(side), f"$-F_{i}$", VERMILLION, (0.14 * side, -0.1))
    spot = view.on_paper(centre - 0.17 * UP)
    canvas.turn(spot, (-0.15, 0.0), (0.0, 0.055), color=GREEN, lw=1.2)
    canvas.text(np.add(spot, (-0.36 * side, -0.02)), rf"$-\tau_{i}$", color=GREEN)
    canvas.text(np.add(view.on_paper(centre), (0.0, 1.12)), f"quadrotor {i}", fontsize=8, color=DIM)


def _joint(canvas: Canvas, view: VehicleView, place: Array, i: int) -> None:
    """The loads of joint i on the payload, and the lever arm to it."""
    side = np.sign(place[1]) or 1.0
    foot = np.array([0.0, place[1], 0.0])
    _force(canvas, view, foot, joint_force(side), f"$F_{i}$", VERMILLION, (-0.14 * side, 0.06))
    canvas.turn(view.on_paper(foot + 0.17 * UP), (0.15, 0.0), (0.0, 0.055), color=GREEN, lw=1.2)
    canvas.text(np.add(view.on_paper(foot + 0.17 * UP), (0.3 * side, 0.0)), rf"$\tau_{i}$", color=GREEN)
    canvas.arrow(view.on_paper((0.0, 0.0, 0.0)), view.on_paper(place), color=INK, lw=0.8, linestyle=(0, (4, 2)))
    canvas.text(np.add(view.on_paper(0.55 * place), (0.0, 0.24)), f"$d_{i}$")
    start, end = view.on_paper(place), view.on_paper(place + APART * UP)
    canvas.line([start, end], color=GREY, lw=0.6, ls=(0, (1, 2)), zorder=1)


@styled
def draw(mission: Mapping[str, Any]) -> Figure:
    """Draw the free bodies of a mission's vehicle."""
    vehicle = Vehicle.from_mission(mission)
    canvas = Canvas(HEIGHT)
    view = VehicleView(np.radians(20.0), np.radians(21.0), 2.25, (WIDTH / 2, 1.2))
    draw_beam(canvas, view, vehicle)
    for number, quadrotor in enumerate(vehicle.quadrotors):
        _joint(canvas, view, np.array(quadrotor.position), number + 1)
        _quadrotor(canvas, view, vehicle, number)
    _force(canvas, view, (0.0, 0.0, 0.0), -0.36 * UP, "$m_L g$", GREY, (0.0, -0.1))
    push = np.array([0.7, 0.0, 0.0])
    hand = np.add(push, (0.0, -0.42, 0.0))
    _force(canvas, view, hand, -push, "", VERMILLION)
    canvas.text(np.add(view.on_paper(hand), (0.0, -0.12)), "push $F_{ext}$", color=VERMILLION)
    draw_axes(canvas, view, (0.0, 0.0, 0.0), 0.34, ("$x_L$", "$y_L$", "$z_L$"))
    canvas.text(view.on_paper((0.0, 0.62, 0.0)) - [0.0, 0.3], "payload: a beam along $y_L$", fontsize=8, color=DIM)
    world = view._replace(origin=(0.62, 0.45))
    draw_axes(canvas, world, (0.0, 0.0, 0.0), 0.24, ("$X$", "$Y$", "$Z$"))
    canvas.text((0.62, 0.27), "$O$", fontsize=8)
    return canvas.figure
