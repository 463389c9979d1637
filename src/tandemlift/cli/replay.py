"""`tandemlift replay`: a flight again, in the page of `tandemlift live`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.results import flight_file
from tandemlift.cli.run import echo
from tandemlift.cli.serving import HOST, PORT, needs_live, serve_here
from tandemlift.common.errors import InputError
from tandemlift.common.files import atomic_write

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight


@click.command()
@click.argument("flight")
@click.option("--html", metavar="FILE", help="Write one page that plays without a network, in place of serving it.")
@click.option("--port", type=int, default=PORT, show_default=True, help="Of this machine; 0 for any that is free.")
@click.option("--no-browser", is_flag=True, help="Print the address only.")
def replay(flight: str, html: str | None, port: int, no_browser: bool) -> None:
    """Play a saved flight in a page of the browser, with a slider for its time.

    FLIGHT is flight.npz, or the folder that it is in. Nothing leaves this machine. Ctrl-C ends it.

    \b
    Examples:
      tandemlift replay out/zigzag
      tandemlift replay out/zigzag --html zigzag.html

    \b
    Exit code:
      0   ended by Ctrl-C, or the page is written
      2   bad input: one message, nothing is written
    """
    from tandemlift.flight.record import Flight

    _, saved = flight_file(flight)
    if saved is None:
        raise InputError(f"{flight}: no flight.npz there; give the file, or the folder that `tandemlift run` wrote")
    if html:
        _write(Path(html), Flight.load(saved))
    else:
        _serve(Flight.load(saved), port, browser=not no_browser)


def _write(path: Path, flight: Flight) -> None:
    """Write a flight's page.

    Raises:
        InputError: it cannot be written there.
    """
    from tandemlift.live.page_files import page_files
    from tandemlift.live.replay import replay_html

    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"--html {path}: a page's name ends in .html")
    if path.is_dir():
        raise InputError(f"--html {path}: is a folder, not a file")
    text = replay_html(flight, page_files())
    with atomic_write(path) as partial:
        partial.write_text(text, "utf-8")
    echo(f"{flight.name}: {path}")


def _serve(flight: Flight, port: int, *, browser: bool) -> None:
    """Serve a flight's page until Ctrl-C."""
    needs_live()
    from tandemlift.live.page_files import page_files
    from tandemlift.live.replay import replay_files
    from tandemlift.live.server import PageServer

    serve_here(PageServer(replay_files(flight, page_files()), host=HOST, port=port), flight.name, browser=browser)
