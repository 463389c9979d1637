"""The terminal: output, progress bars, the table of checks, and the end of the process on Ctrl-C."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.notices import compile_notices
from tandemlift.core.errors import CLOSE, FAILS, REFUSED, CheckResult
from tandemlift.core.progress import shown_progress

if TYPE_CHECKING:
    from tandemlift.core.types import Progress

COLOURS = {CLOSE: "yellow", FAILS: "red", REFUSED: "red"}  # of the verdicts of checks
CLOSEST = 3  # checks that are named above the table


def echo(*lines: str, nl: bool = True) -> None:
    """Print lines to standard output; if it is closed (`| head`), continue without it; if it is full, say so."""
    try:
        for line in lines:
            click.echo(line, nl=nl)
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            raise OSError(error.errno, error.strerror, "standard output") from None


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


def print_checks(results: Sequence[CheckResult]) -> None:
    """Print the closest checks, the table of all, their texts and their counts, each in the colour of its verdict."""
    if not results:
        echo("no check applies to this mission")
        return
    tight = sorted(
        (r.margin, f"{r.check} {r.subject}".rstrip())
        for r in results
        if r.margin is not None and (r.margin >= 0 or r.verdict == FAILS)
    )
    if len(tight) > CLOSEST:
        echo("closest to their limits: " + ", ".join(f"{name} ({100 * left:.0f} %)" for left, name in tight[:CLOSEST]))
        echo("")
    from tandemlift.missions.checks import check_lines

    for verdict, line in check_lines(results):
        echo(click.style(line, fg=COLOURS.get(verdict)) if verdict else line)


def exit_now(status: int) -> None:
    """End the process at once: Python would wait for a thread that compiles, which cannot be interrupted."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    if util := sys.modules.get("multiprocessing.util"):
        util._run_finalizers()  # frees the semaphores of worker processes
    os._exit(status)
