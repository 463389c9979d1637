"""`tandemlift live`: push a flight by hand in a page of the browser; and the serving of pages, also for `replay`."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.terminal.completion import MISSIONS
from tandemlift.apps.cli.terminal.console import echo, exit_now
from tandemlift.apps.cli.terminal.mission_options import engine_option, load, set_option
from tandemlift.core.errors import extra

if TYPE_CHECKING:
    from tandemlift.apps.live.server import PageServer
    from tandemlift.apps.live.session.session import Session
    from tandemlift.missions import Mission

HOST, PORT = "127.0.0.1", 8710
DEFAULT, OUT = "zigzag", Path("out/live")
port_option = click.option(
    "--port", type=int, default=PORT, show_default=True, help="TCP port of the page; 0 for any free one."
)


@click.command()
@click.argument("mission", default=DEFAULT, shell_complete=MISSIONS)
@engine_option
@port_option
@click.option(
    "--host",
    default=HOST,
    show_default=True,
    help="Address to listen on. If other machines can reach it, the page's address carries a token.",
)
@click.option("--out", metavar="DIR", default=str(OUT), show_default=True, help="Folder for flights saved in the page.")
@click.option("--no-browser", is_flag=True, help="Only print the address.")
@set_option
def live(
    mission: str, engine: str, port: int, host: str, out: str, no_browser: bool, settings: tuple[str, ...]
) -> None:
    """Fly MISSION in real time, and push it by hand in a page of the browser.

    MISSION is a built-in mission (see `tandemlift missions`) or the path of a .toml file. The default is zigzag, the
    paper's corridor. The mission's own pushes and person are omitted: only you push. The page is served on this
    machine only, unless --host says otherwise. Ctrl-C ends the flight.

    \b
    Examples:
      tandemlift live
      tandemlift live zigzag --out out/mine
      tandemlift live hover --set admittance.mass=2 --port 0 --no-browser

    \b
    Exit code:
      0   ended by Ctrl-C
      2   bad input: one message, nothing is flown
    """
    from tandemlift.engines.registry import engine_named

    check_live_installed()
    engine_named(engine)
    session = session_of(load(mission, settings), engine, Path(out))
    from tandemlift.apps.live.page_files import page_files
    from tandemlift.apps.live.server import PageServer

    serve_until_interrupt(PageServer(page_files(), session, host, port), f"{mission}, live", browser=not no_browser)
    exit_now(0)  # a thread may still be compiling


def session_of(mission: Mission, engine: str, out: Path = OUT) -> Session:
    """A checked flight in real time; nothing is compiled yet."""
    from tandemlift.apps.live.session.session import Session

    return Session(mission, engine, out)


def check_live_installed() -> None:
    """Check that the packages of the extra `live` are installed.

    Raises:
        InputError: websockets is not installed.
    """
    with extra("live", "the live page"):
        import websockets  # noqa: F401


def serve_until_interrupt(server: PageServer, what: str, *, browser: bool) -> None:
    """Serve a page until Ctrl-C; print `what` it shows and its address, and optionally open it in a browser."""
    from tandemlift.apps.live.server import serve_until_stopped

    def opened(address: str) -> None:
        echo(f"{what}: {address}")
        echo("  Ctrl-C ends it")
        sys.stdout.flush()
        if "token=" in address:
            click.echo("warning: any machine that can reach this one and knows this address can push", err=True)
        if browser and _has_display():
            threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()

    try:
        asyncio.run(serve_until_stopped(server, opened))
    except KeyboardInterrupt:
        echo("stopped")


def _has_display() -> bool:
    """Whether a graphical browser can open; a text browser would take over the terminal."""
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
