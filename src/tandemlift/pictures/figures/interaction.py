"""The person's interaction with the vehicle, along each world axis: push, thresholds and reference.

Grey while the push is beyond the threshold and followed; white while none is and the reference comes to rest.
"""
# paper: fig8

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, all_flights
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import extent, line, scaling, shade, time_axis, value_ticks
from tandemlift.pictures.drawing.style import BLUE, INK, PALE, VERMILLION, column_figure, journal

CAPTION = Caption(
    "Interaction",
    "The person’s push and the thresholds of the admittance (left axis), and the resulting reference (right axis), "
    "along each world axis. Grey: the push is beyond the threshold and moves the reference. White: no push is "
    "followed, and the reference comes to rest.",
    "Three panels over time, for x, y and z: push, thresholds and reference position, shaded where the admittance is "
    "active.",
)
IN_FLIGHTS = all_flights
OVERLAY = over_time("push_force", "admittance_force", "admittance_position")

LEAST_PUSH = 0.1  # N, half the least span of the axis
LEAST_REFERENCE = 0.01  # m


def _share_zero(ax: Axes, other: Axes, forces: Array, positions: Array) -> None:
    """Limit both value axes so that their zeros stand at one height and no value touches the frame."""
    ends = [extent(np.zeros(1), forces), extent(np.zeros(1), positions)]
    sizes = [max(*np.abs(end), least) for end, least in zip(ends, (LEAST_PUSH, LEAST_REFERENCE), strict=True)]
    below = min(low / size for (low, _), size in zip(ends, sizes, strict=True))
    above = max(high / size for (_, high), size in zip(ends, sizes, strict=True))
    margin = 0.06 * max(above - below, 1.0)
    for axes, size in zip((ax, other), sizes, strict=True):
        axes.set_ylim((below - margin) * size, (above + margin) * size)
        axes.yaxis.set_major_locator(value_ticks())


def _panel(ax: Axes, other: Axes, flight: Flight, axis: int) -> list[Any]:
    """Fill one axis's panel and its second value axis; returns the handles for the legend."""
    push, reference = flight["push_force"][:, axis], flight["admittance_position"][:, axis]
    threshold = float(flight.mission["admittance"]["threshold"][axis])
    gate = "push_active" if "push_active" in flight else "admittance_force"  # guided, the force decays after the push
    shade(ax, flight.time, flight[gate][:, axis] != 0.0)
    force = line(ax, flight.time, push, color=BLUE, lw=1.2)
    limits = [ax.axhline(s * threshold, color=INK, lw=0.7, ls=(0, (5, 3))) for s in (1.0, -1.0)]
    other.spines["right"].set(visible=True, color=VERMILLION)
    other.tick_params(axis="y", colors=VERMILLION)
    other.set_ylabel(f"$T_{{r,{'xyz'[axis]}}}$ (m)", color=VERMILLION)
    answer = line(other, flight.time, reference, color=VERMILLION, lw=1.4, ls=(0, (1.2, 1.2)))
    ax.set_ylabel(f"$F_{{{'xyz'[axis]}}}$ (N)", color=BLUE)
    ax.tick_params(axis="y", colors=BLUE)
    ax.spines["left"].set_color(BLUE)
    _share_zero(ax, other, np.append(scaling(flight, push), (threshold, -threshold)), scaling(flight, reference))
    return [force, limits[0], answer]


@journal
def draw(flight: Flight) -> Figure:
    """Draw push [N], thresholds [N] and T_r [m] on x, y and z, shaded grey where the gate is open."""
    figure = column_figure(4.2)
    axes = figure.subplots(3, 1, squeeze=False)[:, 0]
    others = [ax.twinx() for ax in axes]
    handles: list[Any] = []
    for axis, (ax, other) in enumerate(zip(axes, others, strict=True)):
        handles = _panel(ax, other, flight, axis)
        time_axis(ax, flight, label=axis == 2)
    figure.align_ylabels(axes)
    figure.align_ylabels(others)
    names = ("push", "threshold", "reference $T_r$", "admittance active")
    figure.legend([*handles, Patch(facecolor=PALE)], names, loc="outside upper center", ncols=2, columnspacing=1.2)
    return figure
