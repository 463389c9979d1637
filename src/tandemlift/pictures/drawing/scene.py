"""A scene in space on paper: a parallel projection at one scale for all axes, on a floor with a grid of metres.

The reader looks along a fixed direction from the front right and above: x runs to the right, y away, z up. With one
scale and one grid step for all three axes nothing is distorted, and a cell of the grid is a measure for all.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from tandemlift.core.types import Array
from tandemlift.pictures.drawing.figure import current_style
from tandemlift.pictures.drawing.style import GRID, GROUND, INK, PALE, TEXT, StyledFigure, points

ELEVATION, AZIMUTH = np.radians(27.0), np.radians(-64.0)  # of the reader's eye
RIGHT = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0.0])
UP = np.array([-np.sin(ELEVATION) * np.cos(AZIMUTH), -np.sin(ELEVATION) * np.sin(AZIMUTH), np.cos(ELEVATION)])
NEAR = np.cross(RIGHT, UP)

CELLS = 14  # at most, along the longest side
DIGIT_WIDTH, DIGIT_HEIGHT = 0.62, 1.1  # of a digit's size: room that it takes across and along, with what is around it
CELL_TOLERANCE = np.array([0.05, 0.3, 0.3])  # of a cell: smaller excesses over the box do not lengthen it
MOST_EXCESS = 0.3  # m, of these
MAX_HEIGHT = 5.2  # in
ROOM = np.array([0.4, 0.3, 0.5, 0.36])  # in, for labels around text of `TEXT`: left, bottom, right, top


def on_paper(points: ArrayLike) -> Array:
    """Points (…, 3) [m, world axes] seen from the reader's eye, (…, 2) [m]."""
    return np.asarray(points) @ np.column_stack([RIGHT, UP])


class Scene3D:
    """A figure with a box of space in it, wide enough for points (n, 3) [m, world axes].

    Args:
        points: to be visible.
        floor: height of a floor that is there [m], on which the box stands; else its floor is but a place for shadows.

    Attributes:
        figure: as wide as a page; of a tall box, of the style's narrowest width that suffices.
        axes: plain axes, in metres on paper.
        box: (3, 2) lower and upper ends of the box [m, world axes], multiples of `cell` but for a floor that is there.
        cell: of the grid [m].
        stands: whether the box stands on a floor that is there.
        bounds: (3, 2) lower and upper ends of box and points [m, world axes].
    """

    def __init__(self, points: Array, floor: float | None = None) -> None:
        self.cell, self.box = _box(points)
        self.stands = floor is not None
        if floor is not None:
            self.box[2] = floor, max(self.box[2, 1], floor + self.cell)
        low, high = np.minimum(self.box[:, 0], points.min(axis=0)), np.maximum(self.box[:, 1], points.max(axis=0))
        self.bounds = np.column_stack([low, high])
        corners = on_paper(np.stack(np.meshgrid(*self.box), axis=-1).reshape(-1, 3))
        seen = np.concatenate([corners, on_paper(points)])
        low, high = seen.min(axis=0), seen.max(axis=0)
        style = current_style()
        around = ROOM * style.type / TEXT
        room = around[:2] + around[2:]
        inner = (high - low) * min(([style.page, style.height or MAX_HEIGHT] - room) / (high - low))
        size = np.array([style.width_for(inner[0] + room[0]), style.height or inner[1] + room[1]])
        corner = (size - inner - room) / 2.0 + around[:2]
        self.figure = StyledFigure(size[0], size[1], layout=None)
        self.axes: Axes = self.figure.add_axes((*(corner / size), *(inner / size)))
        self._dots = 72.0 * inner[0] / (high - low)[0]  # pt on paper, of a metre
        self.axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        self.axes.set_axis_off()
        if floor is not None:
            (x0, x1), (y0, y1), _ = self.box
            ground = np.array([(x0, y0, floor), (x1, y0, floor), (x1, y1, floor), (x0, y1, floor)])
            self.fill(ground, facecolor=GROUND, zorder=-1, gid="floor")
        self._draw_box()

    def line(self, points: Array, **look: Any) -> Line2D:
        """Draw a line through points (n, 3) [m, world axes]. Returns it."""
        (drawn,) = self.axes.plot(*on_paper(points).T, clip_on=False, **look)
        return drawn

    def fill(self, corners: Array, **look: Any) -> None:
        """Fill a plane polygon with corners (n, 3) [m, world axes]."""
        self.axes.add_collection(PolyCollection([on_paper(corners)], lw=0.0, clip_on=False, **look))

    def _draw_box(self) -> None:
        """Floor and the two walls behind, with a grid, and labels on the three edges that are free."""
        (x0, x1), (y0, y1), (z0, z1) = self.box
        xs, ys, zs = (_multiples(low, high, self.cell) for low, high in self.box)
        floor = [[(x, y0, z0), (x, y1, z0)] for x in xs] + [[(x0, y, z0), (x1, y, z0)] for y in ys]
        walls = [[(x, y1, z0), (x, y1, z1)] for x in xs] + [[(x0, y, z0), (x0, y, z1)] for y in ys]
        walls += [[(x0, y1, z), (x1, y1, z)] for z in zs] + [[(x0, y0, z), (x0, y1, z)] for z in zs]
        edges = [[(x0, y0, z0), (x1, y0, z0)], [(x1, y0, z0), (x1, y1, z0)], [(x0, y0, z0), (x0, y0, z1)]]
        for lines, color, width in ((walls, GRID, 0.5), (floor, PALE, 0.5), (edges, INK, 0.6)):
            self.axes.add_collection(
                LineCollection(list(on_paper(lines)), colors=color, lw=width, clip_on=False, zorder=0)
            )
        self._number("x", xs, [(x, y0, z0) for x in xs], (-3.0, -3.0), "center", "top", (-22.0, -20.0))
        self._number("y", ys, [(x1, y, z0) for y in ys], (5.0, -3.0), "left", "center", (26.0, -12.0))
        self._number("z", zs, [(x0, y0, z) for z in zs], (-4.0, 2.0), "right", "center", (0.0, 12.0))

    def _number(
        self,
        axis: str,
        values: Array,
        places: ArrayLike,
        offset: tuple[float, float],
        across: str,
        along: str,
        name: tuple[float, float],
    ) -> None:
        """Numbers at places along an edge, offset [points], and the axis's name beside the middle, or over z."""
        digits = max(0, -int(np.floor(np.log10(self.cell) + 1e-9)))
        texts = [f"{value + 0.0:.{digits}f}".replace("-", "−") for value in values]
        spots = on_paper(places)
        look: dict[str, Any] = {"textcoords": "offset points", "annotation_clip": False}
        apart = np.abs(spots[-1] - spots[0]) / max(len(spots) - 1, 1) * self._dots  # pt, from one number to the next
        size = points(7.5) * np.array([DIGIT_WIDTH * max(map(len, texts)), DIGIT_HEIGHT])
        each = max(1, int(np.ceil(np.min(size / np.maximum(apart, 1e-9)) - 1e-9)))
        for text, spot in list(zip(texts, spots, strict=True))[::each]:
            self.axes.annotate(text, spot, offset, fontsize=points(7.5), ha=across, va=along, **look)
        beside = spots[-1] if axis == "z" else spots.mean(axis=0)
        self.axes.annotate(f"${axis}$ (m)", beside, name, ha="left" if axis == "y" else "center", va="center", **look)


def _multiples(low: float, high: float, cell: float) -> Array:
    """The multiples of a cell from one to the other; what is off by rounding counts as a multiple."""
    return np.arange(np.ceil(low / cell - 1e-6), np.floor(high / cell + 1e-6) + 1.0) * cell


def _box(points: Array) -> tuple[float, Array]:
    """Cell [m] and box (3, 2) [m] around points, with ends on the grid and at least a cell to each side."""
    low, high = points.min(axis=0), points.max(axis=0)
    longest = max(float((high - low).max()), 1e-3)
    cell = float(np.diff(MaxNLocator(CELLS, steps=[1, 2, 5, 10]).tick_values(0.0, longest))[0])
    excess = np.minimum(CELL_TOLERANCE, MOST_EXCESS / cell)
    first = np.floor(low / cell + excess)
    last = np.maximum(np.ceil(high / cell - excess), first + 1.0)
    return cell, np.column_stack([first, last]) * cell
