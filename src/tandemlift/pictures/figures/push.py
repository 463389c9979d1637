"""The true push of a person, its value from the latest joint readings, and its estimate, in world axes.

Below: where on the beam it acts, the payload's mass, and the disagreement of the sensors. Grey while the pilot must not
use the estimate; blue during the tare, which finds the sensors' bias.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, with_any_of
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import fit, legend_above, line, scaling, shade, time_axis
from tandemlift.pictures.drawing.style import BLUE, GREY, INK, LIGHT_BLUE, PALE, TAN, VERMILLION, journal, page_figure
from tandemlift.pictures.drawing.vehicle import body_to_world, true_payload_mass

CAPTION = Caption(
    "Push estimate",
    "The person’s push, its value from the latest joint readings, and its estimate, along each world axis, with the "
    "thresholds of the admittance. Below: where on the beam it acts, along body y from the payload’s centre, while "
    "the push is large enough to tell (the axis is as wide as the beam); the payload’s mass; and the disagreement of "
    "the joint sensors, with the limit beyond which they are not trusted. Grey: the estimate must not be used. Blue: "
    "the tare, which finds the sensors’ bias.",
    "Six panels over time: true, measured and estimated push along x, y and z with thresholds; place along the beam; "
    "mass of the payload; disagreement of the sensors. Shaded where the estimate must not be used.",
)
IN_FLIGHTS = with_any_of("push_estimate")
OVERLAY = over_time(
    "push_force", "push_estimate", "push_point_estimate", "payload_mass_estimate", "sensor_disagreement"
)

TRUE: dict[str, Any] = {"color": BLUE, "lw": 1.2}
ESTIMATE: dict[str, Any] = {"color": VERMILLION, "lw": 1.0, "ls": (0, (4, 1.6))}
MEASURED: dict[str, Any] = {"color": TAN, "lw": 0.6}
LIMIT: dict[str, Any] = {"color": INK, "lw": 0.7, "ls": (0, (5, 3))}
ROWS = (1.0, 1.0, 1.0, 1.0, 0.85)  # heights: three forces, the place, mass and disagreement
LEAST_FORCE, LEAST_PLACE, LEAST_MASS = 0.2, 0.1, 0.02  # N, m, kg: least spans of the axes
AXIS_REACH = 1.06  # half-lengths of the beam that the axis of the place shows to each side


def places(flight: Flight) -> list[Array]:
    """The place of each push on body y (T) [m from the payload's origin], NaN while it is too small."""
    least = flight.mission["estimator"]["min_force"]
    R = body_to_world(flight["attitude"])
    center = flight.vehicle.center_of_mass[1]
    found = []
    for push in flight.mission.get("pushes", []):
        size = np.exp(-0.5 * ((flight.time - push["time"]) / push["sigma"]) ** 2)
        x, _, z = size * (np.array(push["force"]) @ R).T  # body axes
        across = np.hypot(x, z)
        found.append(np.where(across >= least, push["point"][1] + center, np.nan))
    return found


def _shadings(ax: Axes, flight: Flight) -> None:
    estimator = flight.mission["estimator"]
    shade(ax, flight.time, flight["push_usable"] == 0.0)
    if "tare_start" in estimator:
        end = estimator["tare_start"] + estimator["tare_duration"]
        shade(ax, flight.time, (flight.time >= estimator["tare_start"]) & (flight.time < end), LIGHT_BLUE)


def _force(ax: Axes, flight: Flight, axis: int) -> list[Any]:
    """Fill the panel of one axis's force; returns the handles for the legend."""
    threshold = float(flight.mission["admittance"]["threshold"][axis])
    measured, estimate, true = (flight[name][:, axis] for name in ("push_measured", "push_estimate", "push_force"))
    handles = [
        line(ax, flight.time, true, zorder=3, **TRUE),
        line(ax, flight.time, estimate, zorder=4, **ESTIMATE),
        line(ax, flight.time, measured, zorder=2, **MEASURED),
        *[ax.axhline(side * threshold, zorder=1, **LIMIT) for side in (1.0, -1.0)],
    ]
    drawn = scaling(flight, np.column_stack([true, estimate, measured]))
    fit(ax, drawn, np.array([threshold, -threshold]), least=LEAST_FORCE)
    ax.set_ylabel(f"$F_{'xyz'[axis]}$ (N)")
    return handles[:4]


def _place(ax: Axes, flight: Flight) -> None:
    """Fill the panel of where on the beam the push acts, as wide as the beam if the payload is one."""
    true = places(flight)
    point = flight["push_point_estimate"]
    point = np.where(point == 0.0, np.nan, point)
    for place in true:
        line(ax, flight.time, place, zorder=3, **TRUE)
    line(ax, flight.time, point, zorder=4, **ESTIMATE)
    length = flight.vehicle.payload.span
    fit(ax, *(scaling(flight, place) for place in (point, *true)), least=LEAST_PLACE)
    if length:
        ax.set_ylim(-AXIS_REACH * length / 2.0, AXIS_REACH * length / 2.0)
    ax.axhline(0.0, color=GREY, lw=0.4, zorder=1)
    ax.set_ylabel("acts at $y$ (m)")


def _mass(ax: Axes, flight: Flight) -> None:
    true, estimate = true_payload_mass(flight), flight["payload_mass_estimate"]
    ax.axhline(true, zorder=1, **TRUE)
    line(ax, flight.time, estimate, zorder=4, **ESTIMATE)
    fit(ax, scaling(flight, estimate), np.array([true]), least=LEAST_MASS)
    ax.set_ylabel("payload (kg)")


def _disagreement(ax: Axes, flight: Flight, limit: float) -> None:
    values = flight["sensor_disagreement"]
    line(ax, flight.time, values, zorder=4, **ESTIMATE | {"ls": "-"})
    ax.axhline(limit, zorder=1, **LIMIT)
    fit(ax, scaling(flight, values), np.array([0.0, limit]), least=LEAST_FORCE)
    ax.set_ylabel("sensors\ndisagree (N)")


@journal
def draw(flight: Flight) -> Figure:
    """Draw the push [N, world axes] true, measured and estimated, where it acts [m], mass [kg] and disagreement [N]."""
    estimator = flight.mission["estimator"]
    figure = page_figure(6.6)
    grid = figure.add_gridspec(5, 2, height_ratios=ROWS)
    axes = [figure.add_subplot(grid[row, :]) for row in range(4)]
    below = [figure.add_subplot(grid[4, column]) for column in range(2)]
    handles: list[Any] = []
    for axis, ax in enumerate(axes[:3]):
        handles = _force(ax, flight, axis)
    _place(axes[3], flight)
    _mass(below[0], flight)
    _disagreement(below[1], flight, estimator["disagreement_limit"])
    for ax in (*axes, *below):
        _shadings(ax, flight)
        time_axis(ax, flight, label=ax in (axes[3], *below))
    figure.align_ylabels([*axes, below[0]])
    names = ["true", "estimated", "measured", "threshold, limit", "estimate not usable"]
    handles.append(Patch(facecolor=PALE))
    if "tare_start" in estimator:
        handles, names = [*handles, Patch(facecolor=LIGHT_BLUE)], [*names, "tare"]
    legend_above(figure, handles, names)
    return figure
