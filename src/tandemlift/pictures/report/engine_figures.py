"""One mission flown in several engines: the flights over each other, and how far they are from the first.

Overlapping lines differ in width: the first is the widest.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from tandemlift.analysis.studies.engine_comparison import QUANTITIES, differences
from tandemlift.flight.record import Flight
from tandemlift.pictures.figures.drawing.figure import Caption, with_walls
from tandemlift.pictures.figures.drawing.figure_style import current_style
from tandemlift.pictures.figures.drawing.panels import fit, line, time_axis, value_ticks
from tandemlift.pictures.figures.drawing.series import decimate
from tandemlift.pictures.figures.drawing.style import (
    BLUE,
    GREEN,
    INK,
    LIGHT_BLUE,
    VERMILLION,
    page_figure,
    points,
    styled,
)

CAPTIONS = {
    "flights": Caption(
        "Flights",
        "Path of the centre of mass from above, if there are walls, and its position over time, in every engine; the "
        "first is drawn widest.",
        "The path from above with walls, and panels over time for x, y and z, with one line for each engine.",
    ),
    "differences": Caption(
        "Differences",
        "Difference of each engine’s flight from that of the first: distance of positions, angle between attitudes, "
        "largest component of the differences of the forces and torques at the joints and of the push estimate.",
        "A panel over time for each quantity, with a logarithmic scale and a line for each engine but the first.",
    ),
}
LOOKS: tuple[dict[str, Any], ...] = (
    {"color": LIGHT_BLUE, "lw": 4.5},
    {"color": BLUE, "lw": 1.8},
    {"color": VERMILLION, "lw": 0.8},
    {"color": GREEN, "lw": 0.8, "ls": (0, (4, 3))},
)
TALL, ROW = (1.6, 4.0), 1.15  # in: least and greatest height of the view from above, and of a panel over time
FLOOR = 1e-12  # a smaller difference is not drawn
NAMES = {name: name.replace("_", " ").replace("estimate", "estimated") for name in QUANTITIES}


def _look(place: int) -> dict[str, Any]:
    return LOOKS[min(place, len(LOOKS) - 1)]


def _legend(figure: Figure, names: list[str], first: int = 0) -> None:
    handles = [Line2D([], [], **_look(place)) for place in range(first, first + len(names))]
    figure.legend(handles, names, loc="outside upper left", ncols=len(names), columnspacing=1.4)


def _from_above(ax: Axes, flights: Mapping[str, Flight]) -> None:
    first = next(iter(flights.values()))
    for wall in first.walls:
        ax.plot(*np.array([wall["start"], wall["end"]]).T, color=INK, lw=1.4, solid_capstyle="round", gid="wall")
    for place, flight in enumerate(flights.values()):
        path = flight["position"][:, :2]
        shown = np.unique(np.concatenate([decimate(coordinate) for coordinate in path.T]))
        ax.plot(*path[shown].T, solid_capstyle="round", gid="path", **_look(place))
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("$x$ (m)")
    ax.set_ylabel("$y$ (m)")


@styled
def draw_over_each_other(flights: Mapping[str, Flight]) -> Figure:
    """Draw the ways from above [m], if there are walls, and the positions x, y, z [m] over time."""
    first = next(iter(flights.values()))
    walls = with_walls(first)
    span = np.ptp(first["position"][:, :2], axis=0) + 4.0
    tall = float(np.clip(current_style().page * span[1] / span[0], *TALL))
    heights = [tall, ROW, ROW, ROW] if walls else [ROW, ROW, ROW]
    figure = page_figure(0.5 + sum(heights))
    axes = figure.subplots(len(heights), 1, height_ratios=heights)
    if walls:
        _from_above(axes[0], flights)
    for i, ax in enumerate(axes[-3:]):
        for place, flight in enumerate(flights.values()):
            line(ax, flight.time, flight["position"][:, i], **_look(place))
        fit(ax, *(f["position"][:, i] for f in flights.values()), least=0.01)
        ax.set_ylabel(f"${'xyz'[i]}$ (m)")
        ax.yaxis.set_major_locator(value_ticks())
        time_axis(ax, first, label=i == 2)
    figure.align_ylabels(axes)
    _legend(figure, list(flights))
    return figure


@styled
def draw_differences(flights: Mapping[str, Flight]) -> Figure:
    """Draw how far each flight is from the first, a panel for each quantity, over time."""
    first, *others = flights.values()
    apart_by = [differences(flight, first) for flight in others]
    shown = [name for name in QUANTITIES if all(name in found for found in apart_by)]
    figure = page_figure(0.5 + ROW * len(shown))
    axes = figure.subplots(len(shown), 1, squeeze=False)[:, 0]
    for ax, name in zip(axes, shown, strict=True):
        for place, found in enumerate(apart_by, 1):
            values = np.where(found[name] > FLOOR, found[name], np.nan)
            ax.plot(first.time[: len(values)], values, **(_look(place) | {"lw": 0.7}))
        ax.set_yscale("log")
        ax.yaxis.set_major_locator(LogLocator(numticks=5))
        ax.set_ylabel(f"{NAMES[name]} ({QUANTITIES[name]})", fontsize=points(7.5))
        time_axis(ax, first, label=name == shown[-1])
    figure.align_ylabels(axes)
    _legend(figure, [f"{name} from {next(iter(flights))}" for name in list(flights)[1:]], first=1)
    return figure


def drawn_figures(flights: Mapping[str, Flight]) -> dict[str, Figure]:
    """The figures of a comparison by name."""
    return {"flights": draw_over_each_other(flights), "differences": draw_differences(flights)}
