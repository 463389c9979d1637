"""Progress of a study as a line of text: how much is flown, how fast, and the time left.

A terminal and a notebook show one line that is written anew; a file, as of a job array, gets a line from time to time.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from tandemlift.common.types import Progress

WINDOW = 60.0  # s, over which the rate is a mean
REWRITTEN, ADDED = 0.2, 10.0  # s between two states of a line that is written anew, and between two lines of a file
KERNEL = "ipykernel"  # the package of a notebook's streams


class ProgressLine:
    """Writes progress to a stream.

    Args:
        label: first words of the line.
        stream: where it goes.
        rewrites: whether the line is written anew, in place of a new line.
        clock: the time [s].
    """

    def __init__(self, label: str, stream: TextIO, rewrites: bool, clock: Callable[[], float] = time.monotonic) -> None:
        self._label, self._stream, self._rewrites, self._clock = label, stream, rewrites, clock
        self._known = deque[tuple[float, int]]()
        self._width, self._next = 0, float("-inf") if rewrites else clock() + ADDED

    def __call__(self, done: int, total: int) -> None:
        """Note that so many rows are flown, and write it if it is time to."""
        now = self._clock()
        self._known.append((now, done))
        while len(self._known) > 2 and self._known[1][0] < now - WINDOW:
            self._known.popleft()
        if now >= self._next or (self._rewrites and done == total):
            self._next = now + (REWRITTEN if self._rewrites else ADDED)
            self._write(done, total)

    def close(self) -> None:
        """End the line."""
        if self._rewrites and self._width:
            self._stream.write("\n")
            self._stream.flush()

    def _write(self, done: int, total: int) -> None:
        text = f"{self._label}: {done:,} of {total:,} rows ({100.0 * done / total:.0f} %){self._pace(total - done)}"
        if self._rewrites:
            self._stream.write("\r" + text.ljust(self._width))
            self._width = len(text)
        else:
            self._stream.write(text + "\n")
        self._stream.flush()

    def _pace(self, left: int) -> str:
        """The rate and the time left, as far as they are known."""
        (since, before), (now, done) = self._known[0], self._known[-1]
        if done <= before or now <= since or not left:
            return ""
        rate = (done - before) / (now - since)
        shown = f"{rate:,.0f}" if rate >= 10.0 else f"{rate:.2g}"
        return f", {shown} rows/s, {duration(left / rate)} left"


def duration(seconds: float) -> str:
    """A time in the units that a person would say it in."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    hours = whole // 3600
    return f"{hours} h {whole % 3600 // 60} min" if hours < 48 else f"{hours // 24} days {hours % 24} h"


@contextmanager
def shown_progress(label: str, stream: TextIO | None = None) -> Iterator[Progress]:
    """Progress shown as it suits a stream: by default standard error, or the output of a notebook's cell.

    Args:
        label: first words of the line.
        stream: where it goes.
    """
    stream = stream or (sys.stdout if _is_notebook(sys.stdout) else sys.stderr)
    line = ProgressLine(label, stream, rewrites=stream.isatty() or _is_notebook(stream))
    try:
        yield line
    finally:
        line.close()


@contextmanager
def progress_or_own(label: str, progress: Progress | None) -> Iterator[Progress | None]:
    """Progress as the caller wants it; if nothing is said, a notebook shows it and a script does not."""
    if progress is None and _is_notebook(sys.stdout):
        with shown_progress(label) as shown:
            yield shown
    else:
        yield progress


def _is_notebook(stream: TextIO) -> bool:
    return type(stream).__module__.partition(".")[0] == KERNEL
