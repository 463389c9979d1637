"""Several controllers on one mission: position errors over time on shared axes, and rotor thrusts.

A disturbed start, or a controller that diverges, would hide the rest: the time before the first push has a column of
its own, and axes are scaled to flights that did not diverge. Panels in which nothing moves are left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from tandemlift.analysis.studies.controller_comparison import LEAST, ScoredPart, airborne, moving_axes, parts_of, scored
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.figures.drawing.figure import Caption
from tandemlift.pictures.figures.drawing.panels import LONG, START, extent, fit, line, time_axis
from tandemlift.pictures.figures.drawing.series import drawable
from tandemlift.pictures.figures.drawing.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT_BLUE,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    page_figure,
    points,
    styled,
)

CAPTIONS = {
    "errors": Caption(
        "Errors",
        "Position errors in the air, desired minus actual, of all controllers. The time before the first push, with "
        "take-off or a disturbed start, has a scale of its own. Axes along which no error reaches 1 µm are left out. "
        "Flights that diverge do not set the scale.",
        "Panels over time for each axis: the position error of every controller, before the first push and after.",
    ),
    "thrusts": Caption(
        "Thrusts",
        "Mean thrust of all rotors (line), and the range from the smallest to the largest thrust of any rotor (band). "
        "Each panel has the scale of the time after the first second; its range is given above it.",
        "A panel over time for each controller: mean thrust of the rotors, and the band from smallest to largest.",
    ),
}
DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5)))
COLOURS = (BLUE, VERMILLION, GREEN, INK, ORANGE, PURPLE, SKY, GREY)
LEAST_SPAN = 2e3 * LEAST["position_max_error_m"]  # mm, of an axis of errors
LEAST_THRUST = 0.02  # N, of an axis of thrusts
NARROW = 0.38  # of the flight, the least width of a column
BANDS = 300  # stretches of time in which rotor thrusts are drawn


def look(place: int) -> dict[str, Any]:
    """The look of the controller number `place`: eight colours, each with a dash, then the next dash."""
    return {"color": COLOURS[place % len(COLOURS)], "ls": DASHES[(place + place // len(COLOURS)) % len(DASHES)]}


def _settled(flights: Mapping[str, Flight]) -> Sequence[Flight]:
    """The flights that did not diverge, all if none."""
    return [f for f in flights.values() if not f.ending] or list(flights.values())


def _errors(flight: Flight, part: ScoredPart) -> Array:
    """Errors of position (T, 3) [mm] in a part, NaN on the floor, where the vehicle is not controlled."""
    inside = (flight.time >= part.first) & (flight.time < part.last)
    return 1e3 * np.where(scored(flight, part)[inside, None], flight["position_error"][inside], np.nan)


def _panel(ax: Axes, flights: Mapping[str, Flight], part: ScoredPart, axis: int) -> None:
    """Draw the errors [mm] of all flights along an axis in a part."""
    shown = []
    for place, flight in enumerate(flights.values()):
        time = flight.time[(flight.time >= part.first) & (flight.time < part.last)]
        error = _errors(flight, part)[:, axis]
        if len(error):
            line(ax, time, error, lw=0.8, **look(place))
        if flight in _settled(flights):
            shown.append(error)
    fit(ax, *shown, least=LEAST_SPAN)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)


def _still(ax: Axes, what: str) -> None:
    """Say in a panel that nothing moves there, in place of its values."""
    ax.text(0.5, 0.5, what, transform=ax.transAxes, ha="center", va="center", fontsize=points(8), color=GREY)
    ax.set_yticks([])


def _names(figure: Figure, flights: Mapping[str, Flight]) -> None:
    handles = [Line2D([], [], lw=1.1, **look(place)) for place in range(len(flights))]
    names = [f"{name} ({f.ending.outcome})" if f.ending else name for name, f in flights.items()]
    figure.legend(handles, names, loc="outside upper left", ncols=min(len(names), 6), columnspacing=1.2)


@styled
def draw_errors(flights: Mapping[str, Flight]) -> Figure:
    """Draw the errors of position [mm], desired minus actual: a row for each axis, a column for each part.

    Axes and parts in which no error reaches 1 µm are left out; one axis at least must move (`moving_axes`).
    """
    found = parts_of(flights.values())
    moving = {part: moving_axes(flights.values(), part) for part in sorted(found, key=lambda part: part.first)}
    moving = {part: axes for part, axes in moving.items() if any(axes)}
    rows = [i for i in range(3) if any(axes[i] for axes in moving.values())]
    last = max(float(f.time[airborne(f)].max(initial=0.0)) for f in flights.values()) or 1.0
    figure = page_figure(0.6 + 1.4 * len(rows))
    widths = [max(min(part.last, last) - part.first, NARROW * last) for part in moving]
    grid = figure.subplots(len(rows), len(moving), squeeze=False, width_ratios=widths)
    for axes, part in zip(grid.T, moving, strict=True):
        for ax, i in zip(axes, rows, strict=True):
            if moving[part][i]:
                _panel(ax, flights, part, i)
            else:
                _still(ax, f"${'xyz'[i]}$ stays within 1 µm")
            ax.set_xlim(part.first, min(part.last, last))
            ax.xaxis.set_major_locator(MaxNLocator(nbins=7 if part is found[0] else 4, steps=[1, 2, 5, 10]))
            ax.tick_params(labelbottom=i == rows[-1])
        axes[-1].set_xlabel("time (s)")
        axes[0].set_title(part.name if len(found) > 1 else "")
    for axes, i in zip(grid, rows, strict=True):
        axes[0].set_ylabel(f"error of ${'xyz'[i]}$ (mm)")
    figure.align_ylabels(grid[:, 0])
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


def _rotors(ax: Axes, flight: Flight) -> None:
    time, low, mean, high = _bands(flight.time, drawable(flight["rotor_thrusts"]))
    ax.fill_between(time, low, high, color=LIGHT_BLUE, lw=0.0)
    ax.plot(time, mean, color=BLUE, lw=0.9)


def _beyond_the_start(flight: Flight) -> Array:
    """The thrusts of the rotors [N] after the first second, of all of a flight that is hardly longer."""
    long = len(flight.time) and flight.time[-1] >= LONG
    return flight["rotor_thrusts"][flight.time > (START if long else -1.0)]


def _range(flight: Flight) -> str:
    """The span of a panel in words, as each has its own scale."""
    low, high = (f"{value:.3g}".replace("-", "−") for value in extent(_beyond_the_start(flight)))
    return f"{low} to {high} N" + (f", {flight.ending.outcome}" if flight.ending else "")


@styled
def draw_thrusts(flights: Mapping[str, Flight]) -> Figure:
    """Draw, for each controller, the mean thrust of the rotors [N] over the least to the greatest of any of them.

    Each panel has a scale of its own, and says it: of what follows the first second, and of the other flights for one
    that diverged.
    """
    rows = -(-len(flights) // 2)
    figure = page_figure(0.55 + 1.25 * rows)
    axes = figure.subplots(rows, 2, squeeze=False, sharex=True)
    longest = max(flights.values(), key=lambda f: len(f.time))
    for place, (ax, (name, flight)) in enumerate(zip(axes.flat, flights.items(), strict=False)):
        if len(flight.time):
            _rotors(ax, flight)
        settled = _settled(flights) if flight.ending else [flight]
        fit(ax, *[_beyond_the_start(f) for f in settled], least=LEAST_THRUST)
        ax.set_title(f"{name}: {_range(flight)}", fontsize=points(8.5), pad=2)
        time_axis(ax, longest, label=place >= len(flights) - 2)
        ax.tick_params(labelbottom=place >= len(flights) - 2)
        if place % 2 == 0:
            ax.set_ylabel("thrust (N)")
    for ax in axes.flat[len(flights) :]:
        ax.set_visible(False)
    return figure


def drawn_figures(flights: Mapping[str, Flight]) -> dict[str, Figure]:
    """The figures of a comparison by name; without the errors where none reaches 1 µm."""
    drawn = {"thrusts": draw_thrusts(flights)}
    if any(any(moving_axes(flights.values(), part)) for part in parts_of(flights.values())):
        drawn = {"errors": draw_errors(flights)} | drawn
    return drawn
