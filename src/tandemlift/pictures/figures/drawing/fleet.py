"""Figures with a row of panels for each quadrotor: how many a page holds, and how high they are."""

from __future__ import annotations

from matplotlib.figure import Figure

from tandemlift.pictures.figures.drawing.style import StyledFigure, page_figure, points

MOST = 8  # quadrotors: what a page holds
HIGH, LOW = 1.3, 0.95  # in: of a row of panels where there are few, and where there are many
FEW = 4  # rows


def fleet_figure(count: int, around: float) -> tuple[Figure, int]:
    """A figure for `count` quadrotors, and how many rows it has; `around` [in] is what is above and below them.

    Where not all quadrotors have a row, it says so.
    """
    rows = min(count, MOST)
    height = around + max(LOW * rows, HIGH * min(rows, FEW))
    figure: StyledFigure = page_figure(height)
    if rows < count:
        figure.supxlabel(f"quadrotors 1 to {rows} of {count}", x=0.995, ha="right", fontsize=points(8))
    return figure, rows
