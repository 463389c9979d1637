"""The end of the process: at once, with one line, whatever its threads still do."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from typing import Any

AGAIN = 0.02  # s, until an interrupt that Python has swallowed comes again


def leave(status: int) -> None:
    """End the process. A thread that compiles cannot be interrupted, and would be waited for."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    os._exit(status)


def handle_interrupts() -> None:
    """Let no Ctrl-C be lost: Python swallows one that comes while an object is finalised, and says so."""
    told = sys.unraisablehook

    def hook(what: Any) -> None:
        if issubclass(what.exc_type, KeyboardInterrupt):
            again = threading.Timer(AGAIN, signal.raise_signal, [signal.SIGINT])
            again.daemon = True
            again.start()
        else:
            told(what)

    sys.unraisablehook = hook
