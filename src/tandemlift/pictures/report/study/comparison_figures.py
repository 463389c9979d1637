"""Several flights of one mission: controllers by position errors and inputs over time, engines over each other."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from tandemlift.analysis.studies.comparison import MissionComparison
from tandemlift.analysis.studies.comparison_scores import NAMES, QUANTITIES, differences
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.panels import legend_above, time_axis
from tandemlift.pictures.drawing.style import look, page_figure, points, styled
from tandemlift.pictures.figures.registry import plot

CAPTIONS = {
    "errors": Caption(
        "Errors",
        "Position errors, desired minus actual, of all controllers. Flights that diverge do not set the scale.",
        "A panel over time for each axis, with the position error of every controller.",
    ),
    "inputs": Caption(
        "Inputs",
        "Commanded thrust and moments about the body axes, of all controllers.",
        "Panels over time of the commanded thrust and moments, with a line for each controller.",
    ),
    "paths": Caption(
        "Paths",
        "Path of the centre of mass in every engine, with its shadow on the floor, among the walls if there are any.",
        "Three-dimensional view of the paths, one line for each engine, and of the walls.",
    ),
    "positions": Caption(
        "Positions",
        "Position of the centre of mass over time, in world axes, in every engine; the first is drawn widest.",
        "Three panels over time for x, y and z, with one line for each engine.",
    ),
    "differences": Caption(
        "Differences",
        "Difference of each engine’s flight from that of the first: distance of positions, angle between attitudes, "
        "largest component of the differences of the forces and torques at the joints and of the push estimate.",
        "A panel over time for each quantity, with a logarithmic scale and a line for each engine but the first.",
    ),
}
ROW = 1.15  # in: height of a panel
FLOOR = 1e-12  # a smaller difference is not drawn


def drawn_figures(found: MissionComparison) -> dict[str, Figure]:
    """The figures of a comparison by name."""
    flights = found.flights
    if found.of == "controllers":
        return {"errors": plot(flights, "position_error"), "inputs": plot(flights, "inputs")}
    drawn = {"paths": plot(flights, "path"), "positions": plot(flights, "position")}
    return drawn | {"differences": draw_differences(flights)}


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
            ax.plot(first.time[: len(values)], values, **look(place, lw=0.7))
        ax.set_yscale("log")
        ax.yaxis.set_major_locator(LogLocator(numticks=5))
        ax.set_ylabel(f"{NAMES[name].replace('estimate', 'estimated')} ({QUANTITIES[name]})", fontsize=points(7.5))
        time_axis(ax, first, label=name == shown[-1])
    figure.align_ylabels(axes)
    handles = [Line2D([], [], **look(place, lw=0.7)) for place in range(1, len(flights))]
    names = [f"{name} from {next(iter(flights))}" for name in list(flights)[1:]]
    legend_above(figure, handles, names, "outside upper left")
    return figure
