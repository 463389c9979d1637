"""The files of a comparison: its numbers, and all metrics as tables."""

from __future__ import annotations

import json
from pathlib import Path

from tandemlift.analysis.studies.comparison import MissionComparison
from tandemlift.core.files import write_file, write_together
from tandemlift.pictures.report.metric_tables import write_metric_tables


def write_comparison(found: MissionComparison, folder: Path, stem: str) -> None:
    """Write the numbers of a comparison as STEM.json, all metrics as STEM.csv and STEM.tex: all three, or none."""
    how = "with several controllers" if found.of == "controllers" else "in several engines"
    flown = {name: flight.metrics() for name, flight in found.flights.items()}
    with write_together(folder) as aside:
        write_file(aside / f"{stem}.json", json.dumps(found.as_json(), indent=2, allow_nan=False) + "\n")
        write_metric_tables(flown, aside, stem, f"Metrics of the mission {found.name} {how}")
