"""The files of a comparison: its numbers, and all metrics as tables."""

from __future__ import annotations

import json
from pathlib import Path

from tandemlift.analysis.studies.comparison import MissionComparison
from tandemlift.core.files import atomic_write
from tandemlift.pictures.report.metric_tables import write_metric_tables


def write_comparison(found: MissionComparison, folder: Path, stem: str) -> None:
    """Write the numbers of a comparison as STEM.json, and all metrics as STEM.csv and STEM.tex, atomically."""
    with atomic_write(folder / f"{stem}.json") as partial:
        partial.write_text(json.dumps(found.as_json(), indent=2, allow_nan=False) + "\n", "utf-8")
    how = "with several controllers" if found.of == "controllers" else "in several engines"
    flown = {name: flight.metrics() for name, flight in found.flights.items()}
    write_metric_tables(flown, folder, stem, f"Metrics of the mission {found.name} {how}")
