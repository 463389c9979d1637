"""`tandemlift identify` and `shadow`: logs of a vehicle, for its numbers, and through the pilot of a mission."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import click

from tandemlift.apps.cli import flying
from tandemlift.apps.cli.completion import FLIGHTS, MISSIONS
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.cli.run import write_results
from tandemlift.apps.export.results import results_folder
from tandemlift.core.errors import InputError

columns_option = click.option(
    "--columns", metavar="FILE", help="Map of streams to columns or topics, a .toml file; a .csv needs it, or --format."
)
format_option = click.option(
    "--format",
    metavar="NAME",
    help="Program that wrote it: optitrack, vicon, blackbox, crazyflie, px4, ardupilot or rosbag-csv.",
)
align_option = click.option(
    "--align",
    is_flag=True,
    help="Find offset and drift of motion capture and joints against the IMU, and correct them.",
)


@click.command()
@click.argument("log", shell_complete=FLIGHTS)
@click.option("--mission", required=True, shell_complete=MISSIONS, help="Mission of the vehicle: a name, or a file.")
@columns_option
@format_option
@align_option
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME-shadow]")
@flying.set_option
@flying.figures_option
@flying.strict_option
def shadow(
    log: str, mission: str, out: str | None, settings: tuple[str, ...], no_figures: bool, strict: bool, **reading: Any
) -> None:
    """Run a mission's pilot beside the LOG of a real flight.

    Nothing is simulated: estimators, pilot and detectors take the readings in LOG, and say what they would have felt,
    commanded and suspected, beside the commands that were flown. LOG is a bag (.bag, .mcap), a ULog of PX4 (.ulg), a
    table (.csv) or a saved flight; docs/how-to/log-a-vehicle.md says what it must hold. Units and frames are checked.

    \b
    Examples:
      tandemlift shadow flight.ulg --mission mine.toml --align
      tandemlift shadow log.csv --columns map.toml --mission mine.toml --set phases.lift_start=4.2
      tandemlift shadow out/iris --mission iris

    Files in the results folder: those of `tandemlift run`; flight.npz also has the channel flown_rotor_commands.

    Exit code 3: the log breaks a limit of the mission's flight; with --strict, also findings.
    """
    import tandemlift as tl

    began, loaded = time.perf_counter(), flying.load(mission, settings)
    taken = tl.read_log(log, **reading)
    echo(*taken.notes)
    with results_folder(out, Path("out") / f"{loaded.mission.name}-shadow", flying.FILES, mission) as folder:
        with progress_bar("Shadowing", "steps", shown=sys.stderr.isatty()) as progress:
            flight = tl.shadow(taken, loaded, progress=progress)
        write_results(flight, folder, began, None, figures=not no_figures)
    flying.exit_if_amiss({flight.name: flight}, strict=strict)


@click.command()
@click.argument("logs", nargs=-1, required=True, shell_complete=FLIGHTS)
@click.option("--mission", required=True, shell_complete=MISSIONS, help="Mission of about such a vehicle.")
@columns_option
@format_option
@align_option
@flying.set_option
@click.option("--weighed", multiple=True, metavar="KEY=KG", help="A mass from a scale. Can be repeated.")
@click.option("--parameters", metavar="A,B,…", help="Keys to estimate.  [default: all that can be]")
@click.option("--window", type=float, default=1.0, show_default=True, metavar="S", help="Length of a window.")
@click.option("--one-body", is_flag=True, help="LOGS are of several recorders in one flight: join them by its turn.")
@click.option("--predict", metavar="LOG", help="Another flight, which the identified vehicle predicts.")
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME-identification]")
@flying.style_option
def identify(
    logs: tuple[str, ...],
    mission: str,
    settings: tuple[str, ...],
    weighed: tuple[str, ...],
    parameters: str | None,
    window: float,
    one_body: bool,
    predict: str | None,
    out: str | None,
    **reading: Any,
) -> None:
    """Identify a vehicle from LOGS of its flights.

    Masses, centre of mass, inertias, thrust and yaw drag of the rotors, their lags and delay, drag: each with an
    interval of 95 %. What the flight did not excite keeps its prior, and is named. Weigh one part: without joint
    sensors, commands and IMU tell only the ratios of masses to thrust constants. LOGS are files as `shadow` takes them.

    \b
    Examples:
      tandemlift identify out/iris-excited --mission iris --weighed vehicle.payload.mass=0.5
      tandemlift identify one.ulg two.ulg --mission start.toml --align --out out/mine
      tandemlift identify left.ulg right.ulg tracker.csv --one-body --columns map.toml --mission start.toml

    \b
    Files in the results folder (other files there are left alone):
      vehicle.toml          the mission with the identified vehicle; intervals as comments
      identification.json   all numbers
      identification.html   fits, residuals, correlations, prediction of what was held back
    """
    import tandemlift as tl
    from tandemlift.analysis.logs.joining import joined
    from tandemlift.pictures.report.identification_report import write_identification

    start, masses = flying.load(mission, settings), dict(map(_weighed, weighed))
    paths = [*logs, *([predict] if predict else [])]
    read = [tl.read_log(path, **reading) for path in paths]
    other = read.pop() if predict else None
    read = [joined(read)] if one_body else read
    echo(*(note for log in [*read, *([other] if other else [])] for note in log.notes))
    keys = parameters.split(",") if parameters else None
    with results_folder(out, Path("out") / f"{start.mission.name}-identification", ()) as folder:
        with progress_bar("Identifying", "steps", shown=sys.stderr.isatty()) as progress:
            found = tl.identify(
                read, start, parameters=keys, weighed=masses, window=window, predict=other, progress=progress
            )
        echo(*found.lines())
        for path in [*found.save(folder), write_identification(found.as_dict(), folder)]:
            echo(f"  {path.suffix[1:]}: {path}")


def _weighed(text: str) -> tuple[str, float]:
    """The key and the mass of an option.

    Raises:
        InputError: it is not KEY=KG.
    """
    key, _, value = text.partition("=")
    try:
        return key, float(value)
    except ValueError:
        raise InputError(f"--weighed {text}: must be KEY=KG, such as vehicle.payload.mass=0.5") from None
