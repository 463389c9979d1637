"""A study as a short table, for notebooks."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

from tandemlift.analysis.studies.design.statistics import share

if TYPE_CHECKING:
    import pyarrow

MOST_NAMES = 8


def percent(value: float) -> str:
    """A share in percent, to three digits."""
    return f"{100.0 * value:.3g} %"


def study_html(name: str, rows: int, count: int, varied: Sequence[str], outcomes: pyarrow.Table) -> str:
    """Name and size of a study, varied keys, and the share of each outcome with its interval.

    Args:
        name: of the study.
        rows: that are flown.
        count: of rows in all.
        varied: columns.
        outcomes: the column `outcome` of the rows.
    """
    found = {one["values"]: one["counts"] for one in outcomes["outcome"].value_counts().to_pylist()}
    lines = []
    for outcome, number in sorted(found.items(), key=lambda pair: -pair[1]):
        part = share(number, rows)
        interval = f"{percent(part.low)} to {percent(part.high)}"
        cells = (escape(outcome), f"{number:,}", percent(part.value), interval)
        lines.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    missing = f" of {count:,}" if rows < count else ""
    names = [f"<code>{escape(key)}</code>" for key in varied[:MOST_NAMES]]
    more = f" and {len(varied) - MOST_NAMES} more" if len(varied) > MOST_NAMES else ""
    head = "".join(f"<th>{title}</th>" for title in ("outcome", "rows", "share", "95 % interval"))
    said = f"<p><b>{escape(name)}</b>: {rows:,}{missing} rows; varied: {', '.join(names) or 'nothing'}{more}</p>"
    return f"{said}<table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
