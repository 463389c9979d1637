"""The report of a flight: one HTML file that needs nothing else: verdict, set-up, figures, metrics and mission.

Captions stand with their figures in `pictures.figures`.
"""

from __future__ import annotations

import base64
import gzip
import json
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from tandemlift.core.files import FLIGHT_FILE, atomic_write
from tandemlift.core.findings import Finding
from tandemlift.core.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import built_in, format_toml, load_mission, tables_of
from tandemlift.pictures.figures.registry import VIEWS, captions, figures_for, save_photographs
from tandemlift.pictures.report.metric_tables import write_metric_tables
from tandemlift.pictures.report.page import (
    DASH,
    NO_BREAK,
    html,
    html_figure,
    html_table,
    number,
    split_unit,
    with_keys,
    write_page,
)
from tandemlift.pictures.report.second_drawer import second_drawer
from tandemlift.pictures.report.setup_section import html_setup

ARRIVED = 0.5  # m: a vehicle that ends farther from its reference has not arrived


def _cells(name: str, value: object, unit: str) -> str:
    """The table cells of a metric's value: one per axis, or one over all three columns."""
    if name == "command_at_start" and isinstance(value, (list, tuple)):
        parts = (
            f"U{'₁₂₃₄'[i]} = {number(v)} {'N m' if i else 'N'}".replace(" ", NO_BREAK) for i, v in enumerate(value)
        )
        return f'<td class="one" colspan="3">{", ".join(parts)}</td>'
    values = list(value) if isinstance(value, (list, tuple)) and len(value) == 3 else [value]
    single = len(values) == 1
    texts = [", ".join(map(number, v)) if isinstance(v, (list, tuple)) else number(v) for v in values]
    if unit == "rad":
        degrees = [math.degrees(v) if isinstance(v, (int, float)) else None for v in values]
        texts = [
            f"{t}<br><small>{number(d)}°</small>" if d is not None else t for t, d in zip(texts, degrees, strict=True)
        ]
    return "".join(f'<td class="one" colspan="3">{t}</td>' if single else f"<td>{t}</td>" for t in texts)


def _metrics(metrics: Mapping[str, Any]) -> str:
    """The metrics as a table, a row each."""
    rows = []
    for name, value in metrics.items():
        if name in ("outcome", "events", "findings", "failure"):
            continue
        words, unit = split_unit(name)
        head = f'<th scope="row">{escape(words)}<br><code>{escape(name)}</code></th>'
        rows.append(f"<tr>{head}{_cells(name, value, unit)}<td>{unit}</td></tr>")
    source = (
        "From every step, not from the log" if "steps" in metrics else "From the samples of a bag, not from every step"
    )
    note = f"{source}. Errors are desired minus actual. A dash ({DASH}): could not be formed."
    table = html_table(("Metric", "x or φ", "y or θ", "z or ψ", "Unit"), rows, "metrics")
    return f'<p class="soft">{note}</p>\n{table}{_events(metrics.get("events", []))}'


def _events(events: Iterable[tuple[float, str]]) -> str:
    """The events, a line each; nothing without supervision."""
    lines = "".join(f"<li>{at:.2f} s: {escape(what)}</li>" for at, what in events)
    return f"\n<p>Phases and alarms:</p>\n<ul>{lines}</ul>" if lines else ""


def _verdict(flight: Flight) -> str:
    """The final position with its reference, or the reason if the flight was stopped."""
    if flight.failure:
        what, _, why = flight.failure.partition(": ")
        return f'<p class="verdict failed"><strong>{escape(what).capitalize()}</strong>: {escape(why)}.</p>'
    how = "Ended" if flight.outcome == "unknown" else flight.outcome.capitalize()
    metrics = flight.metrics()
    end, reference = metrics.get("final_position_m"), metrics.get("final_reference_m")
    if end is None or reference is None:
        return f'<p class="verdict"><strong>{how}</strong>.</p>'
    away = math.dist(end, reference)
    distance = "less than a micrometre" if away < 1e-6 else _length(away)
    text = f"at {html_place(end)}, {distance} from its reference {html_place(reference)}"
    if away > ARRIVED:
        return f'<p class="verdict missed"><strong>{how}</strong> {text}.</p>'
    return f'<p class="verdict"><strong>{how}</strong> {text}.</p>'


def _length(metres: float) -> str:
    return f"{number(metres * 1e3)} mm" if metres < 1.0 else f"{number(metres)} m"


def html_findings(flight: Flight) -> str:
    """The findings as a list; a sentence if there are none, nothing for a flight that was never searched for any."""
    if not flight.findings:
        return '\n<p class="soft">No findings.</p>' if "findings" in flight.results else ""
    items = "\n".join(f"<li>{_item(finding)}</li>" for finding in flight.findings)
    return f'\n<h3>Findings</h3>\n<ul class="findings">\n{items}\n</ul>'


def _item(finding: Finding) -> str:
    where = "" if finding.place is None else f", at {html_place(finding.place)}"
    what = f"<strong>{escape(finding.kind)}</strong> at {finding.time:.2f} s{where}: {escape(finding.text)}."
    return f'{what}<br><span class="soft">What to do: {with_keys(finding.remedy)}.</span>'


def html_place(point: Iterable[float]) -> str:
    """A point of space in metres, to the millimetre."""
    return f"({', '.join(f'{round(v, 3) + 0.0:.3f}'.replace('-', '−') for v in point)}) m"


def _pngs(flight: Flight, figures: str | os.PathLike[str] | Iterable[str | os.PathLike[str]]) -> dict[str, Path]:
    """The existing PNG files of a flight's figures by name."""
    names = (VIEWS, *figures_for(flight))
    if isinstance(figures, (str, os.PathLike)):
        found = {name: Path(figures) / f"{name}.png" for name in names}
    else:
        found = {Path(p).stem: Path(p) for p in figures if Path(p).suffix == ".png"}
    return {name: found[name] for name in names if name in found and found[name].is_file()}


def _engine(flight: Flight) -> str:
    """The engine of the body, if the flight records it."""
    name = flight.version.get("engine")
    return f"Flown in engine <b>{escape(name)}</b>" if name else "Engine unknown"


def _again(flight: Flight) -> str:
    """The command that flies the same mission."""
    name = flight.name
    if name in built_in() and tables_of(load_mission(name)) == flight.mission:
        return f"<pre><code>tandemlift run {escape(name)}</code></pre>"
    save = "<p>Save the mission above as <code>mission.toml</code> (a run writes it beside this report), and</p>"
    return f"{save}\n<pre><code>tandemlift run mission.toml</code></pre>"


def write_report(
    flight: Flight,
    figures: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    path: str | os.PathLike[str],
    replay: str | None = None,
) -> Path:
    """Write the report of a flight atomically as one HTML file without references.

    Args:
        flight: a flight, also one that diverged.
        figures: the folder that `save_figures` wrote to, or the files; what is not there, or is not this flight's, is
            left out.
        path: of the HTML file; its folder is made if it does not exist.
        replay: a page that plays the flight; the report opens with it, and with plots of the whole flight that zoom.

    Returns:
        The path.
    """
    words = captions()
    shown = [html_figure(i, name, png, words[name]) for i, (name, png) in enumerate(_pngs(flight, figures).items(), 1)]
    return write_page(
        path,
        "flight",
        name=flight.name,
        about=html(_engine(flight)),
        packed=replay and base64.b64encode(gzip.compress(replay.encode(), mtime=0)).decode(),
        verdict=html(_verdict(flight) + html_findings(flight)),
        setup=html(html_setup(flight)),
        figures=html("\n".join(shown)),
        metrics=html(_metrics(flight.metrics())),
        mission=format_toml(flight.mission),
        again=html(_again(flight)),
        versions=f"Flown with {', '.join(f'{name} {version}' for name, version in flight.version.items())}.",
    )


def write_flight_files(
    flight: Flight,
    folder: Path,
    *,
    figures: bool = True,
    photographs: Sequence[tuple[str, bytes]] = (),
    progress: Progress | None = None,
    replay: str | None = None,
) -> None:
    """Write the files of a flight, and its figures and report; figures of an earlier flight are removed.

    Args:
        flight: a flight, also one that diverged.
        folder: an existing folder.
        figures: whether to draw the figures.
        photographs: title and JPEG of each photograph of a flight in Gazebo.
        progress: called after each figure with (figures written, figures in all).
        replay: a page that plays the flight, for the report.
    """
    with second_drawer(figures) as drawer:  # starts while the files are written
        _write_data(flight, folder)
        for name in captions():
            for kind in ("png", "pdf"):
                (folder / "figures" / f"{name}.{kind}").unlink(missing_ok=True)
        if figures:
            drawer.save_figures(flight, folder / FLIGHT_FILE, folder / "figures", progress)
    if photographs:
        save_photographs(photographs, folder / "figures")
    write_report(flight, folder / "figures", folder / "report.html", replay)


def _write_data(flight: Flight, folder: Path) -> None:
    """Write mission, flight, metrics and findings."""
    with atomic_write(folder / "mission.toml") as partial:
        partial.write_text(format_toml(flight.mission), "utf-8")
    flight.save(folder / FLIGHT_FILE)
    with atomic_write(folder / "metrics.json") as partial:
        partial.write_text(json.dumps(flight.metrics(), indent=2, allow_nan=False) + "\n", "utf-8")
    write_metric_tables(
        {"value": flight.metrics()}, folder, "metrics", f"Metrics of a flight of the mission {flight.name}"
    )
    with atomic_write(folder / "findings.json") as partial:
        found = [finding.as_table() for finding in flight.findings]
        partial.write_text(json.dumps(found, indent=2, allow_nan=False) + "\n", "utf-8")
