"""Several controllers on one mission: errors of position over time on shared axes, and what the rotors give.

A disturbed start, or a controller that diverges, would leave nothing to see of the rest: the first 10 s have a column
of their own, and axes are scaled to flights that did not diverge.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from tandemlift.figures.drawing.panels import extent, fit, line, time_axis, value_ticks
from tandemlift.figures.drawing.series import drawable
from tandemlift.figures.drawing.start import LONG, START
from tandemlift.figures.drawing.style import BLACK, BLUE, GREEN, GREY, LIGHT_BLUE, PAGE, VERMILLION, styled
from tandemlift.flight.record import Flight
from tandemlift.loop.running_metrics import LATE

Array = NDArray[np.float64]

DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5)))
COLOURS = (BLUE, VERMILLION, GREEN, BLACK, "#E69F00", "#CC79A7", "#56B4E9", GREY)  # Okabe and Ito
LEAST = 0.2  # mm, the least span of an axis of errors
BANDS = 300  # stretches of time into which what the rotors give is drawn


def _look(place: int) -> dict[str, Any]:
    """The look of the controller number `place`: eight colours, each with a dash, then the next dash."""
    return {"color": COLOURS[place % len(COLOURS)], "ls": DASHES[(place + place // len(COLOURS)) % len(DASHES)]}


def _settled(flights: Mapping[str, Flight]) -> Sequence[Flight]:
    """The flights that did not diverge, all if none."""
    return [f for f in flights.values() if not f.divergence] or list(flights.values())


def _column(axes: Any, flights: Mapping[str, Flight], first: float, last: float) -> None:
    """Draw the errors [mm] of all flights from one time to another [s] in three panels."""
    for i, ax in enumerate(axes):
        shown = []
        for place, flight in enumerate(flights.values()):
            part = (flight.time >= first) & (flight.time <= last)
            error = 1e3 * flight["position_error"][part, i]
            if len(error):
                line(ax, flight.time[part], error, lw=0.8, **_look(place))
            if flight in _settled(flights):
                shown.append(error)
        fit(ax, *shown, least=LEAST)
        ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)
        time_axis(ax, max(flights.values(), key=lambda f: len(f.time)), label=i == 2)
        ax.set_xlim(first, last)
        ax.xaxis.set_major_locator(MaxNLocator(nbins=7 if last > 1.5 * LATE else 5, steps=[1, 2, 5, 10]))


def _names(figure: Figure, flights: Mapping[str, Flight]) -> None:
    handles = [Line2D([], [], lw=1.1, **_look(place)) for place in range(len(flights))]
    names = [f"{name} (diverged)" if f.divergence else name for name, f in flights.items()]
    figure.legend(handles, names, loc="outside upper left", ncols=min(len(names), 6), columnspacing=1.2)


@styled
def draw_errors(flights: Mapping[str, Flight]) -> Figure:
    """Draw the errors of position [mm], desired minus actual, along x, y, z; the first 10 s apart."""
    last = max((float(f.time[-1]) for f in flights.values() if len(f.time)), default=0.0)
    apart = last > 1.5 * LATE
    figure = Figure(figsize=(PAGE, 4.8), layout="constrained")
    widths = (1.0, 2.6) if apart else (1.0,)
    axes = figure.subplots(3, len(widths), squeeze=False, gridspec_kw={"width_ratios": widths})
    if apart:
        _column(axes[:, 0], flights, 0.0, LATE)
        axes[0, 0].set_title("first 10 s")
        axes[0, 1].set_title("what follows")
    _column(axes[:, -1], flights, LATE if apart else 0.0, last or 1.0)
    for row, axis in zip(axes, "xyz", strict=True):
        row[0].set_ylabel(f"error of ${axis}$ (mm)")
    figure.align_ylabels(axes[:, 0])
    _names(figure, flights)
    return figure


def _bands(time: Array, thrusts: Array) -> tuple[Array, Array, Array, Array]:
    """Time, least, mean and greatest thrust over stretches of samples (K,) of the thrusts (T, rotors)."""
    width = max(1, len(time) // BANDS)
    starts = np.arange(0, len(time), width)
    counts = np.diff([*starts, len(time)])
    mean = np.add.reduceat(thrusts.mean(axis=1), starts) / counts
    low, high = np.minimum.reduceat(thrusts.min(axis=1), starts), np.maximum.reduceat(thrusts.max(axis=1), starts)
    return time[starts], low, mean, high


def _rotors(ax: Any, flight: Flight) -> None:
    time, low, mean, high = _bands(flight.time, drawable(flight["rotor_thrusts"]))
    ax.fill_between(time, low, high, color=LIGHT_BLUE, lw=0.0)
    ax.plot(time, mean, color=BLUE, lw=0.9)


def _beyond_the_start(flight: Flight) -> Array:
    """The thrusts of the rotors [N] after the first second, of all of a flight that is hardly longer."""
    long = len(flight.time) and flight.time[-1] >= LONG
    return flight["rotor_thrusts"][flight.time > (START if long else -1.0)]


@styled
def draw_thrusts(flights: Mapping[str, Flight]) -> Figure:
    """Draw, for each controller, the mean thrust of the rotors [N] over the least to the greatest of any of them.

    Scaled to what follows the first second.
    """
    rows = -(-len(flights) // 2)
    figure = Figure(figsize=(PAGE, 0.55 + 1.25 * rows), layout="constrained")
    axes = figure.subplots(rows, 2, squeeze=False, sharex=True, sharey=True)
    longest = max(flights.values(), key=lambda f: len(f.time))
    low, high = extent(*[_beyond_the_start(f) for f in _settled(flights)])
    for place, (ax, (name, flight)) in enumerate(zip(axes.flat, flights.items(), strict=False)):
        if len(flight.time):
            _rotors(ax, flight)
        ax.set_title(f"{name} (diverged)" if flight.divergence else name, fontsize=8.5, pad=2)
        time_axis(ax, longest, label=place >= len(flights) - 2)
        ax.tick_params(labelbottom=place >= len(flights) - 2)
        if place % 2 == 0:
            ax.set_ylabel("thrust (N)")
    axes[0, 0].set_ylim(low - 0.05 * (high - low or 1.0), high + 0.05 * (high - low or 1.0))
    axes[0, 0].yaxis.set_major_locator(value_ticks())
    for ax in axes.flat[len(flights) :]:
        ax.set_visible(False)
    return figure
