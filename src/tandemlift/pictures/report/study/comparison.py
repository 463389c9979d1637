"""The page of several flights of one mission: one HTML file that needs nothing else: tables, figures, set-up."""

from __future__ import annotations

import json
import os
from pathlib import Path

from tandemlift.analysis.studies.comparison import MissionComparison
from tandemlift.analysis.studies.comparison_scores import SETTLED
from tandemlift.core.files import atomic_write
from tandemlift.flight.record import Flight
from tandemlift.missions import format_toml
from tandemlift.pictures.report.metric_tables import write_metric_tables
from tandemlift.pictures.report.page import DASH, shown_figures, versions_of, write_page
from tandemlift.pictures.report.setup_section import setup_table


def _ending(found: MissionComparison, flight: Flight) -> str:
    """The reason of a failure; else that there is none, or where a flight in an engine ended [m]."""
    if flight.failure or found.of == "controllers":
        return flight.failure or "flown to the end"
    return ", ".join(f"{v + 0.0:.3f}".replace("-", "−") for v in flight.metrics().get("final_position_m") or ()) or DASH


def write_comparison(found: MissionComparison, path: str | os.PathLike[str], figures: Path | None = None) -> Path:
    """Write a comparison atomically as one HTML file without references.

    Args:
        found: flown; at least one entry has a flight.
        path: of the HTML file; its folder is there.
        figures: folder into which the figures are written as well.

    Returns:
        The path.
    """
    from tandemlift.pictures.report.study.comparison_figures import CAPTIONS, drawn_figures

    first, controllers = next(iter(found.flights.values())), found.of == "controllers"
    return write_page(
        path,
        "comparison",
        of=found.of,
        name=first.name,
        engines=[first.version.get("engine", "")] if controllers else list(found.flights),
        settled=f"{SETTLED:g}",
        table=found.table,
        best=found.table.best([name for name, flight in found.flights.items() if not flight.failure]),
        endings={e.name: _ending(found, e.flight) if e.flight else e.refusal for e in found.entries},
        figures=shown_figures(drawn_figures(found), CAPTIONS, figures),
        verdict=None,
        setup=setup_table(first, without=["Pilot"] if controllers else []),
        members={
            e.name: (e.summary, format_toml({"controller": e.flight.mission["controller"]}))
            for e in found.entries
            if e.flight
        },
        versions=f"Flown with {versions_of(first)}.",
    )


def write_comparison_files(found: MissionComparison, folder: Path, stem: str, figures: Path | None = None) -> Path:
    """Write STEM.html, its numbers STEM.json, and all metrics STEM.csv and STEM.tex; returns the path of the page."""
    with atomic_write(folder / f"{stem}.json") as partial:
        partial.write_text(json.dumps(found.as_json(), indent=2, allow_nan=False) + "\n", "utf-8")
    how = "with several controllers" if found.of == "controllers" else "in several engines"
    flown = {name: flight.metrics() for name, flight in found.flights.items()}
    write_metric_tables(flown, folder, stem, f"Metrics of the mission {found.name} {how}")
    return write_comparison(found, folder / f"{stem}.html", figures)
