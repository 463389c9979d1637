"""Several flights of one mission: controllers by position errors over time and rotor thrusts, engines over each other.

Of controllers, a disturbed start, or one that diverges, would hide the rest: the time before the first push has a
column of its own, and axes are scaled to flights that did not diverge. Panels in which nothing moves are left out.
Lines of engines overlap and differ in width: the first is the widest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator

from tandemlift.analysis.studies.comparison import MissionComparison
from tandemlift.analysis.studies.comparison_scores import (
    NAMES,
    QUANTITIES,
    RESOLUTION,
    ScoredPart,
    airborne,
    differences,
    moving_axes,
    parts_of,
    scored,
)
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.overlay import legend_of_flights
from tandemlift.pictures.drawing.panels import LONG, START, drawable, extent, fit, legend_above, line, time_axis
from tandemlift.pictures.drawing.style import BLUE, GREY, LIGHT_BLUE, look, page_figure, points, styled
from tandemlift.pictures.figures.registry import plot

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


def drawn_figures(found: MissionComparison) -> dict[str, Figure]:
    """The figures of a comparison by name; without the errors where none reaches 1 µm."""
    flights = found.flights
    if found.of == "engines":
        drawn = {"paths": plot(flights, "path"), "positions": plot(flights, "position")}
        return drawn | {"differences": draw_differences(flights)}
    moving = any(any(moving_axes(flights.values(), part)) for part in parts_of(flights.values()))
    return ({"errors": draw_errors(flights)} if moving else {}) | {"thrusts": draw_thrusts(flights)}


# ---- Controllers

LEAST_SPAN = 2e3 * RESOLUTION  # mm, of an axis of errors
LEAST_THRUST = 0.02  # N, of an axis of thrusts
NARROW = 0.38  # of the flight, the least width of a column
BANDS = 300  # stretches of time in which rotor thrusts are drawn


def _settled(flights: Mapping[str, Flight]) -> Sequence[Flight]:
    """The flights that did not diverge, all if none."""
    return [f for f in flights.values() if not f.ending] or list(flights.values())


def _errors(ax: Axes, flights: Mapping[str, Flight], part: ScoredPart, axis: int) -> None:
    """Draw the errors [mm] of all flights along an axis in a part; not on the floor, where nothing is controlled."""
    shown, settled = [], _settled(flights)
    for place, flight in enumerate(flights.values()):
        inside = (flight.time >= part.first) & (flight.time < part.last)
        error = 1e3 * np.where(scored(flight, part), flight["position_error"][:, axis], np.nan)[inside]
        if len(error):
            line(ax, flight.time[inside], error, **look(place, lw=0.8))
        if flight in settled:
            shown.append(error)
    fit(ax, *shown, least=LEAST_SPAN)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)


def _still(ax: Axes, what: str) -> None:
    """Say in a panel that nothing moves there, in place of its values."""
    ax.text(0.5, 0.5, what, transform=ax.transAxes, ha="center", va="center", fontsize=points(8), color=GREY)
    ax.set_yticks([])


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
                _errors(ax, flights, part, i)
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
    legend_of_flights(figure, flights, lw=1.1)
    return figure


def _bands(time: Array, thrusts: Array) -> tuple[Array, Array, Array, Array]:
    """Time, least, mean and greatest thrust over stretches of samples (K,) of the thrusts (T, rotors)."""
    width = max(1, len(time) // BANDS)
    starts = np.arange(0, len(time), width)
    counts = np.diff([*starts, len(time)])
    mean = np.add.reduceat(thrusts.mean(axis=1), starts) / counts
    low, high = np.minimum.reduceat(thrusts.min(axis=1), starts), np.maximum.reduceat(thrusts.max(axis=1), starts)
    return time[starts], low, mean, high


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
            time, low, mean, high = _bands(flight.time, drawable(flight["rotor_thrusts"]))
            ax.fill_between(time, low, high, color=LIGHT_BLUE, lw=0.0)
            ax.plot(time, mean, color=BLUE, lw=0.9)
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


# ---- Engines

ROW = 1.15  # in: height of a panel
FLOOR = 1e-12  # a smaller difference is not drawn


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
