"""Wind and contact, in world axes: velocity and force of the air, force of floor and walls, height above the floor.

Grey while floor or walls touch the vehicle. The height is that of the lowest foot above the floor.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, with_any_of
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import components, fit, legend_above, line, scaling, shade, time_axis
from tandemlift.pictures.drawing.style import BLUE, COMPONENTS, GREY, INK, PALE, journal, page_figure
from tandemlift.pictures.drawing.surroundings import clearance
from tandemlift.pictures.drawing.vehicle import floor_height, true_weight

CAPTION = Caption(
    "Surroundings",
    "With wind: velocity of the air and its force on all parts together. With a floor: force of floor and walls on "
    "the vehicle, with its weight, and height of the lowest foot above the floor. World axes. Grey: floor or walls "
    "touch the vehicle.",
    "Panels over time of the wind’s velocity and force, the contact force and the height above the floor, as far as "
    "there are wind and floor; shaded in contact.",
)
IN_FLIGHTS = with_any_of("wind_velocity", "contact_force")
OVERLAY = over_time("wind_velocity", "wind_force", "contact_force")

ROW_HEIGHT, FRAME_HEIGHT = 1.35, 0.85  # in: height of a panel, and above and below them all
VECTORS = (  # channel, label, least span of the axis
    ("wind_velocity", "wind (m/s)", 0.2),
    ("wind_force", "force of the\nwind (N)", 0.2),
    ("contact_force", "contact force (N)", 1.0),
)
LEAST_HEIGHT = 0.02  # m
HEIGHT = "height above\nfloor (m)"


def _vector(ax: Axes, flight: Flight, name: str, least: float) -> None:
    components(ax, flight.time, flight[name], zorder=3)
    fit(ax, scaling(flight, flight[name]), least=least)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=1)
    if name == "contact_force":
        ax.axhline(true_weight(flight), color=INK, lw=0.7, ls=(0, (5, 3)), zorder=2)


def _height(ax: Axes, flight: Flight, floor: float) -> None:
    values = clearance(flight, floor)
    line(ax, flight.time, values, color=BLUE, lw=1.2, zorder=3)
    fit(ax, scaling(flight, values), np.zeros(1), least=LEAST_HEIGHT)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=1)


def _legend(figure: Figure, touching: bool) -> None:
    handles: list[Any] = [Line2D([], [], **look) for look in COMPONENTS]
    names = ["$x$", "$y$", "$z$"]
    if touching:
        handles += [Line2D([], [], color=INK, lw=0.7, ls=(0, (5, 3))), Patch(facecolor=PALE)]
        names += ["weight", "in contact"]
    legend_above(figure, handles, names)


@journal
def draw(flight: Flight) -> Figure:
    """Draw wind [m/s], its force [N], contact force [N, world axes] and height [m], as far as the flight has them."""
    panels: list[tuple[str, Callable[[Any], None]]] = [
        (label, lambda ax, name=name, least=least: _vector(ax, flight, name, least))  # type: ignore[misc]
        for name, label, least in VECTORS
        if name in flight.channels
    ]
    if (floor := floor_height(flight)) is not None:
        panels.append((HEIGHT, lambda ax: _height(ax, flight, floor)))
    figure = page_figure(FRAME_HEIGHT + ROW_HEIGHT * len(panels))
    axes = figure.subplots(len(panels), 1, squeeze=False)[:, 0]
    for row, (ax, (label, fill)) in enumerate(zip(axes, panels, strict=True), 1):
        fill(ax)
        if "contact_force" in flight.channels:
            shade(ax, flight.time, np.any(np.abs(flight["contact_force"]) > 0.0, axis=1))
        ax.set_ylabel(label)
        time_axis(ax, flight, label=row == len(panels))
    figure.align_ylabels(axes)
    _legend(figure, "contact_force" in flight.channels)
    return figure
