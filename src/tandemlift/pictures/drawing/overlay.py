"""Channels of several flights over each other: a panel for each component, a line in it for each flight.

A disturbed start, or a flight that diverges, would hide the rest: a panel whose first second spans far more than what
follows is scaled to what follows, and flights that ended early do not set a scale.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tandemlift.core.types import Array
from tandemlift.flight.channels import column_names
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.panels import (
    MAX_QUADROTORS,
    SHORT_ROW,
    TALL_ROW,
    TALL_ROW_COUNT,
    fit,
    is_disturbed,
    legend_above,
    line,
    scaling,
    time_axis,
)
from tandemlift.pictures.drawing.style import GREY, look, page_figure, points, styled

Flights = Mapping[str, Flight]
Overlay = Callable[[Flights], Figure]
"""Draws several flights, by name, over each other."""

MIN_SPANS = {"N": 0.2, "°": 0.2, "°/s": 0.2}  # least span of the axis of a unit; of others 0.02
ROTORS, AXES = 4, 3  # panels side by side: of the rotors of a quadrotor, of a vector
COLUMNS = 12  # of the grid, which one to four panels fill
CUT = "*"  # marks a panel that does not show the whole start


def legend_of_flights(figure: Figure, flights: Flights, place: str = "outside upper left", **own: Any) -> None:
    """A legend of the flights' names above the panels, with how those ended that ended early."""
    names = [f"{name} ({f.ending.outcome})" if f.ending else name for name, f in flights.items()]
    legend_above(figure, [Line2D([], [], **look(i, **own)) for i in range(len(names))], names, place)


class Panel(NamedTuple):
    """A component of a channel over time: title, unit, and of each flight that has it its place and its values (T,).

    `label`: of the value axis, where it is the first panel of a row.
    """

    title: str
    unit: str
    label: str
    series: list[tuple[int, Flight, Array]]


def _rows(flights: Flights, channel: str) -> list[list[Panel]]:
    """The panels of a channel in rows: three of a vector, four of the rotors of a quadrotor; eight rows at most."""
    having = [(place, flight) for place, flight in enumerate(flights.values()) if channel in flight]
    if not having:
        return []
    widest = max((flight for _, flight in having), key=lambda flight: flight[channel].shape[1:])
    info, shape = widest.info(channel), widest[channel].shape[1:]
    unit = info.unit.replace("rad", "°").replace("^2", "²") if info.unit != "1" else ""
    scale = np.degrees(1.0) if "°" in unit else 1.0
    series = [(place, flight, scale * np.atleast_2d(flight[channel].T).T) for place, flight in having]
    titles, label, by_rotor = (
        [n.replace("_", " ") for n in column_names(channel, info, shape)],
        unit,
        info.per == "rotor",
    )
    if by_rotor:
        titles = [f"quadrotor {i // ROTORS + 1}, rotor {i % ROTORS + 1}" for i in range(len(titles))]
        label = f"{channel.replace('_', ' ')}\n({unit})"
    panels = [
        Panel(title, unit, label, [(k, f, v[:, i]) for k, f, v in series if i < v.shape[1]])
        for i, title in enumerate(titles)
    ]
    across = AXES if not by_rotor and len(panels) % AXES == 0 else min(len(panels), ROTORS)
    return [panels[i : i + across] for i in range(0, len(panels), across)][:MAX_QUADROTORS]


def _draw(ax: Axes, panel: Panel) -> bool:
    """Draw the lines of a panel; whether it is scaled to what follows the first second."""
    least = MIN_SPANS.get(panel.unit, 0.02)
    for place, flight, values in panel.series:
        line(ax, flight.time, values, **look(place))
    scale = [one for one in panel.series if not one[1].ending] or panel.series
    cut = any(is_disturbed(flight, values[:, None], (least,)) for _, flight, values in scale)
    fit(ax, *(scaling(flight, values, cut) for _, flight, values in scale), least=least)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)
    ax.set_title(panel.title + (CUT if cut else ""), fontsize=points(8), pad=2)
    return cut


def over_time(*channels: str) -> Overlay:
    """The overlay of a figure that draws channels over time: those that any of the flights has, one at least."""

    @styled
    def draw(flights: Flights) -> Figure:
        rows = [row for channel in channels for row in _rows(flights, channel)]
        longest = max(flights.values(), key=lambda flight: flight.time[-1:].sum())
        figure = page_figure(0.6 + len(rows) * (TALL_ROW if len(rows) <= TALL_ROW_COUNT else SHORT_ROW))
        grid, first, cut = figure.add_gridspec(len(rows), COLUMNS), [], False
        for i, row in enumerate(rows):
            wide, last = COLUMNS // len(row), i + 1 == len(rows) or len(rows[i + 1]) != len(row)
            axes = [figure.add_subplot(grid[i, wide * j : wide * (j + 1)]) for j in range(len(row))]
            for ax, panel in zip(axes, row, strict=True):
                cut |= _draw(ax, panel)
                time_axis(ax, longest, label=last, crash=len(flights) == 1)
            axes[0].set_ylabel(row[0].label)
            first.append(axes[0])
        figure.align_ylabels(first)
        if cut:
            figure.supxlabel(f"{CUT} scaled to what follows the first second", x=0.995, ha="right", fontsize=points(8))
        legend_of_flights(figure, flights)
        return figure

    return draw
