"""Lines in a terminal on what this machine compiles: `watching(compile_notices)` prints them."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from tandemlift.core.progress import Compiled

PATIENCE = 2.0  # s of compiling, after which a line appears in a terminal before the end
MIN_DELAY = 0.1  # s, less than which none appears


class CompileNotices:
    """Prints one line on standard error for each compiled loop, or one for several (`together`)."""

    def __init__(self) -> None:
        self._lock, self._together = threading.RLock(), 0
        self._running, self._began = 0, 0.0
        self._made, self._seconds, self._is_kept = list[str](), 0.0, True
        self._timer: threading.Timer | None = None

    def __call__(self, what: Compiled | None) -> None:
        """Handle an event: a compilation begins (None) or has ended."""
        with self._lock:
            if what is None:
                self._begin()
            else:
                self._end(what)

    def _begin(self) -> None:
        if not self._running:
            self._began = time.perf_counter()
            self._timer = threading.Timer(PATIENCE, _print_line, ["Compiling for this machine …"])
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
            self._print()

    def _print(self) -> None:
        """Print the number of loops compiled since the last line."""
        if self._running:
            return
        made, seconds, is_kept = self._made, self._seconds, self._is_kept
        self._made, self._seconds, self._is_kept = [], 0.0, True
        if made and seconds >= MIN_DELAY:
            kind = made[0] if len(set(made)) == 1 else "loop"
            loops, they = (f"the {kind}", "it is") if len(made) == 1 else (f"{len(made)} {kind}s", "they are")
            kept = f"{they} kept for next time" if is_kept else "the cache cannot be written (TANDEMLIFT_CACHE)"
            _print_line(f"Compiled {loops} in {seconds:.1f} s; {kept}.")

    @contextmanager
    def together(self) -> Iterator[None]:
        """Print one line at the end for all loops compiled meanwhile."""
        self._together += 1
        try:
            yield
        finally:
            self._together -= 1
        if not self._together:
            self._print()


def _print_line(line: str) -> None:
    print(f"\r\033[K{line}" if sys.stderr.isatty() else line, file=sys.stderr, flush=True)


compile_notices = CompileNotices()
