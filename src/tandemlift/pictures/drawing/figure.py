"""Styles of figures, by name, and the interface of a figure's file besides its drawing.

A style has the widths of a journal's columns, its type, and colours on white or on dark paper.

`with figure_style("elsevier"):` everything is drawn for that journal. Sizes are in inches at print size. Widths: IEEE,
"Preparation of papers", one and two columns; Elsevier, "Artwork sizing", single, 1.5 and double column; a slide of
16:9 is as large as beamer's. Colours on white are those of Okabe and Ito (2008), which everyone can distinguish.

Nothing here loads the drawing library.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, NamedTuple, Protocol

from tandemlift.core.errors import unknown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.flight.record import Flight

MM = 1.0 / 25.4  # in
DOTS = 300.0  # of a PNG in an inch
FULL_HD = 1920  # pixels across a slide
MAX_SLIDE_HEIGHT = 4.4  # in: the height of a figure for a page that a slide has room for


class Palette(NamedTuple):
    """The colours of a figure. Areas are `pale`, `light_blue`, `ground` and `glass`; `tan` stands behind."""

    paper: str = "#ffffff"
    ink: str = "#000000"
    blue: str = "#0072B2"
    vermillion: str = "#D55E00"
    green: str = "#009E73"
    orange: str = "#E69F00"
    purple: str = "#CC79A7"
    sky: str = "#56B4E9"
    dim: str = "#6e6e6e"
    grey: str = "#8c8c8c"
    pale: str = "#d9d9d9"
    grid: str = "#e6e6e6"
    light_blue: str = "#a9d6f0"
    tan: str = "#e0b878"
    ground: str = "#f1eee7"
    glass: str = "#c3ccd6"
    edge: str = "#56616d"


DARK = Palette(
    paper="#15191e",
    ink="#e8ebee",
    blue="#58b6f0",
    vermillion="#ff8a47",
    green="#2fd09c",
    orange="#f2b632",
    purple="#e394c2",
    sky="#a5d8f7",
    dim="#a5adb5",
    grey="#8b949e",
    pale="#39424b",
    grid="#2a3138",
    light_blue="#1d4f70",
    tan="#94774a",
    ground="#25262a",
    glass="#48535f",
    edge="#a9b5c1",
)


class FigureStyle(NamedTuple):
    """The style of figures.

    Attributes:
        name: of the style.
        widths: that figures may have, from a column's to a page's [in].
        type: size of the text [pt].
        family: of the text; it comes with the drawing library, so that figures are the same on every machine.
        mathematics: the set of type for symbols that suits it.
        height: of a slide [in]; None if each figure has its own.
        palette: the colours.
    """

    name: str
    widths: tuple[float, ...]
    type: float = 8.5
    family: str = "STIXGeneral"
    mathematics: str = "stix"
    height: float | None = None
    palette: Palette = Palette()

    @property
    def column(self) -> float:
        """Width of the narrowest figure [in]."""
        return self.widths[0]

    @property
    def page(self) -> float:
        """Width of the widest figure [in]."""
        return self.widths[-1]

    def size(self, width: float, height: float) -> tuple[float, float]:
        """Size [in] of a figure of a width and a height for a page; all slides have one shape.

        A figure that is too high for a slide is drawn on a larger one, on which its type is smaller.
        """
        if self.height is None:
            return width, height
        scale = max(1.0, height / MAX_SLIDE_HEIGHT)
        return scale * self.page, scale * self.height

    def dots(self, width: float) -> float:
        """Dots in an inch of a PNG of a width [in]."""
        return DOTS if self.height is None else FULL_HD / width

    def width_for(self, width: float) -> float:
        """The narrowest width that is no less than another [in], or that of the page."""
        return min((w for w in self.widths if w >= width - 1e-9), default=self.page)


IEEE = FigureStyle("ieee", (3.5, 7.16))
ELSEVIER = FigureStyle("elsevier", (90.0 * MM, 140.0 * MM, 190.0 * MM))
SLIDES = FigureStyle(
    "slides",
    (160.0 * MM,),
    type=8.0,
    family="DejaVu Sans",
    mathematics="dejavusans",
    height=90.0 * MM,
)
STYLES = {style.name: style for style in (IEEE, ELSEVIER, SLIDES, SLIDES._replace(name="dark", palette=DARK))}
"""The styles by name; `dark` are slides on dark paper."""

_current = ContextVar("figure_style", default=IEEE)


def current_style() -> FigureStyle:
    """The style in which figures are drawn now; that of IEEE, unless `figure_style` has chosen another one."""
    return _current.get()


@contextmanager
def figure_style(name: str | None) -> Iterator[FigureStyle]:
    """Draw figures in a style, by its name, as long as the context lasts; None keeps the present one.

    Raises:
        InputError: there is no such style.
    """
    if name is not None and name not in STYLES:
        raise unknown("style of figures", name, STYLES)
    token = _current.set(current_style() if name is None else STYLES[name])
    try:
        yield current_style()
    finally:
        _current.reset(token)


# ---- The interface of a figure's file: its caption, and the flights that have the figure


class Caption(NamedTuple):
    """Title and text printed with a figure, and `alt`, a description for those who cannot see it."""

    title: str
    text: str
    alt: str


class FlightFigure(Protocol):
    """A file that draws a figure of a flight; its name is the figure's."""

    @property
    def CAPTION(self) -> Caption:
        """The caption."""

    @property
    def IN_FLIGHTS(self) -> Callable[[Flight], bool]:
        """Whether a flight has this figure."""

    @property
    def OVERLAY(self) -> Callable[[Mapping[str, Flight]], Figure] | None:
        """Draws several flights, by name, over each other; None where that would show nothing."""

    @property
    def draw(self) -> Callable[[Flight], Figure]:
        """Draws it."""


def all_flights(flight: Flight) -> bool:
    """True: a figure that every flight has."""
    return True


def with_any_of(*channels: str) -> Callable[[Flight], bool]:
    """For a figure of flights that have one of these channels."""
    return lambda flight: any(name in flight.channels for name in channels)


def with_walls(flight: Flight) -> bool:
    """Whether there are walls around a flight."""
    mission = flight.mission
    return bool(mission.get("walls") or mission.get("corridor", {}).get("centreline"))
