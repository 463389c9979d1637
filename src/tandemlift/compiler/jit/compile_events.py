"""Events of compilations for those who display them, and the exception that stops work.

In a notebook, a line says that this machine compiles, as long as it does; programs may watch with `compile_notices`.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from tandemlift.core.progress import in_notebook

NOTICE = "Compiling for this machine; the machine code is kept for next time …"
PATIENCE = 2.0  # s of compiling, after which a line appears in a terminal before the end
LEAST = 0.1  # s, less than which none appears


class Stopped(Exception):
    """Work was stopped by its caller."""


def always() -> bool:
    """True: go on without end."""
    return True


class Compiled(NamedTuple):
    """The end of a compilation.

    Attributes:
        what: name of the compiled code.
        seconds: the time it took [s].
        is_kept: whether it is on disk for the next process.
        is_made: whether it succeeded.
    """

    what: str
    seconds: float = 0.0
    is_kept: bool = True
    is_made: bool = False


Watcher = Callable[[Compiled | None], None]


class NotebookNotice:
    """Shows a line below the cell of a notebook while anything is compiled."""

    def __init__(self) -> None:
        self._lock, self._running = threading.Lock(), 0
        self._handle: Any = None

    def __call__(self, what: Compiled | None) -> None:
        """Handle an event: a compilation begins (None) or has ended."""
        if not in_notebook():
            return
        from IPython.display import display

        with self._lock:
            self._running += 1 if what is None else -1
            if what is None and self._running == 1:
                self._handle = display({"text/plain": NOTICE}, raw=True, display_id=True)
            elif not self._running and self._handle is not None:
                self._handle.update({"text/plain": ""}, raw=True)


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
        if made and seconds >= LEAST:
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
_watchers: list[Watcher] = [NotebookNotice()]


def publish(what: Compiled | None) -> None:
    """Publish that a compilation begins (None) or has ended; from any thread."""
    for watch in tuple(_watchers):
        watch(what)


@contextmanager
def watching(watch: Watcher) -> Iterator[None]:
    """Call `watch` with each event while the context is open."""
    _watchers.append(watch)
    try:
        yield
    finally:
        _watchers.remove(watch)
