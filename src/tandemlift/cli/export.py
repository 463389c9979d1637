"""`tandemlift export`: a saved flight as a ROS bag or a table."""

from __future__ import annotations

from pathlib import Path

import click

from tandemlift.cli.results import flight_file
from tandemlift.cli.run import say
from tandemlift.errors import InputError


@click.command()
@click.argument("flight")
@click.option("--out", metavar="FILE", required=True, help="FILE.mcap, FILE.bag or FILE.csv.")
def export(flight: str, out: str) -> None:
    """Write a flight for other tools: a ROS 2 bag (MCAP), a ROS 1 bag, or a table (CSV).

    FLIGHT is a saved flight: flight.npz, or the folder that it is in. Bags need the package rosbags
    (pip install 'tandemlift[export]'), tables nothing. Topics, frames and units: docs/export.md.

    \b
    Examples:
      tandemlift export out/iris --out iris.mcap
      tandemlift export out/iris/flight.npz --out iris.bag
      tandemlift export out/iris --out iris.csv
    """
    from tandemlift import export as exporting
    from tandemlift.flight import Flight

    path = Path(out)
    exporting.writer_of(path)
    _, saved = flight_file(flight)
    if saved is None:
        raise InputError(f"{flight} is no saved flight: give flight.npz, or the folder that a run wrote it to")
    loaded = Flight.load(saved)
    exporting.export(loaded, path)
    say(f"{loaded.name}: {path} ({path.stat().st_size / 1e6:.1f} MB)")
