"""The page of a comparison of controllers: one HTML file that needs nothing else: table, errors, thrusts, settings."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tandemlift.analysis.studies.controller_comparison import (
    LEAST,
    Entry,
    ScoredPart,
    best_of,
    controller_summary,
    moving_axes,
    parts_of,
    run_of,
    scores,
)
from tandemlift.flight.record import Flight
from tandemlift.missions import format_toml
from tandemlift.pictures.report.flight_report import DASH, html_figure, html_table, number
from tandemlift.pictures.report.page import html, write_page
from tandemlift.pictures.report.setup_section import setup_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.pictures.figures.drawing.figure import Caption


class TableColumn(NamedTuple):
    """A column of a table.

    Attributes:
        heading: its title.
        unit: in which it is shown.
        name: of the score; `LEAST` has its smallest physical difference; without one no value is bold.
        scale: shown units for each SI unit.
        axis: the place of the value in a score of three numbers.
    """

    heading: str
    unit: str
    name: str
    scale: float = 1.0
    axis: int | None = None

    def value(self, found: Mapping[str, Any]) -> float | None:
        """The score in SI units."""
        value = found[self.name]
        return value if value is None or self.axis is None else value[self.axis]

    def shown(self, value: float | None) -> str:
        """A value as HTML, in the shown unit."""
        least = LEAST.get(self.name, 0.0)
        if value is not None and 0.0 < value < least:
            return f"&lt; {self.scale * least:g}"
        return number(None if value is None else self.scale * value)


OF_A_PART = (
    *(TableColumn(f"RMSE {axis}", "mm", "position_rmse_m", 1e3, i) for i, axis in enumerate("xyz")),
    TableColumn("Largest error", "mm", "position_max_error_m", 1e3),
    TableColumn("Effort", "N m", "effort_n_m"),
)
OF_A_FLIGHT = (
    TableColumn("Saturated", "%", "rotor_saturated_share", 1e2),
    TableColumn("Findings", "", "findings"),
    TableColumn("Wall time a step", "ns", "step_ns"),
)
COLUMNS = (*OF_A_PART, *OF_A_FLIGHT)
NOTE = """Errors are desired minus actual position in the air, {when}. The effort is the mean norm of the commanded
moments over the same time. Saturated is the fraction of steps in which a rotor is at a limit. Wall time is that of this
one flight, with whatever else the machine did: it is no measure of a controller's speed. Bold: the least value of those
that did not diverge, with all that are within 1 µm, 1 mN m or 0.01 % of it; nothing, where all are."""
STILL = "<p>{when} every position error is below 1 µm.</p>"


def _cells(column: TableColumn, found: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """A column's cells by controller; the best of those that did not diverge are bold."""
    values = {name: column.value(of) for name, of in found.items()}
    fair = [None if found[name]["failure"] else value for name, value in values.items()]
    best = best_of(fair, LEAST.get(column.name, math.inf))
    texts = zip(values.items(), best, strict=True)
    return {n: f"<td><b>{column.shown(v)}</b></td>" if won else f"<td>{column.shown(v)}</td>" for (n, v), won in texts}


def _of_flights(entries: Sequence[Entry], part: ScoredPart) -> str:
    """The table of the part that counts, with how each flight ended, or why there was none."""
    found = {e.name: scores(e.flight, part) | run_of(e.flight) for e in entries if e.flight}
    cells, rows = [_cells(column, found) for column in COLUMNS], []
    for name, flight, refusal in entries:
        filled, outcome = f'<td class="one" colspan="{len(COLUMNS)}">{DASH}</td>', refusal
        if flight:
            filled, outcome = "".join(of[name] for of in cells), found[name]["failure"] or "flown to the end"
        rows.append(f'<tr><th scope="row">{escape(name)}</th>{filled}<td>{escape(outcome)}</td></tr>')
    head = f'<tr><th scope="col">Controller</th>{_heads(COLUMNS)}<th scope="col">Outcome</th></tr>'
    return html_table(head, rows, "compared")


def _of_part(flights: Mapping[str, Flight], part: ScoredPart) -> str:
    """The table of another part; a sentence if nothing moves in it."""
    if not any(moving_axes(flights.values(), part)):
        return STILL.format(when=part.words.capitalize())
    found = {name: scores(flight, part) | run_of(flight) for name, flight in flights.items()}
    cells = [_cells(column, found) for column in OF_A_PART]
    rows = [f'<tr><th scope="row">{escape(n)}</th>{"".join(of[n] for of in cells)}</tr>' for n in found]
    table = html_table(f'<tr><th scope="col">Controller</th>{_heads(OF_A_PART)}</tr>', rows, "compared part")
    return f"<h3>{part.words.capitalize()}</h3>\n{table}"


def _heads(columns: Sequence[TableColumn]) -> str:
    return "".join(f'<th scope="col">{c.heading}<br><small>{c.unit}</small></th>' for c in columns)


def html_figures(drawn: Mapping[str, Figure], captions: Mapping[str, Caption], folder: Path | None = None) -> str:
    """The section of a page with figures, by name, each with the caption of that name.

    They are also written as NAME.png and NAME.pdf into a folder, if one is given; it is made.
    """
    from tandemlift.pictures.figures.drawing.style import save

    shown = []
    with tempfile.TemporaryDirectory() as aside:
        for place, (name, figure) in enumerate(drawn.items(), 1):
            png = save(figure, (folder or Path(aside)) / f"{name}.png")
            shown.append(html_figure(place, name, png, captions[name]))
            if folder:
                save(figure, folder / f"{name}.pdf")
    return f"<section>\n<h2>Figures</h2>\n{chr(10).join(shown)}\n</section>"


def html_setup(flight: Flight, without: Sequence[str] = ()) -> str:
    """The set-up of the flights, without some parts."""
    rows = [
        f'<tr><th scope="row">{escape(what)}</th><td>{escape(said)}</td></tr>'
        for what, said in setup_rows(flight)
        if what not in without
    ]
    return html_table("", rows, "setup")


def versions_of(flight: Flight) -> str:
    """The set-up of a flight, without its engine."""
    return ", ".join(f"{name} {version}" for name, version in flight.version.items() if name != "engine")


def _settings(flights: Mapping[str, Flight]) -> str:
    shown = []
    for name, flight in flights.items():
        about = controller_summary(name)
        text = format_toml({"controller": flight.mission["controller"]})
        shown.append(
            f"<details>\n<summary>{escape(name)}: {escape(about)}</summary>\n<pre><code>{escape(text)}</code></pre>\n"
            "</details>"
        )
    return f"<section>\n<h2>Settings</h2>\n{chr(10).join(shown)}\n</section>"


def write_comparison(entries: Sequence[Entry], path: str | os.PathLike[str], figures: Path | None = None) -> Path:
    """Write a comparison of controllers atomically as one HTML file without references.

    Args:
        entries: from `compare`; at least one has flown.
        path: of the HTML file; its folder is there.
        figures: folder into which the figures are written as well.

    Returns:
        The path.
    """
    from tandemlift.pictures.report import controller_figures

    flights = {e.name: e.flight for e in entries if e.flight}
    first = next(iter(flights.values()))
    counts, *others = parts_of(flights.values())
    tables = [_of_flights(entries, counts), *(_of_part(flights, part) for part in others)]
    return write_page(
        path,
        "comparison",
        name=first.name,
        kind="Controllers compared",
        title="controllers compared",
        about=html(f"Flown in engine <b>{escape(first.version.get('engine', ''))}</b>"),
        verdict="",
        note=html(NOTE.format(when=counts.words)),
        table=html("\n".join(tables)),
        figures=html(html_figures(controller_figures.drawn_figures(flights), controller_figures.CAPTIONS, figures)),
        setup=html(html_setup(first, without=["Pilot"])),
        settings=html(_settings(flights)),
        versions=f"Flown with {versions_of(first)}.",
    )
