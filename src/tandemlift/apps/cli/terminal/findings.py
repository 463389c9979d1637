"""Findings on the terminal: a line each on standard error, and the exit code of `--strict`."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight

FOUND = 3  # exit code of a flight with findings, with --strict

strict_option: Callable[[Any], Any] = click.option(
    "--strict", is_flag=True, help="Exit with 3 if there are findings; see `findings.ignore` for kinds to leave out."
)


def print_findings(flights: Iterable[tuple[str, Flight]]) -> int:
    """Print a line on standard error for each finding of flights by name; return their number."""
    count = 0
    for name, flight in flights:
        for finding in flight.findings:
            click.echo(f"{_coloured(f'{name}: {finding.kind}')} {str(finding).partition(' ')[2]}", err=True)
            count += 1
    return count


def exit_if_found(count: int, *, strict: bool) -> None:
    """End the process if there are findings and `--strict` was given."""
    if count and strict:
        sys.exit(FOUND)


def _coloured(text: str) -> str:
    """Text in bold yellow; plain where the output is no terminal (which click sees to) or NO_COLOR is set."""
    return text if os.environ.get("NO_COLOR") else click.style(text, fg="yellow", bold=True)
