"""What a push feels like: the speed over time under the standard push along each axis, by closed form and flown."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tandemlift.analysis.studies.closed_form import YAW
from tandemlift.analysis.studies.feel_study import FeelStudy
from tandemlift.analysis.studies.standard_push import PushedAxis
from tandemlift.pictures.figures.drawing.figure import Caption
from tandemlift.pictures.figures.drawing.panels import fit, line
from tandemlift.pictures.figures.drawing.style import (
    ACTUAL,
    DESIRED,
    GREY,
    INK,
    PALE,
    PAPER,
    StyledFigure,
    page_figure,
    styled,
)

CAPTION = Caption(
    "Standard push",
    "Speed over time under a push that begins at once, lasts (grey), and ends at once: by the closed form of the "
    "admittance, M v′ + C v = F beyond the threshold, and flown, with filters, delays, limits and rotors. Circles: "
    "95 % of the final speed. Calm air, no walls, from hover.",
    "A panel over time for each axis: the speed that the admittance gives, and the speed of the flight.",
)
COLUMNS, HEIGHT = 2, 1.75  # in
LEAST_SPEED = 0.05  # m/s, span of an axis


@styled
def draw(study: FeelStudy) -> Figure:
    """Draw every axis of a study."""
    rows = math.ceil(len(study.pushed) / COLUMNS)
    figure: StyledFigure = page_figure(0.35 + HEIGHT * rows)
    grid = figure.add_gridspec(rows, COLUMNS)
    handles: list[Any] = []
    for i, pushed in enumerate(study.pushed):
        axes = figure.add_subplot(grid[i // COLUMNS, i % COLUMNS])
        handles = _panel(axes, pushed)
        if i + COLUMNS >= len(study.pushed):
            axes.set_xlabel("time from the beginning of the push (s)")
    names = ("pushed", "closed form", "flown", "95 % of the final speed")
    figure.legend(handles, names, loc="outside upper center", ncols=len(names), columnspacing=1.4)
    return figure


def _panel(axes: Axes, p: PushedAxis) -> list[Any]:
    """Fill the panel of an axis; returns the handles for the legend."""
    turning = p.feel.axis == YAW
    pushed = axes.axvspan(0.0, p.hold, facecolor=PALE, alpha=0.45, lw=0.0, zorder=0)
    closed = line(axes, p.time, p.closed, zorder=4, **DESIRED)
    flown = line(axes, p.time, p.flown, zorder=3, **ACTUAL)
    axes.axhline(0.0, color=GREY, lw=0.4, zorder=1)
    (mark,) = axes.plot([], [], "o", color=INK, ms=3.5, mfc=PAPER, mew=0.8)
    for answer, look in ((p.ideal, DESIRED), (p.real, ACTUAL)):
        if answer.time is not None and answer.final_speed is not None:
            at = (answer.time, 0.95 * answer.final_speed)
            axes.plot(*at, "o", color=look["color"], ms=3.5, mfc=PAPER, mew=0.9, zorder=5)
    fit(axes, p.closed, p.flown, np.zeros(1), least=LEAST_SPEED)
    axes.set_xlim(p.time[0], p.time[-1])
    axes.set_ylabel("yaw rate (rad/s)" if turning else f"$v_{p.feel.axis}$ (m/s)")
    axes.set_title(f"{p.feel.push:g} {'N m in yaw' if turning else f'N along {p.feel.axis}'}")
    return [pushed, closed, flown, mark]
