"""Events of compilations for those who display them, and the exception that stops work."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple


class Stopped(Exception):
    """Work was stopped by its caller."""


def always() -> bool:
    """True: go on without end."""
    return True


class Compiled(NamedTuple):
    """The end of a compilation.

    Attributes:
        what: name of what was compiled.
        seconds: the time it took [s].
        is_kept: whether it is on disk for the next process.
        is_made: whether it succeeded.
    """

    what: str
    seconds: float = 0.0
    is_kept: bool = True
    is_made: bool = False


Watcher = Callable[[Compiled | None], None]
_watchers: list[Watcher] = []


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
