"""The style of the figures: sizes and type of a journal's columns, colours that everyone can distinguish, and saving.

Sizes are in inches at print size. The colours are those of Okabe and Ito (2008). A figure is made, laid out and saved
under one fixed style, whatever the settings of the machine are; no figure is ever registered with a window system.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import matplotlib.style
import numpy as np
from matplotlib.figure import Figure

from tandemlift.common.files import atomic_write
from tandemlift.flight.record import Flight

COLUMN = 3.5  # in, one column of a two-column journal
PAGE = 7.16  # in, both columns
DPI = 300

BLACK = "#000000"
BLUE = "#0072B2"
GREEN = "#009E73"
VERMILLION = "#D55E00"
GREY = "#8c8c8c"
PALE = "#d9d9d9"
LIGHT_BLUE = "#a9d6f0"  # of areas; in grey print close to PALE: label both
TAN = "#e0b878"  # of what is noisy and stands behind

ACTUAL: dict[str, Any] = {"color": BLUE, "lw": 1.2}
DESIRED: dict[str, Any] = {"color": VERMILLION, "lw": 1.0, "ls": (0, (4, 2))}
COMPONENTS: tuple[dict[str, Any], ...] = (  # dashes distinguish them in grey print too
    {"color": BLUE, "lw": 1.0},
    {"color": VERMILLION, "lw": 1.0, "ls": (0, (5, 1.5))},
    {"color": GREEN, "lw": 1.1, "ls": (0, (1.2, 1.2))},
)

SETTINGS: dict[str, Any] = {
    "font.family": "STIXGeneral",  # comes with matplotlib, and is the type of most journals' text
    "font.size": 8.5,
    "mathtext.fontset": "stix",
    "axes.labelsize": 8.5,
    "axes.titlesize": 9,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "axes.formatter.limits": (-3, 5),
    "axes.formatter.useoffset": False,
    "axes.xmargin": 0.0,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.5,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "legend.borderaxespad": 0.2,
    "lines.solid_capstyle": "butt",
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "path.simplify": True,
    "pdf.fonttype": 42,  # TrueType, which journals ask for
    "figure.constrained_layout.h_pad": 0.03,
    "figure.constrained_layout.w_pad": 0.03,
}


def styled(draw: Callable[..., Figure]) -> Callable[..., Figure]:
    """Draw under the journal's style, and lay the figure out once."""

    @wraps(draw)
    def drawn(*arguments: Any) -> Figure:
        # a flight that diverged may hold infinities, whose differences are no news
        with matplotlib.style.context(["default", SETTINGS]), np.errstate(invalid="ignore", over="ignore"):
            figure = draw(*arguments)
            if layout := figure.get_layout_engine():
                layout.execute(figure)
                figure.set_layout_engine("none")  # else every saving would lay it out again
        return figure

    return drawn


def journal(draw: Callable[[Flight], Figure]) -> Callable[[Flight], Figure]:
    """Draw a flight under the journal's style, and say on the figure if it diverged."""

    @styled
    @wraps(draw)
    def noted(flight: Flight) -> Figure:
        figure = draw(flight)
        if flight.ending:
            note = f"{flight.ending.outcome} at {flight.ending.time:.5g} s"
            figure.supxlabel(note, x=0.01, ha="left", fontsize=8, color=VERMILLION)
        return figure

    return noted


def save(figure: Figure, path: Path) -> Path:
    """Write a figure in the format of the path's suffix; the file appears whole or not at all. Returns the path.

    The same flight gives the same bytes: no date is written.
    """
    kind = path.suffix[1:]
    date = {"CreationDate": None} if kind == "pdf" else None
    with atomic_write(path) as partial, matplotlib.style.context(["default", SETTINGS]):
        figure.savefig(partial, format=kind, dpi=DPI, metadata=date)
    return path
