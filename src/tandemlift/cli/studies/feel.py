"""`tandemlift feel`: what a push feels like with a mission's keys, whether it can be had, and numbers for a wish."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.terminal.completion import MISSIONS
from tandemlift.cli.terminal.console import compile_notices, echo, progress_bar
from tandemlift.cli.terminal.mission_options import FAILED, load, set_option, style_option
from tandemlift.cli.terminal.results import results_folder
from tandemlift.common.errors import FlightWarning, InputError

if TYPE_CHECKING:
    from tandemlift.report.tuning.feel_report import FeelReport
    from tandemlift.settings import Mission
    from tandemlift.studies.feel.search import FeelSearch

FILES = ("feel.json", "feel.html", "feel.png", "feel.pdf", "feel.toml", "evidence.json")
NOT_BETTER = 1


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@set_option
@click.option("--wish", metavar="TEXT", help='Propose keys for a wish, such as "1 N gives 0.6 m/s in 1.5 s along x".')
@click.option("--search", is_flag=True, help="Search the numbers of least effort and jerk for random persons.")
@click.option("--generations", default=12, show_default=True, help="Of a search: populations of 8 candidates.")
@click.option("--persons", default=16, show_default=True, help="Of a search: persons who try each candidate.")
@click.option(
    "--fresh", default=200, show_default=True, help="Of a search: persons who compare old and new in the end."
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of a search and its persons.")
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME]")
@style_option
@click.option("--strict", is_flag=True, help="Exit with code 3 if a check fails.")
def feel(
    mission: str,
    settings: tuple[str, ...],
    wish: str | None,
    search: bool,
    generations: int,
    persons: int,
    fresh: int,
    seed: int,
    out: str | None,
    strict: bool,
) -> None:
    """Show what a push does with the keys of MISSION, and check whether the vehicle can answer so.

    A standard push along each axis, by the closed form of the admittance and flown; then a person in mission zigzag.
    With --wish, the keys that fulfil the wish are printed as TOML, and studied in place of the mission's; with
    --search, those of least effort and jerk with which no random person touches a wall.

    \b
    Examples:
      tandemlift feel iris
      tandemlift feel iris --set admittance.feel.preset=firm
      tandemlift feel iris --wish "1 N gives 0.6 m/s in 0.5 s"
      tandemlift feel iris --wish "2 N gives 0.6 m/s in 1 s along x and y; 1 N gives 0.3 m/s in 2 s"
      tandemlift feel iris --search

    \b
    Files in the results folder (other files there are left alone):
      feel.html      table, figure and checks on one page that needs no network
      feel.json      all numbers in SI units; feel.png, feel.pdf: the figure
      feel.toml      with --search: the mission with the new numbers; `tandemlift run` flies it
      evidence.json  with --search: old against new on persons that the search never saw

    \b
    Exit code:
      0   the keys were studied
      1   with --search: the new keys are not better on fresh persons; everything is written
      2   bad input: one message, nothing is written
      3   with --strict: a check fails
    """
    if wish is not None and search:
        raise InputError("--wish, --search: give only one of them")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)  # of pushes that are not flown here
        loaded = load(mission, settings)
    if wish is not None:
        loaded = _wished(loaded, wish)
    with results_folder(out, Path("out") / loaded.mission.name, FILES) as folder:
        found = _searched(loaded, (generations, persons, fresh), seed) if search else None
        report = _studied(found.mission if found else loaded, found)
        report.save(folder)
        echo(f"  page: {folder / 'feel.html'}")
    if strict and report.study.fails:
        sys.exit(FAILED)
    if found and not found.is_better:
        sys.exit(NOT_BETTER)


def _wished(mission: Mission, wish: str) -> Mission:
    """Print the keys that fulfil a wish; the mission with them."""
    from tandemlift.studies.feel.wish import proposed, toml_of, with_proposal

    tables = proposed(mission, wish)
    echo(toml_of(mission, tables))
    return with_proposal(mission, tables)


def _searched(mission: Mission, size: tuple[int, int, int], seed: int) -> FeelSearch:
    """Search a feel, and print it."""
    from tandemlift.studies.feel.search import SearchSize, search_feel
    from tandemlift.studies.feel.wish import toml_of

    with compile_notices.together(), progress_bar("Searching", 1, shown=sys.stderr.isatty()) as progress:
        found = search_feel(mission, SearchSize(*size), seed, progress)
    echo(toml_of(mission, found.tables))
    return found


def _studied(mission: Mission, found: FeelSearch | None) -> FeelReport:
    """Study a mission's keys, which a search may have found, and print what they feel like."""
    from tandemlift.cli.terminal.check_table import print_checks
    from tandemlift.report.tuning.feel_report import FeelReport
    from tandemlift.studies.feel.feel_study import study_feel

    with progress_bar("Flying", 2, shown=sys.stderr.isatty()) as progress:
        report = FeelReport(study_feel(mission, progress), found)
    echo(f"{mission.mission.name}: the answer to a standard push, closed form → flown")
    for line in report.lines():
        echo(f"  {line}")
    print_checks(report.checks)
    return report
