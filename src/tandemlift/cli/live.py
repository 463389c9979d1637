"""`tandemlift live`: push a flight by hand in a page of the browser."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.interrupts import leave
from tandemlift.cli.run import load
from tandemlift.cli.serving import HOST, PORT, needs_live, serve_here

if TYPE_CHECKING:
    from tandemlift.live.session.session import Session
    from tandemlift.missions import Mission

DEFAULT, OUT = "zigzag", Path("out/live")


@click.command()
@click.argument("mission", default=DEFAULT)
@click.option("--engine", default="compiled", show_default=True, help="Where the body lives; see `tandemlift engines`.")
@click.option("--port", type=int, default=PORT, show_default=True, help="Of this machine; 0 for any that is free.")
@click.option(
    "--host", default=HOST, show_default=True, help="To bind to; beyond this machine the address has a token."
)
@click.option("--out", metavar="DIR", default=str(OUT), show_default=True, help="Where the page saves what was flown.")
@click.option("--no-browser", is_flag=True, help="Print the address only.")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help="Change one key of the mission, as in run.")
def live(
    mission: str, engine: str, port: int, host: str, out: str, no_browser: bool, settings: tuple[str, ...]
) -> None:
    """Fly MISSION in real time, and push it by hand in a page of the browser.

    MISSION is the name of a built-in mission (see `tandemlift missions`) or the path of a .toml file; zigzag, the
    paper's corridor, if none is given. Its pushes and its person are left out: yours are the only hands. Nothing leaves
    this machine, unless --host says so. Ctrl-C ends it.

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

    needs_live()
    engine_named(engine)
    session = session_of(load(mission, settings), engine, Path(out))
    from tandemlift.live.page_files import page_files
    from tandemlift.live.server import PageServer

    serve_here(PageServer(page_files(), session, host, port), f"{mission}, live", browser=not no_browser)
    leave(0)  # it may still be compiling


def session_of(mission: Mission, engine: str, out: Path = OUT) -> Session:
    """A flight in real time, checked; nothing is compiled yet."""
    from tandemlift.live.session.session import Session

    return Session(mission, engine, out)
