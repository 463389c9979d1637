"""The pages of reports: templates in data/report, each of which becomes one HTML file that needs nothing else.

Numbers, tables and figures for all of them; parts.html sets them.
"""

from __future__ import annotations

import base64
import math
import os
import re
import struct
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from tandemlift.analysis.studies.metric_descriptions import metric_of
from tandemlift.core.files import DATA, atomic_write
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import DARK, current_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.pictures.drawing.figure import Caption

TEMPLATES = DATA / "report"
DASH = "–"  # a value that could not be computed
NO_BREAK = "\u00a0"
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
SCREEN = 0.45  # CSS pixels for a dot of print: figures are read at arm's length

html = Markup
"""Marks text as HTML; all other text is escaped by the templates."""

Cell = str | tuple[str, str]
"""A text in a table; of a pair, the second one is small and below the first."""


class PageTable(NamedTuple):
    """A table of a page.

    Attributes:
        look: its class in style.css.
        titles: of the columns; none for a table without a head.
        rows: the title and the cells of each.
    """

    look: str
    titles: Sequence[Cell]
    rows: Iterable[Sequence[Cell]]


class Verdict(NamedTuple):
    """The first words of a page: a strong text, the rest of the sentence, and its class, "missed" or "failed"."""

    head: str
    text: str = "."
    look: str = ""


@cache
def _environment() -> Environment:
    made = Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters["keys"] = with_keys
    made.globals |= {"parts": made.get_template("parts.html").module, "bundle": _bundle}
    return made


def write_page(path: str | os.PathLike[str], template: str, **values: object) -> Path:
    """Write a page atomically.

    Args:
        path: of the HTML file; its folder is made if it does not exist.
        template: its name in data/report, without its ending.
        values: of the template's variables.

    Returns:
        The path.
    """
    text = _environment().get_template(f"{template}.html").render(values)
    with atomic_write(Path(path)) as partial:
        partial.write_text(text, "utf-8")
    return Path(path)


def _bundle(name: str) -> Markup:
    """A file that is built from web/, to stand in a page."""
    return Markup((DATA / "page" / name).read_text("utf-8"))


def number(value: object) -> str:
    """A metric's value: four significant digits, or a power of ten; a dash for None."""
    if value is None:
        return DASH
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not math.isfinite(value):
        return str(value)
    if isinstance(value, int) or 1e4 <= abs(value) < 1e7:
        text = f"{value:,.0f}".replace(",", "\u202f")
    elif value == 0 or 1e-3 <= abs(value) < 1e4:
        text = f"{value:#.4g}".rstrip(".") if value else "0"
    else:
        digits, power = f"{value:.2e}".split("e")
        text = f"{digits} × 10{str(int(power)).translate(RAISED)}"
    return text.replace("-", "−")


def split_unit(name: str) -> tuple[str, str]:
    """The name of a metric, or of a component as `position_rmse_m.0`, in words; its unit ('' for none, or several)."""
    above, _, place = name.rpartition(".")
    metric = metric_of(above)
    if place.isdecimal() and int(place) < len(metric.components):
        return f"{split_unit(above)[0]}, {metric.components[int(place)]}", metric.unit_of(int(place))
    metric = metric_of(name)
    unit = "" if metric.units else metric.unit_of(0)
    stem = name.removesuffix("_" + re.sub("[ /]", "_", unit.lower())) if unit else name
    words = re.sub(r"(\d)s\b", r"\1 s", stem.replace("_", " ").replace("rmse", "RMSE"))
    words = "wall time" if words == "wall" else re.sub("^(thrust|moment) m", r"commanded \1 m", words)
    return words[:1].upper() + words[1:], unit


class ShownFigure(NamedTuple):
    """A picture in a page: its name, its caption, its data, its size [CSS pixels], and its classes in style.css."""

    name: str
    caption: Caption
    data: str
    width: int
    height: int
    look: str


def shown_figure(name: str, png: Path, caption: Caption) -> ShownFigure:
    """A picture for a page.

    On a dark page, a drawing on white is inverted, and its hues turned back.
    """
    data = png.read_bytes()
    width, height = (round(SCREEN * dots) for dots in struct.unpack(">II", data[16:24]))  # of the PNG's header
    looks = "drawn" if current_style().palette != DARK else ""
    return ShownFigure(name, caption, base64.b64encode(data).decode(), width, height, looks)


def shown_figures(
    drawn: Mapping[str, Figure], captions: Mapping[str, Caption], folder: Path | None = None
) -> list[ShownFigure]:
    """Figures for a page, by name, each with the caption of that name.

    They are also written as NAME.png and NAME.pdf into a folder, if one is given; it is made.
    """
    from tandemlift.pictures.drawing.style import save

    shown = []
    with tempfile.TemporaryDirectory() as aside:
        for name, figure in drawn.items():
            png = save(figure, (folder or Path(aside)) / f"{name}.png")
            shown.append(shown_figure(name, png, captions[name]))
            if folder:
                save(figure, folder / f"{name}.pdf")
    return shown


def versions_of(flight: Flight) -> str:
    """The packages and their versions that flew a flight; its engine is no package."""
    return ", ".join(f"{name} {version}" for name, version in flight.version.items() if name != "engine")


def code(text: str) -> Markup:
    """A text set as code."""
    return Markup("<code>{}</code>").format(text)


def strong(text: str) -> Markup:
    """A text in bold."""
    return Markup("<strong>{}</strong>").format(text)


def with_keys(text: str) -> Markup:
    """A text whose `keys` are set as code."""
    parts = text.split("`")
    return Markup("").join(code(part) if i % 2 else part for i, part in enumerate(parts))
