"""`tandemlift compare`: one mission with several controllers, as a table and a page."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tandemlift.apps.cli.completion import CONTROLLERS, MISSIONS, names, separated
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.cli.flying import (
    FAILED,
    chosen_controller,
    engine_option,
    exit_if_found,
    kept_style_option,
    load,
    print_findings,
    set_option,
    strict_option,
)
from tandemlift.core.errors import InputError
from tandemlift.core.files import FIGURES, atomic_write, parse_setting, results_folder

if TYPE_CHECKING:
    from tandemlift.analysis.studies.controller_comparison import Entrant, Entry, ScoredPart
    from tandemlift.flight.record import Flight
    from tandemlift.parts.controllers import Controller

FILES = ("compare.html", "compare.json", "compare.csv", "compare.tex")
ENGINE_FILES = ("engines.html", "engines.json", "engines.csv", "engines.tex")


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option(
    "--controllers",
    metavar="A,B,…",
    shell_complete=separated(CONTROLLERS),
    help="Controllers: names, or your .py files.  [default: all]",
)
@engine_option
@click.option(
    "--engines",
    metavar="A,B,…",
    shell_complete=separated(names("engine")),
    help="Compare engines instead: fly the mission once in each.",
)
@set_option
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME]")
@kept_style_option
@strict_option
def compare(
    mission: str,
    controllers: str | None,
    engine: str,
    engines: str | None,
    settings: tuple[str, ...],
    out: str | None,
    style: str | None,
    strict: bool,
) -> None:
    """Fly MISSION with several controllers, or in several engines, print a table and write a page.

    The mission's own controller flies with the mission's settings, every other one with its defaults. Keys of
    `controller` given by --set apply to the mission's own controller only. Wall times are those of one flight each, and
    depend on the machine's load.

    \b
    Examples:
      tandemlift compare iris
      tandemlift compare iris --controllers nftsmc,pid,lqr --set 'disturbance.force=[3, 3, 0]'
      tandemlift compare hover --controllers nftsmc,my_pd.py --out out/mine
      tandemlift compare zigzag --engines compiled,mujoco,gazebo
      tandemlift compare iris --style ieee

    \b
    Files in the results folder (other files there are left alone):
      compare.html   table, errors and thrusts on one page that needs no network
      compare.json   the same as numbers in SI units, with all metrics and settings
      engines.html   with --engines: the flights, and their differences from the first
      engines.json   with --engines: the same as numbers in SI units
      *.csv, *.tex   all metrics, a column for each controller or engine, for a spreadsheet and for LaTeX
      figures/       with --style: the figures of the page (PNG and PDF)

    \b
    Exit code:
      0   all flights were flown; findings are on standard error, a line each
      2   bad input: one message, nothing is written
      3   a flight crashed, diverged or did not lift: its row has the reason; everything is written; with --strict,
          also a flight with findings
    """
    if engines is not None:
        if controllers is not None:
            raise InputError("--engines, --controllers: give only one of them")
        names = _names("--engines", engines, "compiled,mujoco")
        _compare_engines(mission, names, settings, out, strict=strict, keep=style is not None)
        return
    from tandemlift.analysis.studies.controller_comparison import entrants
    from tandemlift.engines.registry import engine_named

    engine_named(engine)
    changes = dict(map(parse_setting, settings))
    entered = entrants(mission, changes, _chosen(controllers))
    name = next(e.mission.mission.name for e in entered if e.mission)
    with results_folder(out, Path("out") / name, FILES) as folder:
        entries = _fly(entered, engine)
        _print_tables(name, entries)
        _write(entries, folder, name, engine, keep=style is not None)
        echo(f"  page: {folder / 'compare.html'}")
    _exit_if_amiss({e.name: e.flight for e in entries if e.flight}, strict=strict)


def _exit_if_amiss(flights: Mapping[str, Flight], *, strict: bool) -> None:
    """Print findings and failures, and end the process if there is a failure, or, if strict, a finding."""
    count = print_findings(flights.items())
    failed = {name: flight.failure for name, flight in flights.items() if flight.failure}
    for name, failure in failed.items():
        click.echo(f"{name}: {failure}", err=True)
    if failed:
        sys.exit(FAILED)
    exit_if_found(count, strict=strict)


def _chosen(given: str | None) -> list[Controller] | None:
    """The controllers of a comma-separated list, without repetition; None for all.

    Raises:
        InputError: the list is empty, or a controller is unknown.
    """
    if given is None:
        return None
    return [chosen_controller(name) for name in _names("--controllers", given, "nftsmc,pid")]


def _names(option: str, given: str, example: str) -> list[str]:
    """The names of a comma-separated list, without repetition.

    Raises:
        InputError: the list is empty.
    """
    names = list(dict.fromkeys(part.strip() for part in given.split(",") if part.strip()))
    if not names:
        raise InputError(f"{option}: must be a comma-separated list of names, such as {example}")
    return names


def _fly(entered: Sequence[Entrant], engine: str) -> list[Entry]:
    from tandemlift.analysis.studies.controller_comparison import compare

    with progress_bar("Flying", "flights", shown=sys.stderr.isatty()) as progress:
        return compare(entered, engine, progress)


HEADS = ("RMSE x", "y", "z (mm)", "max (mm)", "effort (N m)")
FLIGHT_HEADS = ("saturated (%)", "findings", "wall ns/step")


def _printed(value: float | None, scale: float, digits: int) -> str:
    return "" if value is None else f"{scale * value:.{digits}f}"


def _scores(flight: Flight, part: ScoredPart) -> list[str]:
    """The cells of `HEADS`."""
    from tandemlift.analysis.studies.controller_comparison import scores

    s = scores(flight, part)
    errors = [_printed(value, 1e3, 3) for value in s["position_rmse_m"] or (None, None, None)]
    return [*errors, _printed(s["position_max_error_m"], 1e3, 3), _printed(s["effort_n_m"], 1.0, 3)]


def _run(flight: Flight) -> list[str]:
    """The cells of `FLIGHT_HEADS`."""
    from tandemlift.analysis.studies.controller_comparison import run_of

    found = run_of(flight)
    return [
        _printed(found["rotor_saturated_share"], 1e2, 2),
        str(found["findings"]),
        _printed(found["step_ns"], 1.0, 0),
    ]


def _print_rows(heads: Sequence[str], rows: Sequence[tuple[str, list[str], str]]) -> None:
    """Print a table whose rows are a name, cells, and a note for the line below (or an empty one)."""
    width = max(len(name) for name, _, _ in rows) + 2
    echo("  " + " " * width + "  ".join(head.rjust(max(9, len(head))) for head in heads))
    for name, cells, note in rows:
        filled = (cell.rjust(max(9, len(head))) for cell, head in zip(cells, heads, strict=False))
        echo(f"  {name.ljust(width)}{'  '.join(filled)}".rstrip())
        if note:
            echo(f"  {'':{width}}{note}")


def _print_tables(name: str, entries: Sequence[Entry]) -> None:
    """Print a table for each part of the mission; the first also names flights that diverged or were refused."""
    from tandemlift.analysis.studies.controller_comparison import moving_axes, parts_of

    flights = {e.name: e.flight for e in entries if e.flight}
    counts, *others = parts_of(flights.values())
    rows = []
    for entry in entries:
        if entry.flight:
            cells = [*_scores(entry.flight, counts), *_run(entry.flight)]
            rows.append((entry.name, cells, entry.flight.failure))
        else:
            rows.append((entry.name, [], f"not flown: {entry.refusal}"))
    echo(f"{name}: position errors {counts.words}")
    _print_rows((*HEADS, *FLIGHT_HEADS), rows)
    for part in others:
        if any(moving_axes(flights.values(), part)):
            echo(f"{name}: position errors {part.words}")
            _print_rows(HEADS, [(controller, _scores(flight, part), "") for controller, flight in flights.items()])
        else:
            echo(f"  {part.words.capitalize()} every position error is below 1 µm.")


def _write(entries: Sequence[Entry], folder: Path, name: str, engine: str, *, keep: bool) -> None:
    from tandemlift.analysis.studies.controller_comparison import summary_of
    from tandemlift.pictures.report.controller_comparison import write_comparison
    from tandemlift.pictures.report.metric_tables import write_metric_tables

    found: dict[str, Any] = {"mission": name, "engine": engine, "controllers": summary_of(entries)}
    _write_json(found, folder / "compare.json")
    flown = {e.name: e.flight.metrics() for e in entries if e.flight}
    write_metric_tables(flown, folder, "compare", f"Metrics of the mission {name} with several controllers")
    write_comparison(entries, folder / "compare.html", folder / FIGURES if keep else None)


def _write_json(found: object, path: Path) -> None:
    with atomic_write(path) as partial:
        partial.write_text(json.dumps(found, indent=2, allow_nan=False) + "\n", "utf-8")


def _compare_engines(
    mission: str, names: list[str], settings: tuple[str, ...], out: str | None, *, strict: bool, keep: bool
) -> None:
    """Fly a mission in several engines, print their differences and write the page."""
    from tandemlift.analysis.studies.engine_comparison import fly_in, summary_of
    from tandemlift.pictures.report.engine_comparison import write_engines
    from tandemlift.pictures.report.metric_tables import write_metric_tables

    loaded = load(mission, settings)
    with results_folder(out, Path("out") / loaded.mission.name, ENGINE_FILES) as folder:
        with progress_bar("Flying", "flights", shown=sys.stderr.isatty()) as progress:
            flights = fly_in(loaded, names, progress)
        found = summary_of(flights)
        _print_differences(loaded.mission.name, found)
        _write_json({"mission": loaded.mission.name, "engines": found}, folder / "engines.json")
        flown = {engine: flight.metrics() for engine, flight in flights.items()}
        write_metric_tables(
            flown, folder, "engines", f"Metrics of the mission {loaded.mission.name} in several engines"
        )
        page = write_engines(flights, folder / "engines.html", folder / FIGURES if keep else None)
        echo(f"  page: {page}")
    _exit_if_amiss(flights, strict=strict)


def _print_differences(name: str, found: Sequence[dict[str, Any]]) -> None:
    """Print a row for each engine: the largest differences from the first engine, and the speed."""
    from tandemlift.analysis.studies.engine_comparison import QUANTITIES

    shown = [q for q in QUANTITIES if q in found[0]["difference"]]
    heads = [f"{q.replace('_', ' ')} ({QUANTITIES[q]})" for q in shown] + ["wall steps/s"]
    width = max(len(row["engine"]) for row in found) + 2
    echo(f"{name}: largest difference from {found[0]['engine']}")
    echo("  " + " " * width + "  ".join(head.rjust(18) for head in heads))
    for row in found:
        cells = [f"{row['difference'][q]:.1e}" if row is not found[0] else "" for q in shown]
        line = "  ".join(cell.rjust(18) for cell in [*cells, f"{row['steps_per_s']:,.0f}"])
        echo(f"  {row['engine'].ljust(width)}{line}")
