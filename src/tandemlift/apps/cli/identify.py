"""`tandemlift shadow`: a log of a vehicle through the pilot of a mission."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import click

from tandemlift.apps.cli.completion import FLIGHTS, MISSIONS
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.cli.flying import (
    FILES,
    exit_if_amiss,
    figures_option,
    load,
    set_option,
    strict_option,
)
from tandemlift.apps.cli.run import write_results
from tandemlift.apps.export.results import results_folder

columns_option = click.option(
    "--columns", metavar="FILE", help="Map of streams to columns or topics, a .toml file; a .csv needs one."
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
@align_option
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME-shadow]")
@set_option
@figures_option
@strict_option
def shadow(
    log: str,
    mission: str,
    columns: str | None,
    align: bool,
    out: str | None,
    settings: tuple[str, ...],
    no_figures: bool,
    strict: bool,
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

    began, loaded = time.perf_counter(), load(mission, settings)
    taken = tl.read_log(log, columns, align=align)
    for note in taken.notes:
        echo(note)
    with results_folder(out, Path("out") / f"{loaded.mission.name}-shadow", FILES) as folder:
        with progress_bar("Shadowing", "steps", shown=sys.stderr.isatty()) as progress:
            flight = tl.shadow(taken, loaded, progress=progress)
        write_results(flight, folder, began, None, figures=not no_figures)
    exit_if_amiss({flight.name: flight}, strict=strict)
