"""`tandemlift compare`: one mission with several controllers, or in several engines, as a table and a page."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.completion import CONTROLLERS, MISSIONS, names, separated
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.cli.flying import (
    FIGURES,
    chosen_controller,
    engine_option,
    exit_if_amiss,
    kept_style_option,
    load,
    parse_setting,
    results_folder,
    set_option,
    strict_option,
)
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.analysis.studies.comparison import MissionComparison

STEMS = {"controllers": "compare", "engines": "engines"}  # of the files
KINDS = ("html", "json", "csv", "tex")


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
    from tandemlift.pictures.report.study.comparison import write_comparison_files

    if engines is not None and controllers is not None:
        raise InputError("--engines, --controllers: give only one of them")
    entered = _entered(mission, controllers, engine, engines, settings)
    stem = STEMS[entered.of]
    with results_folder(out, Path("out") / entered.name, [f"{stem}.{kind}" for kind in KINDS]) as folder:
        with progress_bar("Flying", "flights", shown=sys.stderr.isatty()) as progress:
            found = entered.fly(progress)
        for line in found.lines():
            echo(line)
        page = write_comparison_files(found, folder, stem, folder / FIGURES if style is not None else None)
        echo(f"  page: {page}")
    exit_if_amiss(found.flights, strict=strict)


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
