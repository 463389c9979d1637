"""Progress of long tasks, and events of compilations for those who display them.

Tasks show a bar by tqdm in a terminal or a notebook, lines at intervals in a file. While this machine compiles, a line
in a notebook says so.
"""

from __future__ import annotations

import io
import shutil
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple, TextIO

if TYPE_CHECKING:
    from tandemlift.core.types import Progress  # tqdm.auto imports NumPy, which is too slow for shell completion

BETWEEN_LINES = 10.0  # s, in a file, as of a job array
KERNEL = "ipykernel"  # the package of a notebook's streams
NOTICE = "Compiling for this machine; the machine code is kept for next time …"

_shown = threading.Semaphore()  # a notebook's one bar


class _Lines(io.TextIOBase):
    """A stream in which each state of a bar is a line of its own."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        if text.strip():
            self._stream.write(text.strip() + "\n")
            self._stream.flush()
        return len(text)


@contextmanager
def shown_progress(label: str, unit: str = "rows", stream: TextIO | None = None) -> Iterator[Progress]:
    """Show progress on a stream, by default standard error; in a notebook as a bar below the cell.

    Args:
        label: first words.
        unit: of the work.
        stream: where it goes.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a notebook without ipywidgets has a bar of characters
        from tqdm.auto import tqdm
    out = stream or sys.stderr
    look: dict[str, Any] = {"desc": label, "unit": f" {unit}"}
    look["bar_format"] = "{l_bar}{bar}| {n_fmt}/{total_fmt} [{elapsed}<{remaining}, {rate_noinv_fmt}]"  # never s/rows
    if stream is None and in_notebook():
        look |= {"delay": 0.5}
    elif out.isatty():  # a terminal of unknown size counts as 80 × 24; tqdm would show nothing
        columns, lines = shutil.get_terminal_size()
        look |= {"file": out, "ncols": columns, "nrows": lines}
    else:
        look |= {"file": _Lines(out), "mininterval": BETWEEN_LINES, "miniters": 1, "delay": BETWEEN_LINES}
        look["bar_format"] = "{desc}: {n_fmt} of {total_fmt}{unit}, {remaining} left"
    with tqdm(total=0, **look) as bar:

        def update(done: int, total: int) -> None:
            if not bar.total:  # units done before do not count in the rate
                bar.initial = bar.n = bar.last_print_n = done
            bar.total = total
            bar.update(done - bar.n)

        yield update


@contextmanager
def progress_or_own(label: str, progress: Progress | None, unit: str = "rows") -> Iterator[Progress | None]:
    """The caller's choice of progress; by default a notebook shows one bar and a script none.

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


# ---- Compilations


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
