"""`tandemlift report`: figures and report of a saved flight or of a bag."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.terminal.console import echo
from tandemlift.cli.terminal.results import flight_file, results_folder, write_flight
from tandemlift.common.errors import InputError

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight

BAGS = (".bag", ".mcap")


@click.command()
@click.argument("flight")
@click.option(
    "--out",
    metavar="DIR",
    help="Folder for the results.  [default: that of the flight; of a bag out/NAME]",
)
@click.option("--no-figures", is_flag=True, help="Draw no figures.")
def report(flight: str, out: str | None, no_figures: bool) -> None:
    """Draw the figures and write the report of a saved flight or of a bag.

    FLIGHT is flight.npz or its folder, or a bag of ROS 1 (.bag) or ROS 2 (.mcap, or its folder) with the topics of
    docs/export.md: an exported one, or one recorded during a flight by `rosbag record` or `ros2 bag record`.

    \b
    Examples:
      tandemlift report flight.bag
      tandemlift report out/zigzag --out out/again

    \b
    Files in the results folder: those of `tandemlift run`. Other files there are left alone. The metrics of a bag are
    computed from its samples.

    \b
    Exit code:
      0   the report was written
      2   bad input: one message, nothing is written
    """
    loaded, default = _load(flight)
    with results_folder(out, default) as folder:
        echo(repr(loaded).strip("<>"))
        write_flight(loaded, folder, figures=not no_figures)
        echo(f"  report: {folder / 'report.html'}")


def _load(given: str) -> tuple[Flight, Path]:
    """Load the flight; the flight, and the default folder of its report.

    Raises:
        InputError: there is no such flight.
    """
    from tandemlift.export.reading import read_bag
    from tandemlift.flight.record import Flight

    path = Path(given)
    if path.suffix.lower() in BAGS or (path / "metadata.yaml").exists():
        if not path.exists():
            raise InputError(f"{given}: there is no such file")
        return read_bag(path), Path("out") / path.stem
    folder, saved = flight_file(given)
    if saved is None:
        raise InputError(
            f"{given}: must be flight.npz, its folder, or a bag (.bag, .mcap, or the folder of a ROS 2 bag)"
        )
    return Flight.load(saved), folder
