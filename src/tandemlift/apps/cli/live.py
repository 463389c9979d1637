"""Pages of the browser: `tandemlift live`, whose flight is pushed by hand, `replay` for a saved one, and `page`.

`page` writes a page that flies by itself, without a server.
"""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.completion import FLIGHTS, MISSIONS
from tandemlift.apps.cli.console import echo, exit_now, progress_bar
from tandemlift.apps.cli.flying import FAILED, HTML, controller_option, engine_option, load, set_option
from tandemlift.apps.export.results import file_path, flight_file
from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import write_file

if TYPE_CHECKING:
    from tandemlift.apps.live.server import PageServer

HOST, PORT = "127.0.0.1", 8710
DEFAULT, OUT = "zigzag", Path("out/live")
port_option = click.option(
    "--port", type=int, default=PORT, show_default=True, help="TCP port of the page; 0 for any free one."
)
script_option = click.option("--script", metavar="FILE", help="Begin with the script of a lecture, a .toml file.")
no_browser_option = click.option("--no-browser", is_flag=True, help="Only print the address.")


@click.command()
@click.argument("mission", default=DEFAULT, shell_complete=MISSIONS)
@engine_option
@port_option
@click.option(
    "--host",
    default=HOST,
    show_default=True,
    help="Address to listen on. If other machines can reach it, the page's address carries a token; a QR code has it.",
)
@click.option("--out", metavar="DIR", default=str(OUT), show_default=True, help="Folder for flights saved in the page.")
@script_option
@no_browser_option
@set_option
@controller_option()
def live(
    mission: str,
    engine: str,
    port: int,
    host: str,
    out: str,
    no_browser: bool,
    settings: tuple[str, ...],
    controller: str | None,
    script: str | None = None,
) -> None:
    """Fly MISSION in real time, and push it by hand in the browser.

    MISSION is a built-in mission (see `tandemlift missions`) or the path of a .toml file. The default is zigzag, the
    paper's corridor. The mission's own pushes and person are omitted: only you push. The page can choose another
    mission, or fly a file that is dropped on it. The page is served on this machine only, unless --host says otherwise.
    Ctrl-C ends the flight.

    \b
    Examples:
      tandemlift live
      tandemlift live zigzag --out out/mine
      tandemlift live hover --set admittance.mass=2 --port 0 --no-browser
      tandemlift live hover --controller my_pd.py
      tandemlift live hover --script lecture.toml
    """
    from tandemlift.engines.registry import engine_named

    check_live_installed()
    engine_named(engine)
    from tandemlift.apps.live.page_files import page_files, with_script
    from tandemlift.apps.live.server import PageServer
    from tandemlift.apps.live.two_flights import TwoFlights

    files = with_script(page_files(), script)
    session = TwoFlights(load(mission, settings, controller), engine, Path(out))
    serve_until_interrupt(PageServer(files, session, host, port), f"{mission}, live", browser=not no_browser)
    exit_now(0)  # a thread may still be compiling


def check_live_installed() -> None:
    """Check that the packages of the extra `live` are installed.

    Raises:
        InputError: websockets is not installed.
    """
    with extra("live", "the live page"):
        import websockets  # noqa: F401


def serve_until_interrupt(server: PageServer, what: str, *, browser: bool) -> None:
    """Serve a page until Ctrl-C; print `what` it shows and its address, and optionally open it in a browser."""
    from tandemlift.apps.live.server import open_in_browser, qr_code, serve_until_stopped

    def opened(address: str) -> None:
        echo(f"{what}: {address}")
        echo("  Ctrl-C ends it")
        sys.stdout.flush()
        if "token=" in address:
            echo(qr_code(address), nl=False)
            click.echo("warning: any machine that can reach this one and knows this address can push", err=True)
        if browser:
            open_in_browser(address)

    try:
        asyncio.run(serve_until_stopped(server, opened))
    except KeyboardInterrupt:
        echo("stopped")


@click.command()
@click.argument("flight", shell_complete=FLIGHTS)
@click.option("--html", metavar="FILE", help="Write the page to a file that needs no network, instead of serving it.")
@port_option
@no_browser_option
def replay(flight: str, html: str | None, port: int, no_browser: bool) -> None:
    """Play a saved flight in the browser, with a slider for time.

    FLIGHT is flight.npz or its folder. The page is served on this machine only. Ctrl-C ends it.

    \b
    Examples:
      tandemlift replay out/zigzag
      tandemlift replay out/zigzag --html zigzag.html
    """
    from tandemlift.apps.live.page_files import page_files
    from tandemlift.apps.live.replay import replay_files, replay_html
    from tandemlift.flight.record import Flight

    _, saved = flight_file(flight)
    if saved is None:
        raise InputError(f"{flight}: there is no flight.npz; give the file, or the folder that `tandemlift run` wrote")
    if html:
        path, loaded = file_path("--html", html, *HTML), Flight.load(saved)
        write_file(path, replay_html(loaded, page_files()))
        echo(f"{loaded.name}: {path}")
        return
    loaded = Flight.load(saved)
    check_live_installed()
    from tandemlift.apps.live.server import PageServer

    server = PageServer(replay_files(loaded, page_files()), host=HOST, port=port)
    serve_until_interrupt(server, loaded.name, browser=not no_browser)


@click.command()
@click.argument("missions", nargs=-1, shell_complete=MISSIONS)
@click.option("--out", metavar="DIR", help="Write the page as files for a web server.")
@click.option("--html", metavar="FILE", help="Write the page as one file, which works from disk.")
@script_option
@controller_option("Controller to fly all of them")
def page(
    missions: tuple[str, ...], out: str | None, html: str | None, script: str | None, controller: str | None
) -> None:
    """Write a page that flies in the browser, without a server.

    The page flies by itself, and is pushed by hand. MISSIONS are those of its menu, the first of which it begins with:
    built-in missions, or the paths of .toml files. The default is hover, zigzag, iris, doorway and rotor-loss. A flight
    saved in the page can be flown again by `tandemlift run`. What is compiled is kept for the next time.

    \b
    Examples:
      tandemlift page --html tandemlift.html
      tandemlift page --out out/page
      tandemlift page zigzag mine.toml --html corridor.html
      tandemlift page hover --controller my_pd.py --html mine.html
      tandemlift page hover --script lecture.toml --html lecture.html
    """
    if not out and not html:
        raise InputError("give the place of the page: --html FILE for one file, --out DIR for a web server")
    one_file = file_path("--html", html, *HTML) if html else None
    if out and Path(out).is_file():
        raise InputError(f"--out {out}: is a file, not a folder")
    from tandemlift.apps.live import page_modules, pages
    from tandemlift.apps.live.page_files import page_files, with_script

    files = with_script(page_files(), script)
    with progress_bar("Compiling", "missions") as progress:
        flights = page_modules.packed_flights(missions or page_modules.MISSIONS, controller, progress)
    for line in pages.write_page(flights, Path(out) if out else None, one_file, files):
        echo(line)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--mission", default=DEFAULT, show_default=True, shell_complete=MISSIONS, help="The mission that all were to fly."
)
@click.option(
    "--free", "free", metavar="KEY", multiple=True, help="A key, or a table of keys, that participants may change."
)
@set_option
def score(folder: Path, mission: str, free: tuple[str, ...], settings: tuple[str, ...]) -> None:
    """Rank flights through a corridor by hand.

    Each is flown again from its recording, and scored. FOLDER holds the flights that participants saved in the page of
    `tandemlift live` or `tandemlift page`, a folder or a .zip each. The score is a time, and the lowest wins: the time
    from the first push to the end of the corridor, 5 s for each touch of a wall, 1 s for 5 N s of effort, and the
    logarithm of the dimensionless jerk. A flight of another mission, or with a score that its recording does not fly,
    is refused with its reason.

    \b
    Examples:
      tandemlift score handed-in
      tandemlift score handed-in --mission zigzag --free admittance

    Exit code 3: some were refused.
    """
    from tandemlift.apps.live.ranking import ranked

    with progress_bar("Flying", "flights") as progress:
        table, refused = ranked(folder, load(mission, settings), free, progress)
    for line in table:
        echo(line)
    sys.exit(FAILED if refused else 0)
