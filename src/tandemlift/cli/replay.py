"""`tandemlift replay`: a saved flight in the page of `tandemlift live`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.console import echo
from tandemlift.cli.live import HOST, check_live_installed, port_option, serve_until_interrupt
from tandemlift.cli.results import flight_file
from tandemlift.common.errors import InputError
from tandemlift.common.files import atomic_write

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight


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
