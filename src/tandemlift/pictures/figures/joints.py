"""Force [N] and torque [N m] of every quadrotor on the payload at its joint, body axes.

Simulated sensor readings are drawn faintly behind. If a disturbed start needs far larger forces than the rest of the
flight, the value axes are scaled to the time after the first second.
"""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, with_any_of
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import components, fit, fleet_figure, is_disturbed, line, scaling, time_axis
from tandemlift.pictures.drawing.style import COMPONENTS, GREY, journal

CAPTION = Caption(
    "Joints",
    "Force and torque of each quadrotor on the payload at its joint, in body axes. If sensors are simulated, their "
    "readings are drawn behind. If the start of the flight needs far larger forces than the rest, the scale is that "
    "of the time after the first second.",
    "A row of two panels over time for each quadrotor: force and torque on the payload, components x, y and z.",
)
IN_FLIGHTS = with_any_of("joint_force")
OVERLAY = over_time("joint_force", "joint_torque")

FRAME_HEIGHT = 0.9  # in, above and below the rows
COLUMNS = (("joint_force", "f", "N", 0.2), ("joint_torque", "t", "N m", 0.05))  # channel, symbol, unit, least span
FAINT: dict[str, Any] = {"lw": 0.5, "alpha": 0.35, "zorder": 1}


def _panel(ax: Axes, flight: Flight, name: str, first: int, least: float) -> bool:
    """Fill one panel with columns `first` to `first` + 2 of a channel; returns whether it is scaled to what follows."""
    part = slice(first, first + 3)
    shown = [flight[channel][:, part] for channel in (name, f"measured_{name}") if channel in flight.channels]
    for read in shown[1:]:
        for i, look in enumerate(COMPONENTS):
            line(ax, flight.time, read[:, i], color=look["color"], **FAINT)
    components(ax, flight.time, shown[0], zorder=3)
    disturbed = is_disturbed(flight, shown[0], (least,) * 3)
    fit(ax, *(scaling(flight, values, disturbed) for values in shown), least=least)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)
    return disturbed


def _legend(figure: Figure, sensed: bool) -> None:
    handles = [Line2D([], [], **look) for look in COMPONENTS]
    names = ["$x$", "$y$", "$z$"]
    if sensed:
        handles, names = [*handles, Line2D([], [], color=GREY, lw=1.5, alpha=0.5)], [*names, "measured, behind"]
    figure.legend(handles, names, loc="outside upper center", ncols=len(names), columnspacing=1.6)


@journal
def draw(flight: Flight) -> Figure:
    """Draw force [N] and torque [N m] of each quadrotor on the payload (body axes), a row each, of the first eight."""
    figure, rows = fleet_figure(flight["joint_force"].shape[1] // 3, FRAME_HEIGHT)
    axes = figure.subplots(rows, 2, squeeze=False)
    for column, (name, symbol, unit, least) in enumerate(COLUMNS):
        scaled = []
        for row, ax in enumerate(axes[:, column]):
            scaled.append(_panel(ax, flight, name, 3 * row, least))
            time_axis(ax, flight, label=row == rows - 1)
            ax.set_ylabel(f"${symbol}_{{{row + 1}}}$ ({unit})")
        what = ("force", "torque")[column]
        axes[0, column].set_title(f"{what}, scaled to what follows the first second" if any(scaled) else what)
        figure.align_ylabels(axes[:, column])
    _legend(figure, "measured_joint_force" in flight.channels)
    return figure
