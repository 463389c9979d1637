"""The commanded inputs: thrust U1 [N] and the moments U2, U3, U4 [N m] about the body axes.

A disturbed start can need inputs larger than those of the rest of the flight by orders of magnitude. Then a column of
its own shows the start in full, and the column of the whole flight is scaled to the time after it.
"""
# paper: fig7

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, all_flights
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import START, fit, is_disturbed, line, scaling, time_axis
from tandemlift.pictures.drawing.style import BLUE, GREY, INK, journal, page_figure
from tandemlift.pictures.drawing.vehicle import true_weight

CAPTION = Caption(
    "Inputs",
    "Commanded thrust U₁ and moments U₂, U₃, U₄ about the body axes. If the start of the flight needs far larger "
    "inputs than the rest, the first second has a column of its own.",
    "Panels over time of the commanded thrust and of the three commanded moments.",
)
IN_FLIGHTS = all_flights
OVERLAY = over_time("thrust", "moment")

MIN_SPANS = (1.0, 0.02, 0.02, 0.02)  # N, N m, N m, N m: least spans of the axes
LABELS = ("$U_1$ (N)", "$U_2$ (N m)", "$U_3$ (N m)", "$U_4$ (N m)")


def _panel(ax: Axes, flight: Flight, i: int, shown: NDArray[np.bool_], late: bool = False) -> None:
    """Draw input i over the samples `shown`, on a value axis that is scaled to them, or to those after the start."""
    values = flight["thrust"] if i == 0 else flight["moment"][:, i - 1]
    line(ax, flight.time[shown], values[shown], color=BLUE, lw=1.0)
    fit(ax, scaling(flight, np.where(shown, values, np.nan), late), least=MIN_SPANS[i])
    if i:
        ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)


@journal
def draw(flight: Flight) -> Figure:
    """Draw U1 [N] with the vehicle's weight, and U2, U3, U4 [N m]; the start apart if it is disturbed."""
    time = flight.time
    disturbed = is_disturbed(flight, np.column_stack([flight["thrust"], flight["moment"]]), MIN_SPANS)
    figure = page_figure(4.4)
    widths = (1.0, 2.6) if disturbed else (1.0,)
    axes = figure.subplots(4, len(widths), squeeze=False, gridspec_kw={"width_ratios": widths})
    weight = true_weight(flight)
    for i, row in enumerate(axes):
        _panel(row[-1], flight, i, np.ones(len(time), dtype=bool), late=disturbed)
        time_axis(row[-1], flight, label=i == 3)
        if disturbed:
            _panel(row[0], flight, i, time <= START)
            time_axis(row[0], flight, label=i == 3, until=START)
        row[0].set_ylabel(LABELS[i])
    hover = [ax.axhline(weight, color=INK, lw=0.7, ls=(0, (5, 3)), zorder=0) for ax in axes[0]]
    axes[0, -1].legend(hover[-1:], [f"weight, {weight:.4g} N"], loc="lower right", bbox_to_anchor=(1.0, 1.0))
    if disturbed:
        axes[0, 0].set_title("first second", loc="left")
        axes[0, 1].set_title("whole flight (scale: after the first second)", loc="left")
    figure.align_ylabels(axes[:, 0])
    return figure
