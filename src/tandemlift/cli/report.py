"""`tandemlift report`: the figures and the page of a flight that was flown before, also of a bag."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.results import flight_file, results_in, write_results
from tandemlift.cli.run import echo
from tandemlift.common.errors import InputError

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight

BAGS = (".bag", ".mcap")


@click.command()
@click.argument("flight")
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: where the flight is, of a bag out/STEM]")
@click.option("--no-figures", is_flag=True, help="Leave the figures out.")
def report(flight: str, out: str | None, no_figures: bool) -> None:
    """Draw the figures and write the report of a flight that was flown before.

    FLIGHT is flight.npz or its folder; or a bag of our topics (docs/export.md): of ROS 1 (.bag), or of ROS 2 (.mcap, or
    its folder), one that was exported, or one that `rosbag record` or `ros2 bag record` wrote while it was flown.

    \b
    Examples:
      tandemlift report flight.bag
      tandemlift report out/zigzag --out out/again

    \b
    Written to the folder, replacing only files of these names: mission.toml, flight.npz, metrics.json, figures/,
    report.html, as by `tandemlift run`. The metrics of a bag are formed from its samples.

    \b
    Exit code:
      0   written
      2   bad input: one message, nothing is written
    """
    loaded, default = _load(flight)
    with results_in(out, default) as folder:
        echo(repr(loaded).strip("<>"))
        write_results(loaded, folder, figures=not no_figures)
        echo(f"  report: {folder / 'report.html'}")


def _load(given: str) -> tuple[Flight, Path]:
    """The flight, and the folder in which its report belongs.

    Raises:
        InputError: there is none.
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
