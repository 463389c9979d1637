"""Thrust and command of every rotor [N] with its limits, and the fraction of the commanded wrench that they give.

A rotor failure is marked, and its upper limit falls to the thrust that is left. Commands far beyond the limits are cut
off.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from tandemlift.flight.channels import FLOWN
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, with_any_of
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import extent, fleet_figure, line, scaling, time_axis, value_ticks
from tandemlift.pictures.drawing.style import BLUE, GREY, INK, TAN, VERMILLION, journal, points

CAPTION = Caption(
    "Rotors",
    "Thrust and command of each rotor, and its limits; commands far beyond the limits are cut off. A rotor failure is "
    "marked, and lowers the upper limit to the thrust that is left. Near the floor a rotor can give more than its "
    "limit. Bottom: the fraction of the commanded wrench that the commands give within the limits; it is 0 while the "
    "rotors are stopped. In the shadow of a log, the command that was flown is in the thrust's place.",
    "A row of four panels over time for each quadrotor: thrust, command and limits of each rotor. Below, the fraction "
    "of the commanded thrust and moments that they give.",
)
IN_FLIGHTS = with_any_of("rotor_commands")
OVERLAY = over_time("rotor_thrusts", "allocation_fraction")

FRAME_HEIGHT, FRACTION = 2.0, 0.85  # in: above and below the rows of rotors, and of that, the lowest panel
MARGIN = 0.12  # of the largest thrust, beyond the limits
FREE_THRUST = 0.7  # fraction of the thrust: if no more is left, words fit in above it
THRUST: dict[str, Any] = {"color": BLUE, "lw": 0.9}
COMMAND: dict[str, Any] = {"color": TAN, "lw": 0.7}
LIMIT: dict[str, Any] = {"color": INK, "lw": 0.7, "ls": (0, (5, 3))}
FAILED: dict[str, Any] = {"color": VERMILLION, "lw": 1.0}


def rotor_fault(flight: Flight, quadrotor: int, rotor: int) -> dict[str, Any] | None:
    """The fault of a rotor (both counted from 1) if it comes within the time flown: the last one that is given."""
    faults = [f for f in flight.mission.get("faults", []) if (f["quadrotor"], f["rotor"]) == (quadrotor, rotor)]
    return faults[-1] if faults and len(flight.time) and faults[-1]["time"] <= flight.time[-1] else None


def _limits(ax: Axes, flight: Flight, most: float, fault: dict[str, Any] | None) -> None:
    """Draw the limits of a rotor, the upper one falling where it fails, and mark that."""
    time_axis(ax, flight, label=False)
    ax.xaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 3, 5, 10]))
    end = ax.get_xlim()[1]
    ax.axhline(0.0, zorder=1, **LIMIT)
    if fault is None:
        ax.axhline(most, zorder=1, **LIMIT)
        return
    at, left = fault["time"], fault["efficiency"]
    ax.plot([0.0, at, at, end], [most, most, left * most, left * most], zorder=1, **LIMIT)
    ax.axvline(at, zorder=4, gid="fault", **FAILED)
    place = most * (1.0 + left) / 2.0 if left < FREE_THRUST else 0.25 * most
    late = at > end / 2.0
    look: dict[str, Any] = {
        "fontsize": points(7),
        "color": VERMILLION,
        "va": "center",
        "ha": "right" if late else "left",
        "zorder": 5,
    }
    ax.annotate(
        f"{100.0 * left:.3g} % left", (at, place), (-3.0 if late else 3.0, 0.0), textcoords="offset points", **look
    )


def _acting(flight: Flight) -> str:
    """The channel of the thrusts; in the shadow of a log, of the commands that were flown."""
    return FLOWN if FLOWN in flight else "rotor_thrusts"


def _panel(ax: Axes, flight: Flight, column: int, most: float, fault: dict[str, Any] | None) -> None:
    """Fill the panel of one rotor: a column of its channels, and the most that it gives [N]."""
    thrust = flight[_acting(flight)][:, column]
    line(ax, flight.time, flight["rotor_commands"][:, column], zorder=2, **COMMAND)
    line(ax, flight.time, thrust, zorder=3, **THRUST)
    _limits(ax, flight, most, fault)
    low, high = extent(
        scaling(flight, thrust), np.array([0.0, most])
    )  # near the floor a rotor gives more than its most
    ax.set_ylim(low - MARGIN * most, high + MARGIN * most)
    ax.yaxis.set_major_locator(value_ticks())


def _fraction(ax: Axes, flight: Flight) -> None:
    line(ax, flight.time, flight["allocation_fraction"], color=BLUE, lw=1.0)
    ax.axhline(1.0, color=GREY, lw=0.4, zorder=0)
    ax.set_ylim(-0.05, 1.08)
    ax.set_yticks([0.0, 0.5, 1.0])
    ax.set_ylabel("fraction of wrench")
    time_axis(ax, flight)


def _legend(figure: Figure, acting: str, failing: bool) -> None:
    looks, names = [THRUST, COMMAND, LIMIT], ["flown" if acting == FLOWN else "thrust", "commanded", "limits"]
    if failing:
        looks, names = [*looks, FAILED], [*names, "rotor fails"]
    handles = [Line2D([], [], **look) for look in looks]
    figure.legend(handles, names, loc="outside upper center", ncols=len(names), columnspacing=1.6)


@journal
def draw(flight: Flight) -> Figure:
    """Draw thrust, command and limits [N] of each rotor, a row for each quadrotor (at most 8), and the fraction."""
    quadrotors = flight.vehicle.quadrotors
    figure, rows = fleet_figure(len(quadrotors), FRAME_HEIGHT)
    height = (figure.get_figheight() - FRAME_HEIGHT) / rows
    grid = figure.add_gridspec(rows + 1, 4, height_ratios=[*[height] * rows, FRACTION])
    faults = {name: rotor_fault(flight, *name) for name in product(range(1, rows + 1), range(1, 5))}
    for column, ((row, rotor), fault) in enumerate(faults.items()):
        ax = figure.add_subplot(grid[row - 1, rotor - 1])
        _panel(ax, flight, column, quadrotors[row - 1].thrust_limit, fault)
        ax.tick_params(labelbottom=row == rows, labelleft=rotor == 1)
        if rotor == 1:
            ax.set_ylabel(f"quadrotor {row}\nthrust (N)")
        if row == 1:
            ax.set_title(f"rotor {rotor}")
    _fraction(figure.add_subplot(grid[rows, :]), flight)
    _legend(figure, _acting(flight), any(faults.values()))
    return figure
