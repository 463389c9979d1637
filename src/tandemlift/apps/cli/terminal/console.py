"""The terminal: output, progress bars, notices about compiling, and the end of the process on Ctrl-C."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from tandemlift.core.progress import Compiled, shown_progress

if TYPE_CHECKING:
    from tandemlift.core.types import Progress

PATIENCE = 2.0  # s of compiling, after which a notice appears before the end
LEAST = 0.1  # s, less than which no notice appears
AGAIN = 0.02  # s, until an interrupt that Python has swallowed is raised again


def echo(text: str, *, nl: bool = True) -> None:
    """Print to standard output; if it is closed (`| head`), continue without it."""
    try:
        click.echo(text, nl=nl)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def progress_bar(label: str, unit: str, *, shown: bool = True) -> Iterator[Progress | None]:
    """A progress bar on standard error as a callback of (done, total), or None if it is not shown.

    Args:
        label: text before the bar.
        unit: of the work.
        shown: whether to show the bar.
    """
    if not shown:
        yield None
        return
    with compile_notices.together(), shown_progress(label, unit) as progress:
        yield progress


class CompileNotices:
    """Prints one line for each compiled loop, or one for several (`together`)."""

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


compile_notices = CompileNotices()


def _print_line(line: str) -> None:
    click.echo(f"\r\033[K{line}" if sys.stderr.isatty() else line, err=True)


def exit_now(status: int) -> None:
    """End the process at once: Python would wait for a thread that compiles, which cannot be interrupted."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    os._exit(status)


def handle_interrupts() -> None:
    """Raise a Ctrl-C again that Python has swallowed because it came while an object was finalised."""
    previous = sys.unraisablehook

    def hook(what: sys.UnraisableHookArgs) -> None:
        if issubclass(what.exc_type, KeyboardInterrupt):
            again = threading.Timer(AGAIN, signal.raise_signal, [signal.SIGINT])
            again.daemon = True
            again.start()
        else:
            previous(what)

    sys.unraisablehook = hook
