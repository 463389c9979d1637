"""The results of checks: as lines of a report, and the worst of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from tandemlift.core.errors import CLOSE, FAILS, OK, REFUSED, SETTINGS, CheckResult

WORST_FIRST = (REFUSED, FAILS, CLOSE, OK)
HEAD = ("check", "of", "value", "limit", "unit", "margin", "verdict")  # of the table of checks


def check_lines(results: Sequence[CheckResult]) -> Iterator[tuple[str, str]]:
    """Verdict and text of each line of a report: a table with a row for each result, worst first; texts; counts."""
    results = sorted(results, key=lambda result: WORST_FIRST.index(result.verdict))
    rows = [HEAD, *map(_check_row, results)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEAD))]
    for row, verdict in zip(rows, ["", *(result.verdict for result in results)], strict=True):
        cells = enumerate(zip(row, widths, strict=True))
        yield verdict, "  ".join(cell.rjust(w) if i in (2, 3, 5) else cell.ljust(w) for i, (cell, w) in cells).rstrip()
    yield from ((result.verdict, f"{result.verdict}: {result.text}") for result in results if result.text)
    counts = {verdict: sum(result.verdict == verdict for result in results) for verdict in (OK, CLOSE, FAILS)}
    yield "", ", ".join(f"{count} {verdict}" for verdict, count in counts.items())


def _check_row(result: CheckResult) -> tuple[str, ...]:
    is_advice = result.verdict == CLOSE and result.margin is not None and result.margin < 0.0
    margin = "" if result.margin is None else "advice" if is_advice else f"{100.0 * result.margin:.0f} %"
    value, limit = ("" if x is None else "none" if math.isinf(x) else f"{x:.3g}" for x in (result.value, result.limit))
    return result.check, result.subject, value, limit, "" if result.unit == "1" else result.unit, margin, result.verdict


def worst_failures(results: Iterable[CheckResult]) -> Iterator[CheckResult]:
    """The worst failure of each check, and every failure of settings."""
    failed: dict[str, list[CheckResult]] = {}
    for result in results:
        if result.verdict == FAILS:
            failed.setdefault(result.text if result.check == SETTINGS else result.check, []).append(result)
    yield from (max(many, key=_excess) for many in failed.values())


def _excess(result: CheckResult) -> float:
    """The excess of a result over its limit, as a fraction of the limit."""
    if result.value is None or result.limit is None or result.limit <= 0.0:
        return float("inf")
    return result.value / result.limit
