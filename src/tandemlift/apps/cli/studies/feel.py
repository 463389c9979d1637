"""`tandemlift feel`: what a push feels like with a mission's keys, and whether the vehicle can respond so."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import click

from tandemlift.apps.cli.terminal.completion import MISSIONS
from tandemlift.apps.cli.terminal.console import echo, progress_bar
from tandemlift.apps.cli.terminal.mission_options import FAILED, load, set_option, style_option
from tandemlift.apps.cli.terminal.results import results_folder
from tandemlift.core.errors import FlightWarning

FILES = ("feel.json", "feel.html", "feel.png", "feel.pdf")


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@set_option
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME]")
@style_option
@click.option("--strict", is_flag=True, help="Exit with code 3 if a check fails.")
def feel(mission: str, settings: tuple[str, ...], out: str | None, strict: bool) -> None:
    """Show what a push does with the keys of MISSION, and check whether the vehicle can respond so.

    A standard push along each axis, by the closed form of the admittance and flown. `tandemlift tune` searches for
    better keys.

    \b
    Examples:
      tandemlift feel iris
      tandemlift feel iris --set admittance.feel.preset=firm
      tandemlift feel iris --set 'admittance.feel={force=1.0, speed=0.6, time=2.0}'

    \b
    Files in the results folder (other files there are left alone):
      feel.html  table, figure and checks on one page that needs no network
      feel.json  all numbers in SI units; feel.png, feel.pdf: the figure

    \b
    Exit code:
      0   the keys were studied
      2   bad input: one message, nothing is written
      3   with --strict: a check fails
    """
    from tandemlift.apps.cli.terminal.check_table import print_checks
    from tandemlift.pictures.report.tuning.feel_report import feel as studied

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)  # of pushes that are not flown here
        loaded = load(mission, settings)
    name = loaded.mission.name
    with results_folder(out, Path("out") / name, FILES) as folder:
        with progress_bar("Flying", "rows", shown=sys.stderr.isatty()) as progress:
            report = studied(loaded, progress=progress)
        echo(f"{name}: the response to a standard push, closed form → flown")
        for line in report.lines():
            echo(f"  {line}")
        print_checks(report.checks)
        report.save(folder)
        echo(f"  page: {folder / 'feel.html'}")
    if strict and report.study.fails:
        sys.exit(FAILED)
