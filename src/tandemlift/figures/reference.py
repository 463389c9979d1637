"""The reference trajectories of the admittance in response to the push, along each world axis.

The push, divided by its largest absolute value on that axis, is drawn above position T_r [m] and velocity [m/s].
"""
# paper: fig4

from __future__ import annotations

from matplotlib.figure import Figure

from tandemlift.figures.drawing.figure import Caption, all_flights
from tandemlift.figures.drawing.panels import fit, line, time_axis
from tandemlift.figures.drawing.series import drawable, normalised
from tandemlift.figures.drawing.style import ACTUAL, GREY, VERMILLION, journal, page_figure
from tandemlift.flight.record import Flight

CAPTION = Caption(
    "Reference trajectories",
    "The admittance’s response to the person’s push, along each world axis: the push, divided by its largest absolute "
    "value on that axis, and the reference position and velocity.",
    "Nine panels over time, three columns for x, y and z: normalised push, reference position, reference velocity.",
)
IN_FLIGHTS = all_flights

ROWS = (
    ("admittance_position", "$T_r$ (m)", 0.02),
    ("admittance_velocity", r"$\dot{T}_r$ (m/s)", 0.02),
)


@journal
def draw(flight: Flight) -> Figure:
    """Draw the push (normalised, world axes) and T_r with its rate; columns are x, y and z."""
    figure = page_figure(3.5)
    axes = figure.subplots(3, 3, sharex=True, squeeze=False)
    for axis, name in enumerate("xyz"):
        push, _ = normalised(drawable(flight["push_force"][:, axis]))
        top = axes[0, axis]
        top.set_title(f"${name}$")
        line(top, flight.time, push, **ACTUAL)
        top.set_ylim(-1.12, 1.12)
        top.set_yticks([-1, 0, 1])
        for ax, (channel, _, least) in zip(axes[1:, axis], ROWS, strict=True):
            values = flight[channel][:, axis]
            line(ax, flight.time, values, color=VERMILLION, lw=1.2)
            fit(ax, values, least=least)
        for row, ax in enumerate(axes[:, axis]):
            ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)
            time_axis(ax, flight, label=row == 2)
    for ax, label in zip(axes[:, 0], (r"push / max|push|", *(label for _, label, _ in ROWS)), strict=True):
        ax.set_ylabel(label)
    figure.align_ylabels(axes[:, 0])
    return figure
