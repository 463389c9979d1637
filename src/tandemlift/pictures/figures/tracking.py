"""Tracking of the vehicle: desired and actual orientation, position and velocity, and the normalised errors.

The desired orientation is the attitude law's reference; orientation is in degrees, position and velocity are in world
axes. Each error is divided by its largest absolute value, which the legend gives.
"""
# paper: fig6

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter

from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, all_flights
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import drawable, fit, line, normalised, scaling, time_axis
from tandemlift.pictures.drawing.style import (
    ACTUAL,
    COMPONENTS,
    DESIRED,
    GREY,
    VERMILLION,
    journal,
    page_figure,
    points,
)

CAPTION = Caption(
    "Tracking",
    "Desired and actual orientation, position and velocity. Bottom row: the errors, desired minus actual, each "
    "divided by its largest absolute value, which the legend gives; a triangle marks the beginning of a finding.",
    "Twelve panels over time, three columns for orientation, position and velocity: desired and actual value of each "
    "component, and their normalised errors.",
)
IN_FLIGHTS = all_flights
OVERLAY = over_time("euler", "position", "velocity", "attitude_error", "position_error", "velocity_error")


class FigureColumn(NamedTuple):
    """A column of the figure: its channels, its components' symbols, unit and scale, and the least span of an axis."""

    title: str
    desired: str
    actual: str
    error: str
    symbols: tuple[str, str, str]
    unit: str
    scale: float
    least: float


COLUMNS = (
    FigureColumn(
        "Orientation",
        "reference_euler",
        "euler",
        "attitude_error",
        (r"\phi", r"\theta", r"\psi"),
        "°",
        float(np.degrees(1.0)),
        0.2,
    ),
    FigureColumn("Position", "reference_position", "position", "position_error", ("x", "y", "z"), "m", 1.0, 0.02),
    FigureColumn(
        "Velocity",
        "reference_velocity",
        "velocity",
        "velocity_error",
        (r"\dot{x}", r"\dot{y}", r"\dot{z}"),
        "m/s",
        1.0,
        0.02,
    ),
)


def size_of(value: float, unit: str) -> str:
    """A value in three digits, with an SI prefix, or as a power of ten where degrees are small."""
    if unit != "°":
        return EngFormatter(unit)(float(f"{value:.3g}"))
    digits, _, power = f"{value:.3g}".partition("e")
    return rf"${digits}\times10^{{{int(power)}}}$°" if power else f"{digits}°"


def _trajectories(axes: Sequence[Axes], flight: Flight, column: FigureColumn) -> list[Any]:
    """Fill the three upper panels of a column; returns the handles of the actual and the desired line."""
    handles = []
    for i, ax in enumerate(axes):
        actual, desired = (flight[name][:, i] * column.scale for name in (column.actual, column.desired))
        handles = [line(ax, flight.time, actual, **ACTUAL), line(ax, flight.time, desired, **DESIRED)]
        fit(ax, scaling(flight, actual), scaling(flight, desired), least=column.least)
        ax.set_ylabel(f"${column.symbols[i]}$ ({column.unit})", labelpad=1)
        time_axis(ax, flight, label=False)
    return handles


def _mark_findings(ax: Axes, flight: Flight) -> None:
    """Mark the times at which findings begin by triangles at the upper edge."""
    times = sorted({f.time for f in flight.findings})
    if times:
        ax.plot(times, [1.1] * len(times), "v", color=VERMILLION, ms=3.5, clip_on=False, zorder=5)


def _errors(ax: Axes, flight: Flight, column: FigureColumn) -> None:
    """Fill the bottom panel of a column with the errors over their largest absolute values."""
    for i, look in enumerate(COMPONENTS):
        error = drawable(flight[column.error][:, i])
        _, peak = normalised(scaling(flight, error))
        size = f" / {size_of(peak * column.scale, column.unit)}" if peak else ": 0"
        line(ax, flight.time, error / peak if peak else 0.0 * error, label=f"${column.symbols[i]}${size}", **look)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)
    ax.set_ylim(-1.1, 1.1)
    ax.set_yticks([-1, 0, 1])
    ax.set_ylabel("error / largest", labelpad=1)
    above = {"loc": "lower center", "bbox_to_anchor": (0.46, 1.0), "borderaxespad": 0.0}
    ax.legend(ncols=3, fontsize=points(6.5), handlelength=1.3, handletextpad=0.3, columnspacing=0.6, **above)
    _mark_findings(ax, flight)
    time_axis(ax, flight)


@journal
def draw(flight: Flight) -> Figure:
    """Draw orientation [°], position [m] and velocity [m/s], desired and actual, and the normalised errors."""
    figure = page_figure(5.8)
    axes = figure.subplots(4, 3, squeeze=False, gridspec_kw={"height_ratios": (1, 1, 1, 1.25)})
    handles: list[Any] = []
    for ax, column in zip(axes.T, COLUMNS, strict=True):
        ax[0].set_title(column.title)
        handles = _trajectories(ax[:3], flight, column)
        _errors(ax[3], flight, column)
        figure.align_ylabels(ax)
    figure.legend(handles, ("actual", "desired"), loc="outside upper left", ncols=2)
    return figure
