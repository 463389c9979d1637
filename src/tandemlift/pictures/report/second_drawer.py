"""A second process that draws figures of a saved flight while the first one draws others.

Drawing takes longer than flying, and the drawing library uses one processor. `python -m` this file is that process: it
reads a request a line, draws the figure, and answers. A figure that it cannot draw is drawn by the first process.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Lock, Thread
from typing import IO

from tandemlift.core.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import current_style, figure_style
from tandemlift.pictures.figures.registry import figures_for, save_figures, save_flight_figure

DRAWN = "drawn"
WORTH = 4  # figures from which on a second process saves time: it needs that of one figure to start


class SecondDrawer:
    """A process that draws; see `second_drawer`."""

    def __init__(self, pipes: tuple[IO[str], ...] = ()) -> None:
        self._pipes = pipes  # of requests and answers; none without the process

    def save_figures(self, flight: Flight, file: Path, folder: Path, progress: Progress | None = None) -> None:
        """Write every figure of a flight, as `save_figures` does, in both processes.

        Args:
            flight: that is saved.
            file: in which it is saved.
            folder: of the figures.
            progress: called with (figures written, figures in all), first before any is drawn.
        """
        names = deque(figures_for(flight))
        if not self._pipes or len(names) < WORTH:
            save_figures(flight, folder, progress)
            return
        folder.mkdir(parents=True, exist_ok=True)
        count = _Counter(len(names), progress)
        request = {"flight": str(file), "folder": str(folder), "style": current_style().name}
        left: list[str] = []  # figures that the other process could not draw
        other = Thread(target=self._draw, args=(names, request, count, left))
        other.start()
        _draw_each(flight, names, folder, count)
        other.join()
        _draw_each(flight, deque(left), folder, count)

    def _draw(self, names: deque[str], request: dict[str, str], count: _Counter, left: list[str]) -> None:
        """Have the other process draw figures from the end of the list until none is left, or one fails."""
        requests, answers = self._pipes
        while name := _taken(names.pop):
            try:
                requests.write(json.dumps({**request, "figure": name}) + "\n")
                requests.flush()
                answer = answers.readline().strip()
            except (OSError, ValueError):  # the process has ended, or its pipes are closed
                answer = ""
            if answer != DRAWN:
                left.append(name)
                return
            count.one_more()


class _Counter:
    """Counts what two threads have drawn."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self._total, self._progress, self._done, self._lock = total, progress, 0, Lock()
        if progress:
            progress(0, total)

    def one_more(self) -> None:
        """One more figure is written."""
        with self._lock:
            self._done += 1
            if self._progress:
                self._progress(self._done, self._total)


def _taken(take: Callable[[], str]) -> str | None:
    """The figure that is taken from one end of the list; None if there is none."""
    try:
        return take()
    except IndexError:
        return None


def _draw_each(flight: Flight, names: deque[str], folder: Path, count: _Counter) -> None:
    while name := _taken(names.popleft):
        save_flight_figure(flight, name, folder)
        count.one_more()


@contextmanager
def second_drawer(wanted: bool = True) -> Iterator[SecondDrawer]:
    """A drawer with a second process, if it is wanted and there is a processor for it; it ends with the context."""
    command = [sys.executable, "-m", __name__]
    if not wanted or (os.cpu_count() or 1) < 2 or not sys.executable:
        yield SecondDrawer()
        return
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        try:
            yield SecondDrawer(tuple(pipe for pipe in (process.stdin, process.stdout) if pipe))
        finally:
            process.kill()
            if process.stdin:
                with suppress(OSError):  # a request that it did not read
                    process.stdin.close()


def main() -> None:
    """Draw what the lines of standard input ask for, until it ends."""
    import tandemlift.pictures.drawing.style  # noqa: F401  loads the drawing library while the flight is still written

    flights = dict[str, Flight]()
    for line in sys.stdin:
        request = json.loads(line)
        file = request["flight"]
        if file not in flights:
            flights = {file: Flight.load(file)}
        with figure_style(request["style"]):
            save_flight_figure(flights[file], request["figure"], Path(request["folder"]))
        print(DRAWN, flush=True)


if __name__ == "__main__":
    main()
