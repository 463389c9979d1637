"""The pages of reports: templates in data/report, each of which becomes one HTML file that needs nothing else.

Numbers, tables and figures as HTML, for all of them.
"""

from __future__ import annotations

import base64
import math
import os
import re
import struct
import tempfile
from collections.abc import Iterable, Mapping
from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from tandemlift.core.files import DATA, atomic_write
from tandemlift.flight.metric_descriptions import metric_of
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import DARK, current_style
from tandemlift.pictures.figures.registry import VIEWS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.pictures.drawing.figure import Caption

TEMPLATES = DATA / "report"
DASH = "–"  # a value that could not be computed
NO_BREAK = "\u00a0"
SCREEN = 0.45  # CSS pixels for a dot of print: figures are read at arm's length
WIDE = 600  # CSS pixels from where a figure scrolls sideways on a narrow screen instead of shrinking

html = Markup
"""Marks text as HTML; all other text is escaped by the templates."""


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def write_page(path: str | os.PathLike[str], template: str, **values: object) -> Path:
    """Write a page atomically.

    Args:
        path: of the HTML file; its folder is made if it does not exist.
        template: its name in data/report, without its ending.
        values: of the template's variables.

    Returns:
        The path.
    """
    text = _environment().get_template(f"{template}.html").render(values, bundle=_bundle)
    with atomic_write(Path(path)) as partial:
        partial.write_text(text, "utf-8")
    return Path(path)


def _bundle(name: str) -> Markup:
    """A file that is built from web/, to stand in a page."""
    return Markup((DATA / "page" / name).read_text("utf-8"))


def number(value: object) -> str:
    """A metric's value as HTML: four significant digits, or a power of ten; a dash for None."""
    if value is None:
        return DASH
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not math.isfinite(value):
        return escape(str(value))
    if isinstance(value, int) or 1e4 <= abs(value) < 1e7:
        text = f"{value:,.0f}".replace(",", "\u202f")
    elif value == 0 or 1e-3 <= abs(value) < 1e4:
        text = f"{value:#.4g}".rstrip(".") if value else "0"
    else:
        digits, power = f"{value:.2e}".split("e")
        text = f"{digits} × 10<sup>{int(power)}</sup>"
    return text.replace("-", "−")


def split_unit(name: str) -> tuple[str, str]:
    """A metric's name in words, and its unit ('' if it has none, or several)."""
    metric = metric_of(name)
    unit = "" if metric.units else metric.unit_of(0)
    stem = name.removesuffix("_" + re.sub("[ /]", "_", unit.lower())) if unit else name
    words = re.sub(r"(\d)s\b", r"\1 s", stem.replace("_", " ").replace("rmse", "RMSE"))
    words = "wall time" if words == "wall" else words
    return words[:1].upper() + words[1:], unit


def html_row(title: str, *cells: str) -> str:
    """A row of a table: its title and its cells, as HTML."""
    return f'<tr><th scope="row">{title}</th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'


def html_table(titles: Iterable[str], rows: Iterable[str], look: str) -> str:
    """A table as HTML, that scrolls sideways where it is too wide.

    Args:
        titles: of the columns; none for a table without a head.
        rows: each from `html_row`.
        look: its class in style.css.
    """
    cells = "".join(f'<th scope="col">{title}</th>' for title in titles)
    head = f"<thead><tr>{cells}</tr></thead>\n" if cells else ""
    body = f"<tbody>\n{chr(10).join(rows)}\n</tbody>"
    return f'<div class="table">\n<table class="{look}">\n{head}{body}\n</table>\n</div>'


def html_figure(place: int, name: str, png: Path, caption: Caption) -> str:
    """A picture in the page, with its number and caption.

    On a dark page, a drawing on white is inverted, and its hues turned back; a photograph is not.
    """
    data = png.read_bytes()
    width, height = (round(SCREEN * dots) for dots in struct.unpack(">II", data[16:24]))  # of the PNG's header
    source = f"data:image/png;base64,{base64.b64encode(data).decode()}"
    looks = ["wide"] * (width > WIDE) + ["drawn"] * (name != VIEWS and current_style().palette != DARK)
    look = f' class="{" ".join(looks)}"' if looks else ""
    image = f'<img{look} width="{width}" height="{height}" alt="{escape(caption.alt)}" src="{source}">'
    text = f"<b>Figure {place}. {escape(caption.title)}.</b> {escape(caption.text)}"
    return f'<figure id="{name}">\n<div class="sheet">{image}</div>\n<figcaption>{text}</figcaption>\n</figure>'


def html_figures(drawn: Mapping[str, Figure], captions: Mapping[str, Caption], folder: Path | None = None) -> str:
    """The section of a page with figures, by name, each with the caption of that name.

    They are also written as NAME.png and NAME.pdf into a folder, if one is given; it is made.
    """
    from tandemlift.pictures.drawing.style import save

    shown = []
    with tempfile.TemporaryDirectory() as aside:
        for place, (name, figure) in enumerate(drawn.items(), 1):
            png = save(figure, (folder or Path(aside)) / f"{name}.png")
            shown.append(html_figure(place, name, png, captions[name]))
            if folder:
                save(figure, folder / f"{name}.pdf")
    return f"<section>\n<h2>Figures</h2>\n{chr(10).join(shown)}\n</section>"


def versions_of(flight: Flight) -> str:
    """The packages and their versions that flew a flight; its engine is no package."""
    return ", ".join(f"{name} {version}" for name, version in flight.version.items() if name != "engine")


def with_keys(text: str) -> str:
    """A text as HTML whose `keys` are set as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))
