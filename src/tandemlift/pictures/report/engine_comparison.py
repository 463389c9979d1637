"""The page of one mission in several engines: one HTML file that needs nothing else: table, figures, set-up."""

from __future__ import annotations

import os
from collections.abc import Mapping
from html import escape
from pathlib import Path

from tandemlift.analysis.studies.engine_comparison import (
    QUANTITIES,
    SETTLED,
    engine_summary,
    largest_differences,
    speed,
)
from tandemlift.flight.record import Flight
from tandemlift.pictures.report.controller_comparison import html_figures, html_setup, versions_of
from tandemlift.pictures.report.flight_report import DASH, html_table, number
from tandemlift.pictures.report.page import html, write_page

NOTE = f"""The same mission, pilot and random numbers; only the engine of the body differs. Differences are the largest
of any sample, against the first engine; those of joints from {SETTLED:g} s on. Steps a second include the pilot, on the
machine that wrote this page."""


def _row(name: str, flight: Flight, first: Flight) -> str:
    found = largest_differences(flight, first) if flight is not first else {}
    cells = "".join(f"<td>{number(found[q]) if q in found else DASH}</td>" for q in QUANTITIES)
    end = flight.metrics().get("final_position_m") or ()
    place = ", ".join(f"{v + 0.0:.3f}".replace("-", "−") for v in end) or DASH
    ended = escape(flight.failure) or place
    ends = f"<td>{ended}</td><td>{len(flight.findings)}</td><td>{number(round(speed(flight)))}</td>"
    return f'<tr><th scope="row">{escape(name)}</th>{cells}{ends}</tr>'


def _table(flights: Mapping[str, Flight]) -> str:
    first = next(iter(flights.values()))
    columns = [(name.replace("_", " ").capitalize(), unit) for name, unit in QUANTITIES.items()]
    columns += [("Ends at", "m"), ("Findings", ""), ("Steps", "1/s")]
    heads = "".join(f'<th scope="col">{escape(head)}<br><small>{unit}</small></th>' for head, unit in columns)
    rows = (_row(name, flight, first) for name, flight in flights.items())
    return html_table(f'<tr><th scope="col">Engine</th>{heads}</tr>', rows, "compared")


def _engines(flights: Mapping[str, Flight]) -> str:
    rows = (f'<tr><th scope="row">{e}</th><td>{escape(engine_summary(e))}</td></tr>' for e in flights)
    return f"<section>\n<h2>Engines</h2>\n{html_table('', rows, 'setup')}\n</section>"


def write_engines(flights: Mapping[str, Flight], path: str | os.PathLike[str], figures: Path | None = None) -> Path:
    """Write one mission in several engines atomically as one HTML file without references.

    Args:
        flights: by engine, from `engine_comparison.fly_in`.
        path: of the HTML file; its folder is there.
        figures: folder into which the figures are written as well.

    Returns:
        The path.
    """
    from tandemlift.pictures.report import engine_figures

    first = next(iter(flights.values()))
    return write_page(
        path,
        "comparison",
        name=first.name,
        kind="Engines compared",
        title="engines compared",
        about=html(f"Flown in engines <b>{escape(', '.join(flights))}</b>"),
        verdict="",
        note=html(NOTE),
        table=html(_table(flights)),
        figures=html(html_figures(engine_figures.drawn_figures(flights), engine_figures.CAPTIONS, figures)),
        setup=html(html_setup(first)),
        settings=html(_engines(flights)),
        versions=f"Flown with {versions_of(first)}.",
    )
