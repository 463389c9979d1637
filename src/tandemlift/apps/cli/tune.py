"""`tandemlift tune`: search values of a mission that minimize metrics, and compare them on holdout draws."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tandemlift.apps.cli import flying
from tandemlift.apps.cli.completion import MISSIONS, keys, names
from tandemlift.apps.cli.console import compile_notices, echo, print_checks
from tandemlift.apps.export.results import results_folder
from tandemlift.core.errors import without_flight_warnings

if TYPE_CHECKING:
    from tandemlift.analysis.studies.tuning.candidates import Cost
    from tandemlift.analysis.studies.tuning.result import Tuning
    from tandemlift.analysis.studies.tuning.tune import TuneProgress

NOT_BETTER = 1
FILES = ("tuned.toml", "evidence.json", "tune.html")


def search_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a search."""
    for option in (
        click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME-tuned]"),
        flying.set_option,
        click.option("--strict", is_flag=True, help="A flight with findings counts as a bad outcome, too."),
        click.option("--threads", type=click.IntRange(min=1), help="Threads that fly.  [default: one a processor]"),
        click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of search and draws."),
        click.option("--budget", type=int, metavar="N", help="Candidates to try.  [default: 60 populations]"),
        click.option("--holdout", default=200, show_default=True, help="Flights that compare old and new in the end."),
    ):
        command = option(command)
    return command


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option(
    "--minimize",
    "goals",
    multiple=True,
    required=True,
    metavar="METRIC[=TARGET]",
    shell_complete=names("metric"),
    help="Metric to minimize, by its name in metrics.json, or one component: position_rmse_m.2. Can be repeated.",
)
@click.option(
    "--parameter",
    "parameters",
    multiple=True,
    metavar="KEY[=RANGE]",
    shell_complete=keys,
    help="Value to search: a dotted key, a table or a pattern, and [low, high]. Can be repeated."
    "  [default: the controller's gains]",
)
@click.option("--draws", default="8", show_default=True, metavar="N|FILE", help="Flights that compare candidates.")
@click.option("--aim", default="mean", show_default=True, metavar="mean|worst", help="Which of all draws counts.")
@flying.controller_option("Tune this controller")
@search_options
def tune(
    mission: str,
    goals: tuple[str, ...],
    parameters: tuple[str, ...],
    draws: str,
    controller: str | None,
    settings: tuple[str, ...],
    out: str | None,
    **how: Any,
) -> None:
    """Search values of MISSION that minimize metrics.

    Old and new are then compared on draws that the search never used. Every candidate flies the same draws. A bad
    outcome counts first; then the metrics, each over its target or its present value; see docs/how-to/tuning.md.

    \b
    Examples:
      tandemlift tune flight-ready --minimize position_rmse_after_10s_m --set actuators.model=rotors
      tandemlift tune iris --minimize position_rmse_after_10s_m --parameter controller.gains --draws 16
      tandemlift tune one-push --minimize human_work_j --parameter 'admittance.damping=[0.5, 4.0]'
      tandemlift tune iris --minimize position_rmse_m.0 --minimize moment_max_abs_after_10s_n_m.0

    \b
    Files in the results folder (other files there are left alone):
      tuned.toml     the mission with the new values; `tandemlift run` flies it
      evidence.json  task, every cost, and old against new on every holdout draw
      tune.html      all of it on one page that needs no network
      figures/       cost over candidates; old and new on holdout draws (PNG and PDF)

    Mission and evidence so far are written after each population of candidates. The same command goes on there.

    Exit code 1: the new values are not better on holdout draws. 130: Ctrl-C; the best so far is written.
    """
    from tandemlift.analysis.studies.tuning.goals import goal_of
    from tandemlift.analysis.studies.tuning.parameters import range_of
    from tandemlift.analysis.studies.tuning.tune import tune as tuned

    chosen = controller and flying.chosen_controller(controller).name
    given = int(draws) if re.fullmatch("[0-9]{1,9}", draws) else draws
    how |= {"goals": dict(map(goal_of, goals)), "parameters": dict(map(range_of, parameters))}
    _search(tuned, mission, settings, out, {**how, "draws": given, "controller": chosen})


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option("--hidden", default=6, show_default=True, help="Hidden units of a new network.")
@click.option("--persons", default=24, show_default=True, help="Random persons who compare candidates.")
@search_options
def train(mission: str, settings: tuple[str, ...], out: str | None, **how: Any) -> None:
    """Train a policy that minimizes the person's work in MISSION.

    A small network that sets the virtual damping (`[compliance.policy]`). The search begins with the mission's own
    weights, or with none: its admittance. Every candidate flies with the same random persons, old and new are then
    compared with others; see docs/how-to/train-a-policy.md. Files and exit codes are those of `tandemlift tune`.

    
    Examples:
      tandemlift train zigzag --budget 320
      tandemlift train mine.toml --persons 16 --holdout 1000 --strict
    """
    from tandemlift.analysis.studies.tuning.tune import train as trained

    _search(trained, mission, settings, out, how)


def _search(
    search: Callable[..., Tuning], mission: str, settings: tuple[str, ...], out: str | None, how: dict[str, Any]
) -> None:
    """Search, write and print the result, and exit with its code."""
    from tandemlift.missions import load_mission
    from tandemlift.pictures.report.study.tuning_report import tuning_lines, write_results

    changes = dict(map(flying.parse_setting, settings))
    name = load_mission(mission, changes, controller=how.get("controller")).mission.name
    with results_folder(out, Path("out") / f"{name}-tuned", FILES) as folder:
        with compile_notices.together(), _progress() as progress:
            found = search(mission, changes=changes, progress=progress, folder=folder, **how)
        write_results(found, folder)
    echo(*tuning_lines(found), f"  mission: {folder / 'tuned.toml'}", f"  page: {folder / 'tune.html'}")
    if not found.is_finished:
        click.echo("stopped; the best so far is written, and was not flown on holdout draws", err=True)
        sys.exit(flying.INTERRUPTED)
    if not found.is_better:
        sys.exit(NOT_BETTER)


@contextmanager
def _progress() -> Iterator[TuneProgress | None]:
    """A progress bar with the lowest cost so far, on a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    with click.progressbar(length=1, label="Tuning", file=sys.stderr, item_show_func=lambda words: words) as bar:

        def update(done: int, total: int, lowest: Cost) -> None:
            bar.length = max(total, 1)
            bar.update(done - bar.pos, f"cost {lowest.ratio:.4g}" + (f", {lowest.bad} bad" if lowest.bad else ""))

        yield update


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@flying.set_option
@click.option("--strict", is_flag=True, help="Exit with code 3 if a check fails.")
def feel(mission: str, settings: tuple[str, ...], strict: bool) -> None:
    """Show the response to a push with the keys of MISSION.

    A standard push along each axis, by the closed form of the admittance, and checks whether the vehicle can respond
    so. `tandemlift tune` searches for better keys.

    \b
    Examples:
      tandemlift feel iris
      tandemlift feel iris --set admittance.feel.preset=firm
      tandemlift feel iris --set 'admittance.feel={force=1.0, speed=0.6, time=2.0}'

    Exit code 3: with --strict, a check fails.
    """
    from tandemlift.analysis.studies.feel import feel as examined

    with without_flight_warnings():  # of pushes that are not flown here
        found = examined(flying.load(mission, settings))
    echo(f"{found.mission.mission.name}: the response to a standard push, by the closed form of the admittance")
    echo(*(f"  {line}" for line in found.lines()))
    print_checks(found.checks)
    if strict and found.fails:
        sys.exit(flying.FAILED)
