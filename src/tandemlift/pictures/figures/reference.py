"""The reference trajectories of the admittance in response to the push, along each world axis.

The push [N] is drawn above position T_r [m] and velocity [m/s].
"""
# paper: fig4

from __future__ import annotations

from matplotlib.figure import Figure

from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, all_flights
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import fit, line, scaling, time_axis
from tandemlift.pictures.drawing.style import BLUE, GREY, VERMILLION, journal, page_figure

CAPTION = Caption(
    "Reference trajectories",
    "The admittance’s response to the person’s push, along each world axis: the push, and the reference position and "
    "velocity.",
    "Nine panels over time, three columns for x, y and z: push in newtons, reference position, reference velocity.",
)
IN_FLIGHTS = all_flights
OVERLAY = over_time("push_force", "admittance_position", "admittance_velocity")

ROWS = (  # channel, label, least span of the axis
    ("push_force", "push (N)", 0.2),
    ("admittance_position", "$T_r$ (m)", 0.02),
    ("admittance_velocity", r"$\dot{T}_r$ (m/s)", 0.02),
)


@journal
def draw(flight: Flight) -> Figure:
    """Draw the push [N, world axes] and T_r with its rate; columns are x, y and z."""
    figure = page_figure(3.5)
    axes = figure.subplots(3, 3, sharex=True, squeeze=False)
    for axis, name in enumerate("xyz"):
        axes[0, axis].set_title(f"${name}$")
        for row, (ax, (channel, _, least)) in enumerate(zip(axes[:, axis], ROWS, strict=True)):
            values = flight[channel][:, axis]
            line(ax, flight.time, values, color=VERMILLION if row else BLUE, lw=1.2)
            fit(ax, scaling(flight, values), least=least)
            ax.axhline(0.0, color=GREY, lw=0.4, zorder=0)
            time_axis(ax, flight, label=row == 2)
    for ax, (_, label, _) in zip(axes[:, 0], ROWS, strict=True):
        ax.set_ylabel(label)
    figure.align_ylabels(axes[:, 0])
    return figure
