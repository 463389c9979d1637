"""A sheet for diagrams: one unit is an inch on a page of `WIDTH`; arrows, boxes and texts in one look."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from tandemlift.figures.drawing.figure_style import current_style
from tandemlift.figures.drawing.style import DIM, INK, PAPER, StyledFigure, page_figure, points

WIDTH = 7.16  # in
HEAD = "-|>,head_length=4.2,head_width=1.9"
BOX = "round,pad=0,rounding_size=0.06"
ROUND = 0.3  # of a turn that a turning arrow leaves open

Point = Any
"""Two numbers [in]."""


class Canvas:
    """A figure as wide as a page of the style, drawn on in inches from its lower left corner, as if `WIDTH` wide.

    Args:
        height: of the drawing [in], at that width.

    Attributes:
        figure: the figure.
        axes: its axes, in which the drawing has one scale.
        scale: inches on paper of an inch of the drawing.
    """

    def __init__(self, height: float) -> None:
        self.figure: StyledFigure = page_figure(height * current_style().page / WIDTH)
        self.figure.set_layout_engine("none")
        self.axes: Any = self.figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self.axes.set(xlim=(0.0, WIDTH), ylim=(0.0, height), aspect="equal")
        self.axes.set_axis_off()
        size = self.figure.get_size_inches()
        self.scale = float(min(size / (WIDTH, height)))
        self._corner, self._size = (size - self.scale * np.array([WIDTH, height])) / 2.0, size

    def panel(self, corner: Point, size: Point) -> Any:
        """Axes of their own, from a lower left corner and of a size [in of the drawing]."""
        low = (self._corner + self.scale * np.asarray(corner)) / self._size
        return self.figure.add_axes((*low, *(self.scale * np.asarray(size) / self._size)))

    def text(self, place: Point, words: str, **look: Any) -> None:
        """Write words, centred at a place unless `ha` or `va` say otherwise."""
        centred = {"ha": "center", "va": "center", "fontsize": 8.5, "zorder": 20, **look}
        centred["fontsize"] = points(centred["fontsize"]) * min(self.scale, 1.0)
        self.axes.text(*place, words, **centred)

    def line(self, points: Any, **look: Any) -> None:
        """Draw a line through points (n, 2)."""
        self.axes.plot(*np.asarray(points).T, **{"color": INK, "lw": 0.8, "solid_capstyle": "round", **look})

    def arrow(self, start: Point, end: Point, **look: Any) -> None:
        """Draw a straight arrow."""
        self._arrow({"posA": tuple(start), "posB": tuple(end)}, look)

    def route(self, points: Sequence[Point], **look: Any) -> None:
        """Draw an arrow along a line with corners."""
        if len(points) > 2:
            self.line(points[:-1], color=look.get("color", INK), lw=look.get("lw", 1.0), solid_joinstyle="miter")
        self.arrow(points[-2], points[-1], **look)

    def turn(self, centre: Point, across: Point, along: Point, **look: Any) -> None:
        """Draw an arrow around most of an ellipse with half axes `across` and `along`, from the one to the other."""
        angles = 2.0 * np.pi * np.linspace(ROUND / 2.0, 1.0 - ROUND / 2.0, 40)
        points = np.asarray(centre) + np.outer(np.cos(angles), across) + np.outer(np.sin(angles), along)
        self.line(points, color=look.get("color", INK), lw=look.get("lw", 1.0), zorder=look.get("zorder", 10))
        self.arrow(points[-3], points[-1], **look)

    def box(self, centre: Point, size: Point, title: str, below: str = "", **look: Any) -> None:
        """Draw a box with a title, and a smaller text below it."""
        (x, y), (width, height) = centre, size
        face = {"facecolor": PAPER, "edgecolor": INK, "lw": 0.9, "zorder": 5, **look}
        self.axes.add_patch(FancyBboxPatch((x - width / 2, y - height / 2), width, height, boxstyle=BOX, **face))
        self.text((x, y + (0.11 if below else 0.0)), title, linespacing=1.05)
        if below:
            self.text((x, y - 0.16), below, fontsize=6.8, color=DIM, linespacing=1.15)

    def _arrow(self, ends: dict[str, Any], look: dict[str, Any]) -> None:
        common = {"arrowstyle": HEAD, "mutation_scale": 1.0, "shrinkA": 0, "shrinkB": 0, "color": INK, "lw": 1.0}
        self.axes.add_patch(FancyArrowPatch(**ends, **{**common, "zorder": 10, **look}))
