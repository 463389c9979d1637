"""`tandemlift compare`: one mission with several controllers, or in several engines, as a table and a page."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tandemlift.apps.cli.completion import CONTROLLERS, MISSIONS, names, separated
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.cli.flying import (
    FAILED,
    FIGURES,
    chosen_controller,
    engine_option,
    exit_if_found,
    kept_style_option,
    load,
    parse_setting,
    print_findings,
    results_folder,
    set_option,
    strict_option,
)
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.analysis.studies.comparison import MissionComparison
    from tandemlift.analysis.studies.comparison_scores import Score

STEMS = {"controllers": "compare", "engines": "engines"}  # of the files
KINDS = ("html", "json", "csv", "tex")
WIDTHS = {"controllers": 9, "engines": 18}  # at least, of a column of the table


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
    """Fly MISSION with several controllers, or in several engines.

    A table is printed, and a page written. The mission's own controller flies with the mission's settings, every other
    one with its defaults. Keys of `controller` given by --set apply to the mission's own controller only. Wall times
    are those of one flight each, and depend on the machine's load.

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
    from tandemlift.pictures.report.comparison import write_comparison_files

    if engines is not None and controllers is not None:
        raise InputError("--engines, --controllers: give only one of them")
    entered = _entered(mission, controllers, engine, engines, settings)
    stem = STEMS[entered.of]
    with results_folder(out, Path("out") / entered.name, [f"{stem}.{kind}" for kind in KINDS]) as folder:
        with progress_bar("Flying", "flights", shown=sys.stderr.isatty()) as progress:
            found = entered.fly(progress)
        _print_tables(found)
        page = write_comparison_files(found, folder, stem, folder / FIGURES if style is not None else None)
        echo(f"  page: {page}")
    count = print_findings(found.flights.items())
    failed = {name: flight.failure for name, flight in found.flights.items() if flight.failure}
    for name, failure in failed.items():
        click.echo(f"{name}: {failure}", err=True)
    if failed:
        sys.exit(FAILED)
    exit_if_found(count, strict=strict)


def _entered(
    mission: str, controllers: str | None, engine: str, engines: str | None, settings: tuple[str, ...]
) -> MissionComparison:
    """The comparison that the options ask for.

    Raises:
        InputError: a list is empty, a controller or an engine is unknown, or the mission cannot be loaded.
    """
    from tandemlift.analysis.studies.comparison import in_engines, with_controllers
    from tandemlift.engines.registry import engine_named

    if engines is not None:
        named = _names("--engines", engines, "compiled,mujoco")
        return in_engines(load(mission, settings), named)
    engine_named(engine)
    changes, chosen = dict(map(parse_setting, settings)), None
    if controllers is not None:
        chosen = [chosen_controller(name) for name in _names("--controllers", controllers, "nftsmc,pid")]
    return with_controllers(mission, changes, chosen, engine)


def _names(option: str, given: str, example: str) -> list[str]:
    """The names of a comma-separated list, without repetition.

    Raises:
        InputError: the list is empty.
    """
    names = list(dict.fromkeys(part.strip() for part in given.split(",") if part.strip()))
    if not names:
        raise InputError(f"{option}: must be a comma-separated list of names, such as {example}")
    return names


def _print_tables(found: MissionComparison) -> None:
    """Print a table for each part of the mission; the first also has flights that failed or were refused."""
    first = next(iter(found.flights))
    for place, table in enumerate(found.tables):
        words = table.part.words
        if not table.columns:
            echo(f"  {words.capitalize()} every position error is below 1 µm.")
            continue
        what = f"largest difference from {first}" if found.of == "engines" else f"position errors {words}"
        echo(f"{found.name}: {what}")
        columns = [c for c in table.columns if c.printed and any(c.name in scores for scores in table.rows.values())]
        sizes = [max(WIDTHS[found.of], len(c.printed)) for c in columns]
        entries = [entry for entry in found.entries if entry.flight or not place]
        width = max(len(entry.name) for entry in entries) + 2
        echo("  " + " " * width + "  ".join(c.printed.rjust(n) for c, n in zip(columns, sizes, strict=True)))
        for name, _, _, refusal, flight in entries:
            cells = [_cell(column, table.rows[name]) for column in columns] if flight else []
            row = "  ".join(cell.rjust(n) for cell, n in zip(cells, sizes, strict=False))
            echo(f"  {name.ljust(width)}{row}".rstrip())
            note = flight.failure if flight else f"not flown: {refusal}"
            if note and not place:
                echo(f"  {'':{width}}{note}")


def _cell(column: Score, scores: Mapping[str, Any]) -> str:
    value = column.value(scores)
    return "" if value is None else f"{column.scale * value:{column.form}}"
