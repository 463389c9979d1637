"""`tandemlift run`: fly a mission, print a summary, write the results."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli import flying
from tandemlift.apps.cli.completion import MISSIONS, names
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.export.results import results_folder
from tandemlift.core.errors import InputError
from tandemlift.core.files import write_file

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission
    from tandemlift.parts.controllers import Controller
    from tandemlift.simulation.known_flights import KnownFile


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
@flying.set_option
@flying.controller_option()
@flying.after_crash_option
@flying.figures_option
@flying.style_option
@flying.strict_option
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
      report.html    all of it on one page that needs no network; it opens with the flight in three dimensions

    Exit code 3: crashed, diverged, interrupted or not lifted; what was flown is written. With --strict, also findings.
    """
    from tandemlift.simulation.known_flights import KnownFile

    began, settings = time.perf_counter(), flying.with_after_crash(settings, after_crash)
    named = study is None and row is None and controller is None and engine in (None, "compiled")
    named = named and flying.PLUGINS not in click.get_current_context().meta
    file = KnownFile(mission, dict(map(flying.parse_setting, settings))) if mission and named else None
    known = file.flight() if file else None
    recording = None  # a known flight has none
    if known is None:
        from tandemlift.engines.registry import engine_named

        chosen = None if controller is None else flying.chosen_controller(controller)
        if engine is not None:
            engine_named(engine)
        loaded, own, name = _selected(mission, study, row, settings, chosen)
        recording = loaded.person.recording
    with results_folder(out, Path("out") / (known.name if known else name), flying.FILES, mission) as folder:
        flight = known.fly() if known else fly_mission(loaded, engine or own, file)
        write_results(flight, folder, began, recording, figures=not no_figures, file=file)
    flying.exit_if_amiss({flight.name: flight}, strict=strict)


def _selected(
    mission: str | None, study: str | None, row: int | None, settings: tuple[str, ...], controller: Controller | None
) -> tuple[Mission, str | None, str]:
    """The mission to fly, its engine and the name of its results: a mission by name, or a row of a study by number.

    Raises:
        InputError: there is no such mission, study or row, the row is refused, or it is given beside a mission or
            controller.
    """
    if study is None and row is None:
        if mission is None:
            raise click.UsageError("Missing argument 'MISSION'; `tandemlift missions` lists them.")
        loaded = flying.load(mission, settings, controller)
        return loaded, None, loaded.mission.name
    if study is None or row is None:
        raise InputError("--from STUDY --row N: give both, or neither")
    if mission is not None or controller is not None:
        given = f"MISSION {mission}" if mission is not None else "--controller"
        raise InputError(f"{given}: a row of a study has its own; leave it out with --from")
    from tandemlift.analysis.studies.study import mission_of_row

    return mission_of_row(Path(study), row, dict(map(flying.parse_setting, settings)))


def fly_mission(mission: Mission, engine: str | None, file: KnownFile | None = None) -> Flight:
    """Fly a mission, which may stand in a file, with a progress bar; an error of a user's controller names its line."""
    from tandemlift.core.plugs import explained
    from tandemlift.simulation.fly import fly_plan, plan_of

    try:
        p = plan_of(mission, engine)
        with progress_bar("Flying", "steps", shown=p.takes_long) as progress:
            flight, flown = fly_plan(p, progress)
    except Exception as error:
        if (told := explained(error)) is error:
            raise
        raise told from error
    if file:
        file.remember(p, flight, flown)
    return flight


def write_results(
    flight: Flight, folder: Path, began: float, recording: str | None, *, figures: bool, file: KnownFile | None = None
) -> None:
    """Print the summary of a flight, write its files, and print the time since `began` [s], by `time.perf_counter`.

    A recording that the mission flies, given by its path, is among the files. `file`: in which the mission stands.
    """
    from tandemlift.pictures.report.printed_summary import summary_lines

    echo(*summary_lines(flight))
    if recording is not None:  # so that the folder can be flown anywhere
        from tandemlift.missions.recording import recording_bytes

        write_file(folder / Path(recording).name, recording_bytes(recording))
    flying.write_flight(flight, folder, figures=figures, file=file)
    echo(f"  report: {folder / 'report.html'} ({time.perf_counter() - began:.2f} s in all)")
