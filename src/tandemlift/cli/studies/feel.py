"""`tandemlift feel`: what a push feels like with a mission's keys, whether it can be had, and numbers for a wish."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.terminal.check_table import print_checks
from tandemlift.cli.terminal.console import echo, progress_bar
from tandemlift.cli.terminal.mission_options import FAILED, load, set_option
from tandemlift.cli.terminal.results import results_folder
from tandemlift.common.errors import FlightWarning

if TYPE_CHECKING:
    from tandemlift.report.feel_report import FeelReport

FILES = ("feel.json", "feel.html", "feel.png", "feel.pdf")


@click.command()
@click.argument("mission")
@set_option
@click.option("--wish", metavar="TEXT", help='Propose keys for a wish, such as "1 N gives 0.6 m/s in 1.5 s along x".')
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME]")
@click.option("--strict", is_flag=True, help="Exit with code 3 if a check fails.")
def feel(mission: str, settings: tuple[str, ...], wish: str | None, out: str | None, strict: bool) -> None:
    """Show what a push does with the keys of MISSION, and check whether the vehicle can answer so.

    The standard push is the force of `[admittance.feel]`, or 1 N. Along each axis it is held until the speed is steady,
    and let go: by the closed form of the admittance, and flown with filters, delays, limits and rotors. A person then
    leads the vehicle through mission zigzag with this admittance.

    With --wish, the keys that fulfil the wish are printed as TOML, and studied in place of the mission's.

    \b
    Examples:
      tandemlift feel iris
      tandemlift feel iris --set admittance.feel.preset=firm
      tandemlift feel iris --wish "1 N gives 0.6 m/s in 0.5 s"
      tandemlift feel iris --wish "2 N gives 0.6 m/s in 1 s along x and y; 1 N gives 0.3 m/s in 2 s"

    \b
    Files in the results folder (other files there are left alone):
      feel.html   table, figure and checks on one page that needs no network
      feel.json   all numbers in SI units
      feel.png    speed over time along each axis; and feel.pdf

    \b
    Exit code:
      0   the keys were studied
      2   bad input: one message, nothing is written
      3   with --strict: a check fails
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)  # of pushes that are not flown here
        loaded = load(mission, settings)
    from tandemlift.report.feel_report import feel as felt
    from tandemlift.studies.feel.wish import proposed, toml_of, with_proposal

    if wish is not None:
        tables = proposed(loaded, wish)
        echo(toml_of(loaded, tables))
        loaded = with_proposal(loaded, tables)
    with results_folder(out, Path("out") / loaded.mission.name, FILES) as folder:
        with progress_bar("Flying", 2, shown=sys.stderr.isatty()) as progress:
            report = felt(loaded, progress=progress)
        _print(report)
        report.save(folder)
        echo(f"  page: {folder / 'feel.html'}")
    if strict and report.study.fails:
        sys.exit(FAILED)


def _print(report: FeelReport) -> None:
    from tandemlift.studies.feel.feel_study import HEADS, sentences_of, table_of

    study = report.study
    echo(f"{study.mission.mission.name}: the answer to a standard push, closed form → flown")
    rows = [("", *HEADS), *table_of(study)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        echo("  " + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip())
    for sentence in sentences_of(study):
        echo(f"  {sentence}")
    print_checks(study.checks)
