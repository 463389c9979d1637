"""The report of a flight: one HTML file that needs nothing else: verdict, set-up, figures, metrics and mission.

Captions stand with their figures in `pictures.figures`.
"""

from __future__ import annotations

import base64
import gzip
import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.core.errors import InputError
from tandemlift.core.files import FLIGHT_FILE, write_file, write_together
from tandemlift.core.types import Progress
from tandemlift.flight.record import Flight, counted_until
from tandemlift.pictures.figures.registry import captions, figures_for
from tandemlift.pictures.report.metric_tables import write_metric_tables
from tandemlift.pictures.report.page import (
    NO_BREAK,
    Cell,
    PageTable,
    Verdict,
    number,
    shown_figure,
    split_unit,
    write_page,
)
from tandemlift.pictures.report.printed_summary import notes
from tandemlift.pictures.report.second_drawer import draw_by_two

ARRIVED = 0.5  # m: a vehicle that ends farther from its reference has not arrived


class MetricCells(NamedTuple):
    """A metric on the page: its label, its name, a cell for each axis or a single one, and its unit."""

    words: str
    name: str
    cells: list[Cell]
    unit: str


def _cells(name: str, value: object, unit: str) -> list[Cell]:
    """The cells of a metric's value: one per axis, or a single one."""
    if name == "command_at_start" and isinstance(value, (list, tuple)):
        parts = (f"U{'₁₂₃₄'[i]} = {number(v)} {'N m' if i else 'N'}" for i, v in enumerate(value))
        return [", ".join(part.replace(" ", NO_BREAK) for part in parts)]
    values = list(value) if isinstance(value, (list, tuple)) and len(value) == 3 else [value]
    texts = [", ".join(map(number, v)) if isinstance(v, (list, tuple)) else number(v) for v in values]
    if unit != "rad":
        return [*texts]
    angles = [f"{number(math.degrees(v))}°" if isinstance(v, (int, float)) else "" for v in values]
    return [(text, angle) if angle else text for text, angle in zip(texts, angles, strict=True)]


def _metrics(metrics: Mapping[str, Any]) -> Iterator[MetricCells]:
    """The metrics that fit in a table, a row each."""
    for name, value in metrics.items():
        if name not in ("outcome", "events", "findings", "failure"):
            words, unit = split_unit(name)
            yield MetricCells(words, name, _cells(name, value, unit), unit)


def _verdict(flight: Flight) -> Verdict:
    """The final position with its reference, or the reason if the flight was stopped."""
    if flight.failure:
        what, _, why = flight.failure.partition(": ")
        return Verdict(what.capitalize(), f": {why}.", "failed")
    how = "Ended" if flight.outcome == "unknown" else flight.outcome.capitalize()
    metrics = flight.metrics()
    end, reference = metrics.get("final_position_m"), metrics.get("final_reference_m")
    if end is None or reference is None:
        return Verdict(how)
    away = math.dist(end, reference)
    distance = "less than a micrometre" if away < 1e-6 else _length(away)
    text = f" at {place_text(end)}, {distance} from its reference {place_text(reference)}."
    return Verdict(how, text, "missed" if away > ARRIVED else "")


def _length(metres: float) -> str:
    return f"{number(metres * 1e3)} mm" if metres < 1.0 else f"{number(metres)} m"


def place_text(point: Iterable[float]) -> str:
    """A point of space in metres, to the millimetre."""
    return f"({', '.join(f'{round(v, 3) + 0.0:.3f}'.replace('-', '−') for v in point)}) m"


def _pngs(flight: Flight, figures: str | os.PathLike[str] | Iterable[str | os.PathLike[str]]) -> dict[str, Path]:
    """The existing PNG files of a flight's figures by name."""
    given = Path(figures).glob("*.png") if isinstance(figures, (str, os.PathLike)) else map(Path, figures)
    found = {path.stem: path for path in given if path.suffix == ".png" and path.is_file()}
    # the drawing library is not loaded where nothing is drawn
    return {name: found[name] for name in figures_for(flight) if name in found} if found else {}


def mission_facts(flight: Flight) -> dict[str, Any]:
    """What is written of the flight's mission alone: `setup`, its `toml`, and whether it `is_built_in`, unchanged."""
    from tandemlift.missions import built_in, format_toml, load_mission, tables_of
    from tandemlift.pictures.report.setup_section import setup_rows

    is_built_in = flight.name in built_in() and tables_of(load_mission(flight.name)) == flight.mission
    return {"setup": setup_rows(flight), "toml": format_toml(flight.mission), "is_built_in": is_built_in}


def write_report(
    flight: Flight,
    figures: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    path: str | os.PathLike[str],
    replay: str | None = None,
    facts: Mapping[str, Any] | None = None,
) -> Path:
    """Write the report of a flight atomically as one HTML file without references.

    Args:
        flight: a flight, also one that diverged.
        figures: the folder that `save_figures` wrote to, or the files; what is not there, or is not this flight's, is
            left out.
        path: of the HTML file; its folder is made if it does not exist.
        replay: a page that plays the flight; the report opens with it, and with plots of the whole flight that zoom.
        facts: `mission_facts`, if they are known.

    Returns:
        The path.
    """
    facts, pngs = facts or mission_facts(flight), _pngs(flight, figures)
    words = captions() if pngs else {}
    return write_page(
        path,
        "flight",
        name=flight.name,
        engine=flight.version.get("engine"),
        packed=replay and base64.b64encode(gzip.compress(replay.encode(), mtime=0)).decode(),
        verdict=_verdict(flight),
        flight=flight,
        notes=list(notes(flight)),
        crash=counted_until(flight),
        place=place_text,
        setup=PageTable("setup", (), facts["setup"]),
        figures=[shown_figure(name, png, words[name]) for name, png in pngs.items()],
        metrics=list(_metrics(flight.metrics())),
        events=flight.metrics().get("events", []),
        mission=facts["toml"],
        is_built_in=facts["is_built_in"],
        versions=f"Flown with {', '.join(f'{name} {version}' for name, version in flight.version.items())}.",
    )


def write_flight_files(
    flight: Flight,
    folder: Path,
    *,
    figures: bool = True,
    progress: Progress | None = None,
    replay: str | None = None,
    facts: Mapping[str, Any] | None = None,
) -> None:
    """Write the files of a flight, and its figures and report; those of an earlier flight are removed.

    Args:
        flight: a flight, also one that diverged.
        folder: an existing folder.
        figures: whether to draw the figures.
        progress: called after each figure with (figures written, figures in all).
        replay: a page that plays the flight, for the report.
        facts: `mission_facts`, if they are known.
    """
    facts = facts or mission_facts(flight)
    _write_data(flight, folder, facts["toml"])
    (folder / "report.html").unlink(missing_ok=True)
    if any((folder / "figures").glob("*.p[nd][gf]")):
        for name in captions():
            for kind in ("png", "pdf"):
                (folder / "figures" / f"{name}.{kind}").unlink(missing_ok=True)
    if figures:
        draw_by_two(flight, folder / "figures", progress)
    write_report(flight, folder / "figures", folder / "report.html", replay, facts)


def _write_data(flight: Flight, folder: Path, toml: str) -> None:
    """Write mission, flight, metrics and findings: all of them, or none."""
    try:
        with write_together(folder) as aside:
            write_file(aside / "mission.toml", toml)
            flight.save(aside / FLIGHT_FILE)
            for file, data in (
                ("metrics.json", flight.metrics()),
                ("findings.json", [finding.as_table() for finding in flight.findings]),
            ):
                write_file(aside / file, json.dumps(data, indent=2, allow_nan=False) + "\n")
            note = f"Metrics of a flight of the mission {flight.name}"
            write_metric_tables({"value": flight.metrics()}, aside, "metrics", note)
    except OSError as error:
        raise InputError(
            f"{error.filename or folder}: the flight cannot be written: {error.strerror or error}"
        ) from error
