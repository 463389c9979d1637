"""What `live` and `replay` share: serving a page until Ctrl-C, and opening the browser."""

from __future__ import annotations

import asyncio
import importlib.util
import os
import sys
import threading
import webbrowser
from typing import TYPE_CHECKING

import click

from tandemlift.cli.run import echo
from tandemlift.common.errors import InputError

if TYPE_CHECKING:
    from tandemlift.live.server import PageServer

HOST, PORT = "127.0.0.1", 8710


def needs_live() -> None:
    """Refuse to go on without what the extra `live` installs.

    Raises:
        InputError: websockets is not installed.
    """
    if importlib.util.find_spec("websockets") is None:
        raise InputError("the live page needs websockets: pip install 'tandemlift[live]'")


def serve_here(server: PageServer, what: str, *, browser: bool) -> None:
    """Serve until Ctrl-C; say `what` is to be seen, and where, and open it in a browser."""
    from tandemlift.live.server import serve_until_stopped

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
    """Whether a browser has somewhere to open; without, one of the terminal would take the terminal over."""
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
