"""A second process that draws figures of a flight while the first one draws others.

Drawing takes longer than flying, and the drawing library uses one processor. The second process is a fork of the first,
with the library loaded and the flight in memory. Whoever is free takes the next figure; one that the second process
does not draw is drawn by the first.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from tandemlift.core.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.pictures.figures.registry import figures_for, save_figures, save_flight_figure

MIN_FIGURES = 2  # figures from which on a second process saves time
NONE = -1  # the number of no figure


def can_fork() -> bool:
    """Whether a fork is safe and gains: on Linux, without threads but those that wait for ever, on two processors."""
    alone = all(thread.daemon for thread in threading.enumerate() if thread is not threading.main_thread())
    return sys.platform == "linux" and alone and (os.cpu_count() or 1) > 1


def draw_by_two(flight: Flight, folder: Path, progress: Progress | None = None) -> None:
    """Write every figure of a flight, as `save_figures` does, by two processes where that is possible.

    Args:
        flight: of any outcome.
        folder: of the figures; made if it does not exist.
        progress: called with (figures written, figures in all), first before any is drawn.
    """
    names = list(figures_for(flight))
    if len(names) < MIN_FIGURES or not can_fork():
        save_figures(flight, folder, progress)
        return
    folder.mkdir(parents=True, exist_ok=True)
    left = set(range(len(names)))

    def written(number: int) -> None:
        left.discard(number)
        if progress:
            progress(len(names) - len(left), len(names))

    written(NONE)
    (free, numbers), (drawn, drawing) = os.pipe(), os.pipe()  # a byte for each figure not yet taken, and drawn there
    os.write(numbers, bytes(left))
    os.close(numbers)
    second = _forked(lambda: _draw_each(flight, names, folder, free, lambda number: os.write(drawing, bytes([number]))))
    os.close(drawing)
    try:
        _draw_each(flight, names, folder, free, written)
        while said := os.read(drawn, 1):
            written(said[0])
    finally:
        os.close(free)
        os.close(drawn)
        with suppress(ProcessLookupError):
            os.kill(second, signal.SIGKILL)  # it has ended, unless this one was interrupted; a handler may keep SIGTERM
        os.waitpid(second, 0)
    for number in sorted(left):
        save_flight_figure(flight, names[number], folder)
        written(number)


def _draw_each(flight: Flight, names: list[str], folder: Path, free: int, written: Callable[[int], object]) -> None:
    """Draw the next figure that nobody has taken, until none is left."""
    while taken := os.read(free, 1):
        save_flight_figure(flight, names[taken[0]], folder)
        written(taken[0])


def _forked(work: Callable[[], None]) -> int:
    """The number of a process that does some work and ends without a word."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of a fork beside threads that wait
        process = os.fork()
    if not process:
        try:
            work()
        finally:
            os._exit(0)  # whatever happened: what it did not write, the first process does
    return process
