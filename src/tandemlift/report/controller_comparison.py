"""The page of a comparison of controllers: one HTML file that needs nothing else: table, errors, thrusts, settings."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tandemlift.controllers import CONTROLLERS
from tandemlift.figures.captions import Caption
from tandemlift.files import whole
from tandemlift.flight.record import Flight
from tandemlift.missions import format_toml
from tandemlift.report.flight_report import DASH, figure_of, number, table_of
from tandemlift.report.page import COMPARISON, STYLE
from tandemlift.report.setup import setup_of
from tandemlift.studies.controller_comparison import Entry, scores

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Column = tuple[str, str, Callable[[dict[str, Any]], Any]]


def _of_axis(i: int) -> Callable[[dict[str, Any]], Any]:
    return lambda s: 1e3 * s["position_rmse_m"][i] if s["position_rmse_m"] else None


def _scaled(name: str, factor: float) -> Callable[[dict[str, Any]], Any]:
    return lambda s: None if s[name] is None else factor * s[name]


COLUMNS: tuple[Column, ...] = (  # heading, unit, value; the least of each is the best
    *((f"RMSE {axis}", "mm", _of_axis(i)) for i, axis in enumerate("xyz")),
    ("Largest error", "mm", _scaled("position_max_error_m", 1e3)),
    ("Effort", "N m", _scaled("effort_n_m", 1.0)),
    ("Saturated", "%", _scaled("rotor_saturated_share", 1e2)),
    ("Time a step", "ns", _scaled("step_ns", 1.0)),
)
NOTE = """Errors are desired minus actual position, {when}; the effort is the mean norm of the commanded moments
over the same time; saturated is the share of all steps in which a rotor is at a limit. Bold: the least of those that
did not diverge."""
CAPTIONS = {
    "errors": Caption(
        "Errors",
        "Errors of position, desired minus actual, along x, y and z, of all controllers. The first 10 s, in which a "
        "disturbed start is left behind, have a scale of their own. A controller that diverges does not set the scale.",
        "Panels over time for x, y and z: the error of position of every controller, the first ten seconds apart.",
    ),
    "thrusts": Caption(
        "Thrusts",
        "What the rotors give: the mean thrust of all rotors as a line, over the least to the greatest of any of them; "
        "scaled to what follows the first second.",
        "A panel over time for each controller: mean thrust of the rotors, and the band of the least to the greatest.",
    ),
}


def _row(entry: Entry, best: Sequence[float | None]) -> str:
    """A controller's row of the table; what is the best of its column is set in bold."""
    head = f'<th scope="row">{escape(entry.name)}</th>'
    if entry.flight is None:
        return f'<tr>{head}<td class="one" colspan="{len(COLUMNS)}">{DASH}</td><td>{escape(entry.refusal)}</td></tr>'
    found = scores(entry.flight)
    values = [value(found) for _, _, value in COLUMNS]
    cells = "".join(
        f"<td><b>{number(v)}</b></td>"
        if v is not None and v == least and not found["diverged"]
        else f"<td>{number(v)}</td>"
        for v, least in zip(values, best, strict=True)
    )
    return f"<tr>{head}{cells}<td>{escape(found['diverged'] or 'flown to the end')}</td></tr>"


def _least(entries: Sequence[Entry], value: Callable[[dict[str, Any]], Any]) -> float | None:
    """The least of a column, of those that did not diverge; None if they are all alike."""
    found = {value(scores(e.flight)) for e in entries if e.flight and not e.flight.divergence} - {None}
    return min(found) if len(found) > 1 else None


def _table(entries: Sequence[Entry]) -> str:
    best = [_least(entries, value) for _, _, value in COLUMNS]
    heads = "".join(f'<th scope="col">{head}<br><small>{unit}</small></th>' for head, unit, _ in COLUMNS)
    head = f'<tr><th scope="col">Controller</th>{heads}<th scope="col">Outcome</th></tr>'
    return table_of(head, (_row(entry, best) for entry in entries), "compared")


def figures_as_html(drawn: Mapping[str, Figure], captions: Mapping[str, Caption]) -> str:
    """The section of a page with figures, by name, each with the caption of that name."""
    from tandemlift.figures.drawing.style import save

    shown = []
    with tempfile.TemporaryDirectory() as folder:
        for place, (name, figure) in enumerate(drawn.items(), 1):
            png = save(figure, Path(folder) / f"{name}.png")
            shown.append(figure_of(place, name, png, captions[name]))
    return f"<section>\n<h2>Figures</h2>\n{chr(10).join(shown)}\n</section>"


def setup_as_html(flight: Flight, without: Sequence[str] = ()) -> str:
    """What was flown, but for some parts of it."""
    rows = [
        f'<tr><th scope="row">{escape(what)}</th><td>{escape(said)}</td></tr>'
        for what, said in setup_of(flight)
        if what not in without
    ]
    return table_of("", rows, "setup")


def versions_as_html(flight: Flight) -> str:
    """What a flight was flown with, but for its engine."""
    return escape(", ".join(f"{name} {version}" for name, version in flight.version.items() if name != "engine"))


def _settings(flights: Mapping[str, Flight]) -> str:
    shown = []
    for name, flight in flights.items():
        about = CONTROLLERS[name].summary if name in CONTROLLERS else ""
        text = format_toml({"controller": flight.mission["controller"]})
        shown.append(
            f"<details>\n<summary>{escape(name)}: {escape(about)}</summary>\n<pre><code>{escape(text)}</code></pre>\n"
            "</details>"
        )
    return f"<section>\n<h2>Settings</h2>\n{chr(10).join(shown)}\n</section>"


def write_comparison(entries: Sequence[Entry], path: str | os.PathLike[str]) -> Path:
    """Write a comparison of controllers as one HTML file without references; it appears whole or not at all.

    Args:
        entries: from `compare`; at least one has flown.
        path: of the HTML file; its folder is there.

    Returns:
        The path.
    """
    from tandemlift.figures.controller_comparison import draw_errors, draw_thrusts

    path, flights = Path(path), {e.name: e.flight for e in entries if e.flight}
    first = next(iter(flights.values()))
    late = any(scores(flight)["after_s"] for flight in flights.values())
    text = COMPARISON.format(
        name=escape(first.name),
        style=STYLE,
        what="controllers",
        kind="Controllers",
        where=f"engine <b>{escape(first.version.get('engine', ''))}</b>",
        note=NOTE.format(when="after 10 s" if late else "of the whole flight"),
        table=_table(entries),
        figures=figures_as_html({"errors": draw_errors(flights), "thrusts": draw_thrusts(flights)}, CAPTIONS),
        setup=setup_as_html(first, without=["Pilot"]),
        settings=_settings(flights),
        versions=versions_as_html(first),
    )
    with whole(path) as partial:
        partial.write_text(text, "utf-8")
    return path
