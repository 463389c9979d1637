"""`tandemlift replay` and `tandemlift report`: a saved flight in a page of the browser, and on paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.live import HOST, check_live_installed, port_option, serve_until_interrupt
from tandemlift.cli.terminal.console import echo
from tandemlift.cli.terminal.results import flight_file, results_folder, write_flight
from tandemlift.common.errors import InputError
from tandemlift.common.files import atomic_write

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight

BAGS = (".bag", ".mcap")


@click.command()
@click.argument("flight")
@click.option("--html", metavar="FILE", help="Write the page to a file that needs no network, instead of serving it.")
@port_option
@click.option("--no-browser", is_flag=True, help="Only print the address.")
def replay(flight: str, html: str | None, port: int, no_browser: bool) -> None:
    """Play a saved flight in a page of the browser, with a slider for the time.

    FLIGHT is flight.npz or its folder. The page is served on this machine only. Ctrl-C ends it.

    \b
    Examples:
      tandemlift replay out/zigzag
      tandemlift replay out/zigzag --html zigzag.html

    \b
    Exit code:
      0   ended by Ctrl-C, or the page was written
      2   bad input: one message, nothing is written
    """
    from tandemlift.flight.record import Flight

    _, saved = flight_file(flight)
    if saved is None:
        raise InputError(f"{flight}: there is no flight.npz; give the file, or the folder that `tandemlift run` wrote")
    if html:
        _write(Path(html), Flight.load(saved))
    else:
        _serve(Flight.load(saved), port, browser=not no_browser)


def _write(path: Path, flight: Flight) -> None:
    """Write a flight's page.

    Raises:
        InputError: the page cannot be written there.
    """
    from tandemlift.live.page_files import page_files
    from tandemlift.live.replay import replay_html

    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"--html {path}: the name of a page must end in .html")
    if path.is_dir():
        raise InputError(f"--html {path}: is a folder, not a file")
    text = replay_html(flight, page_files())
    with atomic_write(path) as partial:
        partial.write_text(text, "utf-8")
    echo(f"{flight.name}: {path}")


def _serve(flight: Flight, port: int, *, browser: bool) -> None:
    """Serve a flight's page until Ctrl-C."""
    check_live_installed()
    from tandemlift.live.page_files import page_files
    from tandemlift.live.replay import replay_files
    from tandemlift.live.server import PageServer

    serve_until_interrupt(
        PageServer(replay_files(flight, page_files()), host=HOST, port=port), flight.name, browser=browser
    )


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
