"""What the core tells while it works, to whoever shows it: that a loop is compiled; and how it is told to stop."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple


class Stopped(Exception):
    """Work that is not to go on."""


def always() -> bool:
    """Whether to go on: yes."""
    return True


class Compiled(NamedTuple):
    """What was compiled, or could not be: how long it took [s], whether it is on disk for the next process."""

    what: str
    seconds: float = 0.0
    is_kept: bool = True
    is_made: bool = False


Watcher = Callable[[Compiled | None], None]
_watchers: list[Watcher] = []


def compiling(what: Compiled | None) -> None:
    """Tell that a loop begins to be compiled (None), or what came of it; from any thread."""
    for watch in tuple(_watchers):
        watch(what)


@contextmanager
def watching(watch: Watcher) -> Iterator[None]:
    """Let somebody be told for a while."""
    _watchers.append(watch)
    try:
        yield
    finally:
        _watchers.remove(watch)
