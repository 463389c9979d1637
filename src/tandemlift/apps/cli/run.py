"""`tandemlift run`: fly a mission, print a summary, write the results."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.terminal.completion import MISSIONS, names
from tandemlift.apps.cli.terminal.console import echo, progress_bar
from tandemlift.apps.cli.terminal.findings import exit_if_found, print_findings, strict_option
from tandemlift.apps.cli.terminal.mission_options import (
    FAILED,
    after_crash_option,
    chosen_controller,
    controller_option,
    load,
    parse_setting,
    set_option,
    style_option,
    with_after_crash,
)
from tandemlift.apps.cli.terminal.results import copy_recording, results_folder, write_flight
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission
    from tandemlift.parts.controllers import Controller

NOT_KNOWN = "   not known"


@click.command()
@click.argument("mission", required=False, shell_complete=MISSIONS)
@click.option("--from", "study", metavar="STUDY", help="Fly a row of a study instead: its folder, with --row.")
@click.option("--row", type=click.IntRange(min=0), help="Number of the row, as in the study's table and report.")
@click.option(
    "--engine",
    shell_complete=names("engine"),
    help="Engine that simulates the vehicle; see `tandemlift engines`.  [default: that of the recording, or compiled]",
)
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME]")
@set_option
@controller_option
@after_crash_option
@click.option("--no-figures", is_flag=True, help="Draw no figures.")
@style_option
@strict_option
def run(
    mission: str | None,
    study: str | None,
    row: int | None,
    engine: str | None,
    out: str | None,
    settings: tuple[str, ...],
    controller: str | None,
    after_crash: float | None,
    no_figures: bool,
    strict: bool,
) -> None:
    """Fly MISSION, print a summary and write the results.

    MISSION is a built-in mission (see `tandemlift missions`), the path of a .toml file, or a flight that a page saved
    (.zip).

    \b
    Examples:
      tandemlift run paper
      tandemlift run paper --set mission.duration=30 --set admittance.gate=soft
      tandemlift run one-push --set 'pushes.0.force=[0, 2, 0]' --out out/sideways
      tandemlift run hover --controller my_pd.py --set controller.stiffness=4
      tandemlift run --from out/gusts --row 17
      tandemlift run iris --style elsevier

    \b
    Files in the results folder (other files there are left alone):
      mission.toml   the mission with every key; `tandemlift run` flies it again
      flight.npz     all channels; read it with tl.Flight.load or NumPy
      metrics.json   the metrics in SI units, computed from every step; as tables metrics.csv and metrics.tex (LaTeX)
      findings.json  findings with time, place, number and remedy
      figures/       reference, path, tracking, inputs, interaction, joints; and push, disturbance, rotors,
                     surroundings, corridor where the mission has such parts (PNG and PDF)
      report.html    all of it on one page that needs no network

    \b
    Exit code:
      0   the flight was flown; findings are on standard error, a line each
      2   bad input: one message, nothing is written
      3   crashed, diverged, interrupted or not lifted: the flight so far is written; with --strict, also findings
    """
    began = time.perf_counter()
    chosen = None if controller is None else chosen_controller(controller)
    loaded, engine, name = _selected(mission, (study, row), with_after_crash(settings, after_crash), chosen, engine)
    with results_folder(out, Path("out") / name) as folder:
        flight = _fly(loaded, engine, chosen)
        print_summary(flight)
        copy_recording(loaded.person.recording, folder)
        write_flight(flight, folder, figures=not no_figures)
        print_report_path(folder, time.perf_counter() - began)
    count = print_findings([(flight.name, flight)])
    if flight.failure:
        click.echo(f"{flight.name}: {flight.failure}", err=True)
        sys.exit(FAILED)
    exit_if_found(count, strict=strict)


def _selected(
    mission: str | None,
    place: tuple[str | None, int | None],
    settings: tuple[str, ...],
    controller: Controller | None,
    engine: str | None,
) -> tuple[Mission, str | None, str]:
    """The mission to fly, its engine and the name of its results: a mission by name, or a row of a study by number.

    Raises:
        InputError: there is no such mission, study, row or engine.
    """
    from tandemlift.engines.registry import engine_named

    if engine is not None:
        engine_named(engine)
    if place != (None, None):
        loaded, own, name = _row_of(*place, settings, mission, controller)
        return loaded, engine or own, name
    if mission is None:
        raise click.UsageError("Missing argument 'MISSION'; `tandemlift missions` lists them.")
    loaded = load(mission, settings, controller)
    return loaded, engine, loaded.mission.name


def _row_of(
    study: str | None, row: int | None, settings: tuple[str, ...], mission: str | None, controller: Controller | None
) -> tuple[Mission, str, str]:
    """The mission, the engine and the name of a row of a study.

    Raises:
        InputError: there is no such study or row, the row is refused, or a mission or controller is given as well.
    """
    from tandemlift.analysis.studies.study import mission_of_row

    if study is None or row is None:
        raise InputError("--from STUDY --row N: give both, or neither")
    if mission is not None or controller is not None:
        given = f"MISSION {mission}" if mission is not None else "--controller"
        raise InputError(f"{given}: a row of a study has its own; leave it out with --from")
    return mission_of_row(Path(study), row, dict(map(parse_setting, settings)))


def _fly(mission: Mission, engine: str | None, controller: Controller | None) -> Flight:
    from tandemlift.parts.controllers import error_text, file_of
    from tandemlift.simulation.fly import fly
    from tandemlift.simulation.plan import takes_long

    try:
        with progress_bar("Flying", "steps", shown=takes_long(mission)) as progress:
            return fly(mission, engine, progress=progress)
    except InputError:
        raise
    except Exception as error:
        if controller is None or controller.start.__module__.startswith("tandemlift."):
            raise
        raise InputError(f"controller {controller.name!r} fails: {error_text(error, file_of(controller))}") from error


def print_report_path(folder: Path, seconds: float) -> None:
    """Print the path of the report and the time [s] spent in all: compiling, flying and writing."""
    echo(f"  report: {folder / 'report.html'} ({seconds:.2f} s in all)")


def print_summary(flight: Flight) -> None:
    """Print the main metrics and the events of a flight."""
    m = flight.metrics()
    late = "_after_10s" if m["position_rmse_after_10s_m"] else ""
    when = "after 10 s" if late else "whole flight"
    rows = [
        ("final position", _list(m["final_position_m"], 3), "m"),
        ("final reference", _list(m["final_reference_m"], 3), "m"),
        (f"position RMSE, {when}", _list(m[f"position_rmse{late}_m"], 2, 1e3), "mm"),
        (f"largest position error, {when}", _list(m[f"position_max_error{late}_m"], 2, 1e3), "mm"),
        ("attitude RMSE", _list(m["attitude_rmse_rad"], 2, 57.29577951308232), "deg"),
        ("thrust after 10 s", _list([m["thrust_min_after_10s_n"], m["thrust_max_after_10s_n"]], 2), "N (min, max)"),
        ("human work", *((NOT_KNOWN, "") if m["human_work_j"] is None else (_list([m["human_work_j"]], 2), "J"))),
    ]
    echo(f"{flight.name}: {flight.outcome}; {m['steps']} steps, flown in {m['wall_s'] * 1e3:.1f} ms")
    for label, value, unit in rows:
        if value:
            echo(f"  {label:36}{value} {unit}".rstrip())
    for at, what in m["events"]:
        echo(f"  {at:.2f} s: {what}")


def _list(values: list[float | None] | None, digits: int, scale: float = 1.0) -> str:
    """Numbers side by side; '' if there are none."""
    if not values or any(v is None for v in values):
        return ""
    return "  ".join(f"{round(v * scale, digits) + 0.0:8.{digits}f}" for v in values if v is not None)
