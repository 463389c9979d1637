"""What is compiled, and how long it took, on standard error: measured, never guessed, and only if it takes time."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import click

from tandemlift.trace.compile_events import Compiled

PATIENCE = 2.0  # s of compiling, after which it is told before its end
LEAST = 0.1  # s, less than which nobody notices


class CompileNotices:
    """Tells in one line of each loop, or in one of several."""

    def __init__(self) -> None:
        self._lock, self._together = threading.RLock(), 0
        self._running, self._began = 0, 0.0
        self._made, self._seconds, self._is_kept = list[str](), 0.0, True
        self._timer: threading.Timer | None = None

    def __call__(self, what: Compiled | None) -> None:
        """Hear that a loop begins to be compiled (None), or what came of it."""
        with self._lock:
            if what is None:
                self._begin()
            else:
                self._end(what)

    def _begin(self) -> None:
        if not self._running:
            self._began = time.perf_counter()
            self._timer = threading.Timer(PATIENCE, _say, ["Compiling for this machine …"])
            self._timer.daemon = True
            self._timer.start()
        self._running += 1

    def _end(self, what: Compiled) -> None:
        self._running, self._made = self._running - 1, self._made + [what.what] * what.is_made
        self._is_kept = self._is_kept and what.is_kept
        if not self._running:
            self._seconds += time.perf_counter() - self._began
            if self._timer:
                self._timer.cancel()
        if not self._together:
            self._tell()

    def _tell(self) -> None:
        """Tell what was compiled since the last time."""
        if self._running:
            return
        made, seconds, is_kept = self._made, self._seconds, self._is_kept
        self._made, self._seconds, self._is_kept = [], 0.0, True
        if made and seconds >= LEAST:
            kind = made[0] if len(set(made)) == 1 else "loop"
            loops, they = (f"the {kind}", "it is") if len(made) == 1 else (f"{len(made)} {kind}s", "they are")
            kept = f"{they} kept for next time" if is_kept else "the cache cannot be written (TANDEMLIFT_CACHE)"
            _say(f"Compiled {loops} in {seconds:.1f} s; {kept}.")

    @contextmanager
    def together(self) -> Iterator[None]:
        """Tell of all that is compiled meanwhile in one line at the end."""
        self._together += 1
        try:
            yield
        finally:
            self._together -= 1
        if not self._together:
            self._tell()


compile_notices = CompileNotices()


def _say(line: str) -> None:
    click.echo(f"\r\033[K{line}" if sys.stderr.isatty() else line, err=True)
