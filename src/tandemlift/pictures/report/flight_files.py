"""The files of a flight: mission, channels, metrics, figures and report, written into one folder."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from tandemlift.core.files import atomic_write
from tandemlift.core.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import format_toml
from tandemlift.pictures.figures.registry import captions, save_figures, save_photographs
from tandemlift.pictures.report.flight_report import write_report
from tandemlift.pictures.report.metric_tables import write_metric_tables


def write_flight_files(
    flight: Flight,
    folder: Path,
    *,
    figures: bool = True,
    photographs: Sequence[tuple[str, bytes]] = (),
    progress: Progress | None = None,
) -> None:
    """Write the files of a flight, and its figures and report; figures of an earlier flight are removed.

    Args:
        flight: a flight, also one that diverged.
        folder: an existing folder.
        figures: whether to draw the figures.
        photographs: title and JPEG of each photograph of a flight in Gazebo.
        progress: called after each figure with (figures written, figures in all).
    """
    with atomic_write(folder / "mission.toml") as partial:
        partial.write_text(format_toml(flight.mission), "utf-8")
    flight.save(folder / "flight.npz")
    with atomic_write(folder / "metrics.json") as partial:
        partial.write_text(json.dumps(flight.metrics(), indent=2, allow_nan=False) + "\n", "utf-8")
    write_metric_tables(
        {"value": flight.metrics()}, folder, "metrics", f"Metrics of a flight of the mission {flight.name}"
    )
    with atomic_write(folder / "findings.json") as partial:
        found = [finding.as_table() for finding in flight.findings]
        partial.write_text(json.dumps(found, indent=2, allow_nan=False) + "\n", "utf-8")
    for name in captions():
        for kind in ("png", "pdf"):
            (folder / "figures" / f"{name}.{kind}").unlink(missing_ok=True)
    if figures:
        save_figures(flight, folder / "figures", progress)
    if photographs:
        save_photographs(photographs, folder / "figures")
    write_report(flight, folder / "figures", folder / "report.html")
