"""Estimate of the disturbance observer: force and moment besides rotors, weight and person; its error over λ₂.

The condition of the paper's law is λ₂ > ‖δ − δ̂‖ on every axis: the estimation error, divided by λ₂, is below 1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from tandemlift.core.phases import GUIDED
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, with_any_of
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import components, fit, line, scaling, shade, time_axis
from tandemlift.pictures.drawing.style import COMPONENTS, GREY, INK, PALE, column_figure, journal

CAPTION = Caption(
    "Disturbance",
    "The disturbance observer’s estimate of the loads on the vehicle besides rotors, weight and person: force in "
    "world axes, moment in body axes. Bottom, with a sliding-mode controller: the estimation error divided by λ₂, the "
    "largest of the three axes of position and of attitude; the control law’s guarantee requires it to be below 1. "
    "Grey: the pilot is ready to follow a person.",
    "Panels over time: disturbing force and moment, components x, y and z; the estimation error divided by λ₂.",
)
IN_FLIGHTS = with_any_of("disturbance_force")
OVERLAY = over_time("disturbance_force", "disturbance_moment")


def error_over_lambda(flight: Flight) -> Array | None:
    """|δ − δ̂| over λ₂ (T, 6), as far as the observer can tell; None where the controller has no λ₂."""
    gains = flight.mission["controller"].get("gains")
    if not isinstance(gains, dict) or "lambda_2" not in gains:
        return None
    left = np.hstack([flight["disturbance_residual"], flight["disturbance_angular_residual"]])
    return np.abs(left) / np.maximum(np.array(gains["lambda_2"]), 1e-12)


def _condition(ax: Axes, flight: Flight, error: Array) -> None:
    """Fill the panel of the condition: the largest error over the axes of position, and of attitude."""
    for part, look, name in ((slice(0, 3), COMPONENTS[0], "position"), (slice(3, 6), COMPONENTS[1], "attitude")):
        line(ax, flight.time, error[:, part].max(axis=1), label=name, **look)
    ax.axhline(1.0, color=INK, lw=0.7, ls=(0, (5, 3)))
    fit(ax, np.zeros(1), np.ones(1), scaling(flight, error), least=1.0)
    ax.set_ylabel("$|\\delta-\\hat{\\delta}|/\\lambda_2$")
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, columnspacing=1.2)


@journal
def draw(flight: Flight) -> Figure:
    """Draw the disturbance's force [N] and moment [N·m], and its error over λ₂; grey while the pilot is ready."""
    error = error_over_lambda(flight)
    rows = 2 if error is None else 3
    figure = column_figure(1.35 * rows + 0.3)
    axes = figure.subplots(rows, 1, squeeze=False)[:, 0]
    panels = (("disturbance_force", "$\\hat{d}$ (N)", 0.2), ("disturbance_moment", "$\\hat{\\tau}$ (N m)", 0.02))
    handles, names = list[Any](), ["$x$, roll", "$y$, pitch", "$z$, yaw"]
    for ax, (channel, label, least) in zip(axes, panels, strict=False):
        handles = components(ax, flight.time, flight[channel])
        fit(ax, np.zeros(1), scaling(flight, flight[channel]), least=least)
        ax.set_ylabel(label)
    if error is not None:
        _condition(axes[2], flight, error)
    ready = flight["phase"] == GUIDED if "phase" in flight else np.zeros(len(flight.time), dtype=bool)
    for ax in axes:
        ax.axhline(0.0, color=GREY, lw=0.5, zorder=0)
        shade(ax, flight.time, ready)
        time_axis(ax, flight, label=ax is axes[-1])
    figure.align_ylabels(axes)
    if ready.any():
        handles, names = [*handles, Patch(facecolor=PALE)], [*names, "ready"]
    figure.legend(handles, names, loc="outside upper center", ncols=4, columnspacing=1.2)
    return figure
