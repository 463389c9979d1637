"""The results of a mission's checks as a table, and their texts."""

from __future__ import annotations

import math
from collections.abc import Sequence

import click

from tandemlift.apps.cli.terminal.console import echo
from tandemlift.core.errors import CLOSE, FAILS, OK, REFUSED, CheckResult

COLOURS = {OK: None, CLOSE: "yellow", FAILS: "red", REFUSED: "red"}
HEAD = ("check", "of", "value", "limit", "unit", "margin", "verdict")


def print_checks(results: Sequence[CheckResult]) -> None:
    """Print a row for each result, then the texts, then the number of failures."""
    rows = [HEAD, *[_row(result) for result in results]]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEAD))]
    for row, result in zip(rows, [None, *results], strict=True):
        cells = [
            cell.rjust(w) if i in (2, 3, 5) else cell.ljust(w)
            for i, (cell, w) in enumerate(zip(row, widths, strict=True))
        ]
        line = "  ".join(cells).rstrip()
        echo(line if result is None else click.style(line, fg=COLOURS[result.verdict]))
    for result in results:
        if result.text:
            echo(click.style(f"{result.verdict}: {result.text}", fg=COLOURS[result.verdict]))
    counts = {verdict: sum(result.verdict == verdict for result in results) for verdict in (OK, CLOSE, FAILS)}
    echo(", ".join(f"{count} {verdict}" for verdict, count in counts.items()))


def _row(result: CheckResult) -> tuple[str, ...]:
    margin = "" if result.margin is None else f"{100.0 * result.margin:.0f} %"
    unit = "" if result.unit == "1" else result.unit
    return result.check, result.subject, _number(result.value), _number(result.limit), unit, margin, result.verdict


def _number(value: float | None) -> str:
    return "" if value is None else "none" if math.isinf(value) else f"{value:.3g}"
