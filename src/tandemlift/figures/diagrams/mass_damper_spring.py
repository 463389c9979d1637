"""The admittance as a virtual mass with damper and spring, and what a steady push does to it."""
# paper: fig3

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from tandemlift.common.types import Array
from tandemlift.figures.diagrams.canvas import Canvas
from tandemlift.figures.drawing.figure import Caption
from tandemlift.figures.drawing.style import (
    BLUE,
    DIM,
    GREEN,
    GREY,
    INK,
    LIGHT_BLUE,
    PALE,
    PAPER,
    VERMILLION,
    points,
    styled,
)

CAPTION = Caption(
    "Virtual mass, damper and spring",
    "Left: the virtual mass is at T_r; damper and spring tie it to the desired trajectory T_d, and the push F_ext "
    "moves it in its own direction. Right: the answer of the x axis to a steady push of 1 N that ends after 3 s, with "
    "the mission's numbers. Without a spring, the reference stays where the push has left it.",
    "A block between a wall, a damper and a spring, with an arrow for the push; beside it, velocity and position of "
    "the block over time.",
)

HEIGHT = 2.25  # in
PUSHED, SHOWN = 3.0, 8.0  # s
STEP = 1e-3  # s


def response(mass: float, damping: float, stiffness: float) -> tuple[Array, Array, Array]:
    """Time [s], position [m] and velocity [m/s] under 1 N for `PUSHED` seconds, from rest; exact at each sample."""
    A = np.array([[0.0, 1.0, 0.0], [-stiffness / mass, -damping / mass, 1.0 / mass], [0.0, 0.0, 0.0]])
    E = np.eye(3)
    for k in range(12, 0, -1):  # the exponential of A STEP by Horner's scheme
        E = np.eye(3) + A @ E * (STEP / k)
    time = np.linspace(0.0, SHOWN, round(SHOWN / STEP) + 1)
    states = np.zeros((len(time), 3))
    for k, t in enumerate(time[:-1]):
        states[k, 2] = 1.0 if t < PUSHED - STEP / 2.0 else 0.0
        states[k + 1] = E @ states[k]
    return time, states[:, 0], states[:, 1]


def _spring(canvas: Canvas, start: float, end: float, y: float) -> None:
    x = np.linspace(start, end, 14)
    zigzag = np.array([0.0, 0.0, *([0.09, -0.09] * 5), 0.0, 0.0])
    canvas.line(np.column_stack([x, y + zigzag]), lw=1.0)


def _damper(canvas: Canvas, start: float, end: float, y: float) -> None:
    middle = (start + end) / 2.0
    canvas.line([(start, y), (middle - 0.16, y)])
    canvas.line([(middle + 0.2, y + 0.1), (middle - 0.16, y + 0.1), (middle - 0.16, y - 0.1), (middle + 0.2, y - 0.1)])
    canvas.line([(middle + 0.06, y + 0.075), (middle + 0.06, y - 0.075)], lw=1.6)
    canvas.line([(middle + 0.06, y), (end, y)])


def _mechanics(canvas: Canvas, numbers: tuple[float, float, float]) -> None:
    """The mass on its floor, tied to the place T_d."""
    mass, damping, stiffness = numbers
    wall, left, right, floor = 0.5, 1.75, 2.75, 0.62
    canvas.axes.add_patch(
        Rectangle((wall - 0.12, floor), 0.12, 1.1, facecolor=PALE, edgecolor=DIM, hatch="////", lw=0.0)
    )
    canvas.line([(wall, floor), (wall, floor + 1.1)], lw=1.2)
    canvas.line([(wall - 0.12, floor), (3.55, floor)], lw=1.0)
    canvas.axes.add_patch(
        Rectangle((left, floor + 0.1), right - left, 0.85, facecolor=(LIGHT_BLUE, 0.4), edgecolor=INK, lw=0.9)
    )
    for x in (left + 0.2, right - 0.2):
        canvas.axes.plot(x, floor + 0.05, "o", ms=6.5, mfc=PAPER, mec=INK, mew=0.9)
    canvas.text(((left + right) / 2, floor + 0.52), rf"$\mathbb{{M}}$ = {mass:g} kg")
    _damper(canvas, wall, left, floor + 0.76)
    _spring(canvas, wall, left, floor + 0.3)
    canvas.text(((wall + left) / 2, floor + 0.98), rf"$\mathbb{{C}}$ = {damping:g} N s/m", fontsize=8)
    canvas.text(((wall + left) / 2, floor + 0.11), rf"$\mathbb{{K}}$ = {stiffness:g} N/m", fontsize=8)
    canvas.arrow((right, floor + 0.52), (right + 0.6, floor + 0.52), color=VERMILLION, lw=1.8)
    canvas.text((right + 0.36, floor + 0.7), "$F_{ext}$", color=VERMILLION)
    for x, name, color in ((wall, "$T_d$", GREY), ((left + right) / 2, "$T_r$", BLUE)):
        canvas.line([(x, floor - 0.06), (x, floor - 0.3)], color=color, lw=0.8)
        canvas.arrow((x, floor - 0.24), (x + 0.38, floor - 0.24), color=color)
        canvas.text((x + 0.52, floor - 0.24), name, color=color)
    canvas.text(
        (1.9, 2.05), r"$\mathbb{M}(\ddot T_r-\ddot T_d)+\mathbb{C}(\dot T_r-\dot T_d)+\mathbb{K}(T_r-T_d)=F_{ext}$"
    )


def _answer(canvas: Canvas, numbers: tuple[float, float, float]) -> None:
    """Position and velocity over time."""
    time, position, velocity = response(*numbers)
    left = canvas.panel((4.3, 0.48), (2.1, 1.45))
    right = left.twinx()
    left.axvspan(0.0, PUSHED, color=(PALE, 0.6), lw=0.0, zorder=0)
    left.text(
        PUSHED / 2.0,
        1.03 * position.max() + 0.06,
        "1 N",
        ha="center",
        va="bottom",
        fontsize=points(8),
        color=VERMILLION,
    )
    left.plot(time, position, color=BLUE, lw=1.3)
    right.plot(time, velocity, color=GREEN, lw=1.1, ls=(0, (5, 1.5)))
    right.axhline(1.0 / numbers[1], color=INK, lw=0.6, ls=(0, (1, 2)))
    right.annotate(
        r"$F/\mathbb{C}$, the steady rate",
        (SHOWN, 1.0 / numbers[1]),
        (-2, 2),
        textcoords="offset points",
        ha="right",
        va="bottom",
    )
    left.set(xlim=(0.0, SHOWN), ylim=(0.0, 1.25 * position.max()), xlabel="time (s)")
    right.set_ylim(0.0, 1.7 / numbers[1])
    right.spines["right"].set(visible=True, color=GREEN)
    left.spines["left"].set_color(BLUE)
    left.tick_params(axis="y", colors=BLUE)
    right.tick_params(axis="y", colors=GREEN)
    left.set_ylabel("$T_r$ (m)", color=BLUE)
    right.set_ylabel(r"$\dot T_r$ (m/s)", color=GREEN)


@styled
def draw(mission: Mapping[str, Any]) -> Figure:
    """Draw the admittance of a mission along x."""
    table = mission["admittance"]
    numbers = tuple(float(np.ravel(table[name])[0]) for name in ("mass", "damping", "stiffness"))
    canvas = Canvas(HEIGHT)
    _mechanics(canvas, (numbers[0], numbers[1], numbers[2]))
    _answer(canvas, (numbers[0], numbers[1], numbers[2]))
    return canvas.figure
