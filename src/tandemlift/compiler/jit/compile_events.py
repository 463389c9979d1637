"""Events of compilations for those who display them, and the exception that stops work.

In a notebook, a line says that this machine compiles, as long as it does.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from tandemlift.core.progress import in_notebook

NOTICE = "Compiling for this machine; the machine code is kept for next time …"


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
