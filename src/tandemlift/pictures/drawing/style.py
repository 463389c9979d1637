"""Figures under a style: a sheet of its size, settings of the drawing library, colours by name, and saving.

A figure is made, laid out and saved under the style of `figure_style`, whatever the settings of the machine are; no
figure is ever registered with a window system. A colour here is the place of the palette's colour in the cycle of
colours, so that one drawing serves all palettes.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from contextvars import ContextVar
from functools import wraps
from pathlib import Path
from typing import Any, Literal, ParamSpec

import matplotlib.style
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.layout_engine import LayoutEngine, PlaceHolderLayoutEngine
from matplotlib.transforms import Bbox, ScaledTranslation, Transform
from numpy.typing import NDArray

from tandemlift.core.files import atomic_write
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import FigureStyle, Palette, current_style

P = ParamSpec("P")
TEXT = 8.5  # pt: the size of text for which `points` are given
CSS_DOTS = 96.0  # pixels of a page in an inch

(
    PAPER,
    INK,
    BLUE,
    VERMILLION,
    GREEN,
    ORANGE,
    PURPLE,
    SKY,
    DIM,
    GREY,
    PALE,
    GRID,
    LIGHT_BLUE,  # of areas; in grey print close to PALE: label both
    TAN,  # of noisy lines in the background
    GROUND,
    GLASS,
    EDGE,
) = (f"C{place}" for place in range(len(Palette())))

ACTUAL: dict[str, Any] = {"color": BLUE, "lw": 1.2}
DESIRED: dict[str, Any] = {"color": VERMILLION, "lw": 1.0, "ls": (0, (4, 2))}
COMPONENTS: tuple[dict[str, Any], ...] = (  # dashes distinguish them in grey print too
    {"color": BLUE, "lw": 1.0},
    {"color": VERMILLION, "lw": 1.0, "ls": (0, (5, 1.5))},
    {"color": GREEN, "lw": 1.1, "ls": (0, (1.2, 1.2))},
)
BEHIND_TEXT: dict[str, Any] = {"facecolor": PAPER, "alpha": 0.75, "lw": 0.0, "pad": 0.8}

DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5)))
COLOURS = (BLUE, VERMILLION, GREEN, INK, ORANGE, PURPLE, SKY, GREY)  # of flights in one figure
WIDTHS = (2.0, 1.2, 0.8)  # pt: the first flights are drawn wider, so that lines that coincide are all seen

SIDES = {"left": "x0", "right": "x1", "bottom": "y0", "top": "y1"}

SETTINGS: dict[str, Any] = {
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "axes.formatter.limits": (-3, 5),
    "axes.formatter.useoffset": False,
    "axes.xmargin": 0.0,
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "legend.borderaxespad": 0.2,
    "lines.solid_capstyle": "butt",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "path.simplify": True,
    "pdf.fonttype": 42,  # TrueType, which journals ask for
    "figure.constrained_layout.h_pad": 0.03,
    "figure.constrained_layout.w_pad": 0.03,
}


def settings(style: FigureStyle) -> dict[str, Any]:
    """The settings of the drawing library for a style: `SETTINGS`, with its type and colours."""
    colours, size = style.palette, style.type
    inked = ("text.color", "axes.edgecolor", "axes.labelcolor", "xtick.color", "ytick.color")
    blank = ("figure.facecolor", "axes.facecolor", "savefig.facecolor")
    return {
        **SETTINGS,
        **dict.fromkeys(inked, colours.ink),
        **dict.fromkeys(blank, colours.paper),
        "axes.prop_cycle": cycler(color=list(colours)),
        "grid.color": colours.grid,
        "font.family": style.family,
        "mathtext.fontset": style.mathematics,
        "font.size": size,
        "axes.labelsize": size,
        "axes.titlesize": size + 0.5,
        "legend.fontsize": size - 0.5,
        "xtick.labelsize": size - 1.0,
        "ytick.labelsize": size - 1.0,
    }


_UNDER: ContextVar[FigureStyle | None] = ContextVar("under", default=None)


@contextmanager
def under(style: FigureStyle) -> Iterator[None]:
    """The settings of a style, whatever those of the machine are; the library checks some three hundred each time."""
    if _UNDER.get() is style:
        yield
        return
    before = _UNDER.set(style)
    try:
        with matplotlib.style.context(["default", settings(style)]):
            yield
    finally:
        _UNDER.reset(before)


def look(place: int, **own: Any) -> dict[str, Any]:
    """The look of the flight number `place` among several: eight colours, each with a dash, then the next dash."""
    dash, width = DASHES[(place + place // len(COLOURS)) % len(DASHES)], WIDTHS[min(place, len(WIDTHS) - 1)]
    return {"color": COLOURS[place % len(COLOURS)], "ls": dash, "lw": width, **own}


class StyledFigure(Figure):
    """A figure that is always drawn under the style in which it was made.

    Attributes:
        style: that style.
    """

    def __init__(self, width: float, height: float, layout: Literal["constrained"] | None = "constrained") -> None:
        self.style, self._labels = current_style(), list[tuple[Axis, float, float, Transform]]()
        size = self.style.size(width, height)
        super().__init__(figsize=size, dpi=self.style.dots(size[0]), layout=layout)

    def get_layout_engine(self) -> LayoutEngine | None:
        """None once it is laid out: with another answer, saving would draw it once more for its layout."""
        engine = super().get_layout_engine()
        return None if isinstance(engine, PlaceHolderLayoutEngine) else engine

    def lay_out(self) -> None:
        """Lay it out, once for all: else every drawing would lay it out again.

        The engine measures all axes twice, and their labels measure the ticks again each time they are drawn. But
        neither margins nor the places of labels beside the axes depend on the size of the axes.
        """
        engine, free = self.get_layout_engine(), [axes for axes in self.axes if axes.get_aspect() == "auto"]
        if engine is None:
            return
        for axes in free:
            vars(axes)["get_tightbbox"] = _measured_once(axes, self._labels)
        engine.execute(self)
        self.set_layout_engine("none")
        for axes in free:
            del vars(axes)["get_tightbbox"]

    def fix_labels(self) -> None:
        """Fix the labels of axes where the layout put them."""
        while self._labels:
            axis, x, y, beside = self._labels.pop()
            axis.set_label_coords(x, y, beside)

    def _repr_mimebundle_(self, **_: object) -> tuple[dict[str, bytes], dict[str, dict[str, int]]]:
        """The figure in a notebook: with the dots of a file, as large as in print, without pyplot."""
        picture = io.BytesIO()
        with under(self.style):
            self.savefig(picture)
        width, height = (round(CSS_DOTS * side) for side in self.get_size_inches())
        return {"image/png": picture.getvalue()}, {"image/png": {"width": width, "height": height}}

    def draw(self, renderer: RendererBase) -> None:
        """Draw it, its colours from the style's palette."""
        with nullcontext() if _UNDER.get() is self.style else matplotlib.rc_context(settings(self.style)):
            super().draw(renderer)


def page_figure(height: float) -> StyledFigure:
    """A figure as wide as a page of the style and as high as given [in]; a slide if that is the style."""
    return StyledFigure(current_style().page, height)


def column_figure(height: float) -> StyledFigure:
    """A figure as wide as a column of the style and as high as given [in]; a slide if that is the style."""
    return StyledFigure(current_style().column, height)


def points(size: float) -> float:
    """A size of type [pt], given for text of `TEXT`, in the present style."""
    return size * current_style().type / TEXT


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw under the present style, and lay the figure out once."""

    @wraps(draw)
    def drawn(*arguments: P.args, **named: P.kwargs) -> Figure:
        # a flight that diverged may hold infinities, whose differences are no news
        with under(current_style()), np.errstate(invalid="ignore", over="ignore"):
            figure = draw(*arguments, **named)
            if isinstance(figure, StyledFigure):
                figure.lay_out()
        return figure

    return drawn


def _measured_once(axes: Axes, labels: list[tuple[Axis, float, float, Transform]]) -> Callable[..., Bbox | None]:
    """The bounding box of axes, whose margins are measured once; the places of its labels join the list."""
    margins, figure = list[NDArray[np.float64]](), axes.figure

    def measure(renderer: RendererBase, **how: Any) -> Bbox | None:
        if not margins:
            box = type(axes).get_tightbbox(axes, renderer, **how)
            if box is None:
                return None
            margins.append(np.subtract(box.extents, axes.bbox.extents))
            for axis in (axes.xaxis, axes.yaxis):
                (x, y), side = axis.label.get_position(), axis.get_label_position()
                away = ((y if axis is axes.xaxis else x) - getattr(axes.bbox, SIDES[side])) / figure.dpi  # in
                end = float(side in ("right", "top"))
                x, y, dx, dy = (x, end, 0.0, away) if axis is axes.xaxis else (end, y, away, 0.0)
                labels.append((axis, x, y, axes.transAxes + ScaledTranslation(dx, dy, figure.dpi_scale_trans)))
        return Bbox.from_extents(*(axes.bbox.extents + margins[0]))

    return measure


def journal(draw: Callable[[Flight], Figure]) -> Callable[[Flight], Figure]:
    """Draw a flight under the present style, and say on the figure if it diverged."""

    @styled
    @wraps(draw)
    def noted(flight: Flight) -> Figure:
        figure = draw(flight)
        if flight.ending:
            note = f"{flight.ending.outcome} at {flight.ending.time:.5g} s"
            figure.supxlabel(note, x=0.01, ha="left", fontsize=points(8), color=VERMILLION)
        return figure

    return noted


def save(figure: Figure, path: Path) -> Path:
    """Write a figure atomically in the format of the path's suffix. Returns the path.

    The same flight gives the same bytes: no date is written.
    """
    kind = path.suffix[1:]
    style = figure.style if isinstance(figure, StyledFigure) else current_style()
    date = {"CreationDate": None} if kind == "pdf" else None
    with atomic_write(path) as partial, under(style):
        if isinstance(figure, StyledFigure):
            figure.fix_labels()
        figure.savefig(partial, format=kind, dpi=style.dots(figure.get_figwidth()), metadata=date)
    return path
