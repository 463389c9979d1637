"""Pages without a server: `tandemlift replay --html` for a saved flight; `tandemlift page`, which flies by itself."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.live import HOST, check_live_installed, port_option, serve_until_interrupt
from tandemlift.apps.cli.terminal.completion import FLIGHTS, MISSIONS
from tandemlift.apps.cli.terminal.console import echo
from tandemlift.apps.cli.terminal.results import flight_file, html_path
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.files import atomic_write

if TYPE_CHECKING:
    from tandemlift.apps.live.page_modules import PackedFlight
    from tandemlift.flight.record import Flight


@click.command()
@click.argument("flight", shell_complete=FLIGHTS)
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
        _write(html_path("--html", html), Flight.load(saved))
    else:
        _serve(Flight.load(saved), port, browser=not no_browser)


def _write(path: Path, flight: Flight) -> None:
    """Write a flight's page."""
    from tandemlift.apps.live.page_files import page_files
    from tandemlift.apps.live.replay import replay_html

    text = replay_html(flight, page_files())
    with atomic_write(path) as partial:
        partial.write_text(text, "utf-8")
    echo(f"{flight.name}: {path}")


def _serve(flight: Flight, port: int, *, browser: bool) -> None:
    """Serve a flight's page until Ctrl-C."""
    check_live_installed()
    from tandemlift.apps.live.page_files import page_files
    from tandemlift.apps.live.replay import replay_files
    from tandemlift.apps.live.server import PageServer

    serve_until_interrupt(
        PageServer(replay_files(flight, page_files()), host=HOST, port=port), flight.name, browser=browser
    )


@click.command()
@click.argument("missions", nargs=-1, shell_complete=MISSIONS)
@click.option("--out", metavar="DIR", help="Write the page as files for a web server.")
@click.option("--html", metavar="FILE", help="Write the page as one file, which works from disk.")
def page(missions: tuple[str, ...], out: str | None, html: str | None) -> None:
    """Write a page that flies by itself: in the browser, without a server, pushed by hand.

    MISSIONS are those of its menu, the first of which it begins with: hover, zigzag, iris, doorway, rotor-loss, or some
    of them. The default is all. A flight saved in the page can be flown again by `tandemlift run`.

    \b
    Examples:
      tandemlift page --html tandemlift.html
      tandemlift page --out out/page
      tandemlift page zigzag doorway --html corridor.html

    \b
    Exit code:
      0   the page was written
      2   bad input: one message, nothing is written
    """
    if not out and not html:
        raise InputError("give the place of the page: --html FILE for one file, --out DIR for a web server")
    one_file = html_path("--html", html) if html else None
    folder = _folder(out) if out else None
    from tandemlift.apps.live import pages
    from tandemlift.apps.live.page_files import page_files

    files = page_files()
    flights = _flights(missions)
    if folder is not None:
        _write_files(folder, pages.offline_files(flights, files))
    if one_file is not None:
        with atomic_write(one_file) as partial:
            partial.write_text(pages.offline_html(flights, files), "utf-8")
        echo(f"{one_file}: {one_file.stat().st_size / 1e6:.1f} MB; open it in a browser")


def _flights(names: tuple[str, ...]) -> list[PackedFlight]:
    """The flights of the menu.

    Raises:
        InputError: a page has no such mission.
    """
    from tandemlift.apps.live.page_modules import MISSIONS, packed_flights

    for name in names:
        if name not in MISSIONS:
            raise unknown("mission of a page", name, MISSIONS)
    return packed_flights(dict.fromkeys(names or MISSIONS), lambda name: echo(f"{name} …"))


def _folder(name: str) -> Path:
    if Path(name).is_file():
        raise InputError(f"--out {name}: is a file, not a folder")
    return Path(name)


def _write_files(folder: Path, files: dict[str, bytes]) -> None:
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(folder / name) as partial:
            partial.write_bytes(content)
    size = sum(map(len, files.values()))
    echo(f"{folder}: {len(files)} files, {size / 1e6:.1f} MB; for a web server, such as: python -m http.server")
