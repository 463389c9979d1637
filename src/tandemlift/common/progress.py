"""Progress of long work: how much is done, how fast, and the time left.

A notebook shows a bar, by what every notebook has; a terminal one line that is written anew; a file, as of a job array,
gets a line from time to time. In a notebook, work within other work shows no bar of its own.
"""

from __future__ import annotations

import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from tandemlift.common.types import Progress  # which imports NumPy; a shell that completes words cannot wait

WINDOW = 60.0  # s, over which the rate is a mean
REWRITTEN, ADDED = 0.2, 10.0  # s between two states of a line that is written anew, and between two lines of a file
PATIENCE = 0.5  # s of work, less than which a notebook shows no bar
KERNEL = "ipykernel"  # the package of a notebook's streams

_shown = threading.Semaphore()  # a notebook's one bar


class Pace:
    """How far work is, in words.

    Args:
        label: first words.
        unit: of the work, as "rows".
        clock: the time [s].
    """

    def __init__(self, label: str, unit: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._label, self._unit, self.clock = label, unit, clock
        self._known = deque[tuple[float, int]]()

    def note(self, done: int) -> float:
        """Note that so much is done; the time now [s]."""
        now = self.clock()
        self._known.append((now, done))
        while len(self._known) > 2 and self._known[1][0] < now - WINDOW:
            self._known.popleft()
        return now

    def text(self, done: int, total: int) -> str:
        """How much is done, the rate and the time left, as far as they are known."""
        share = f"{done:,} of {total:,} {self._unit} ({100.0 * done / (total or 1):.0f} %)"
        return f"{self._label}: {share}{self._left(total - done)}"

    def _left(self, left: int) -> str:
        (since, before), (now, done) = self._known[0], self._known[-1]
        if done <= before or now <= since or not left:
            return ""
        rate = (done - before) / (now - since)
        shown = f"{rate:,.0f}" if rate >= 10.0 else f"{rate:.2g}"
        return f", {shown} {self._unit}/s, {duration(left / rate)} left"


class ProgressLine:
    """Writes progress to a stream.

    Args:
        pace: how far the work is, in words.
        stream: where it goes.
        rewrites: whether the line is written anew, in place of a new line.
    """

    def __init__(self, pace: Pace, stream: TextIO, rewrites: bool) -> None:
        self._pace, self._stream, self._rewrites = pace, stream, rewrites
        self._width, self._next = 0, float("-inf") if rewrites else pace.clock() + ADDED

    def __call__(self, done: int, total: int) -> None:
        """Note that so much is done, and write it if it is time to."""
        now = self._pace.note(done)
        if now >= self._next or (self._rewrites and done == total):
            self._next = now + (REWRITTEN if self._rewrites else ADDED)
            self._write(done, total)

    def close(self) -> None:
        """End the line."""
        if self._rewrites and self._width:
            self._stream.write("\n")
            self._stream.flush()

    def _write(self, done: int, total: int) -> None:
        text = self._pace.text(done, total)
        if self._rewrites:
            self._stream.write("\r" + text.ljust(self._width))
            self._width = len(text)
        else:
            self._stream.write(text + "\n")
        self._stream.flush()


class NotebookBar:
    """Progress as a bar below the cell of a notebook, from `PATIENCE` on.

    Args:
        pace: how far the work is, in words.
    """

    def __init__(self, pace: Pace) -> None:
        self._pace, self._output = pace, NotebookOutput()
        self._next = pace.clock() + PATIENCE
        self._last: tuple[int, int] | None = None

    def __call__(self, done: int, total: int) -> None:
        """Note that so much is done, and show it if it is time to."""
        self._last, now = (done, total), self._pace.note(done)
        if now >= self._next:
            self._next = now + REWRITTEN
            self._show(done, total)

    def close(self) -> None:
        """Show the last state, if anything was shown."""
        if self._last and self._output.is_shown:
            self._show(*self._last)

    def _show(self, done: int, total: int) -> None:
        bar = f'<progress value="{done}" max="{total or 1}" style="width:14em;vertical-align:middle"></progress>'
        text = self._pace.text(done, total)
        self._output.show(f"<div>{bar} {escape(text)}</div>", text)


class NotebookOutput:
    """A piece of a cell's output that can be replaced."""

    def __init__(self) -> None:
        self._handle: Any = None

    @property
    def is_shown(self) -> bool:
        """Whether there is anything to replace."""
        return self._handle is not None

    def show(self, html: str, text: str) -> None:
        """Show it as HTML; `text` stands where no HTML can be shown."""
        from IPython.display import display

        content = {"text/html": html, "text/plain": text}
        if self._handle is None:
            self._handle = display(content, raw=True, display_id=True)
        else:
            self._handle.update(content, raw=True)


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
def shown_progress(label: str, unit: str = "rows", stream: TextIO | None = None) -> Iterator[Progress]:
    """Progress shown as it suits a stream, by default standard error; in a notebook as a bar.

    Args:
        label: first words.
        unit: of the work.
        stream: where it goes.
    """
    pace = Pace(label, unit)
    line: NotebookBar | ProgressLine
    if stream is None and in_notebook():
        line = NotebookBar(pace)
    else:
        stream = stream or sys.stderr
        line = ProgressLine(pace, stream, rewrites=stream.isatty())
    try:
        yield line
    finally:
        line.close()


@contextmanager
def progress_or_own(label: str, progress: Progress | None, unit: str = "rows") -> Iterator[Progress | None]:
    """Progress as the caller wants it; if nothing is said, a notebook shows one bar and a script none.

    Args:
        label: first words.
        progress: of the caller, or None.
        unit: of the work.
    """
    if not in_notebook() or not _shown.acquire(blocking=False):
        yield progress
        return
    try:
        if progress is not None:
            yield progress
        else:
            with shown_progress(label, unit) as shown:
                yield shown
    finally:
        _shown.release()


def in_notebook() -> bool:
    """Whether standard output is a cell of a notebook."""
    return type(sys.stdout).__module__.partition(".")[0] == KERNEL
