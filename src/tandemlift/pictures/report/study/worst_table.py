"""The worst rows in a study's page: why each is among them, what varied, and the command that flies it again."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from tandemlift.analysis.studies.quantities import finite
from tandemlift.analysis.studies.study_rows import WHO, StudyRows
from tandemlift.analysis.studies.worst import WorstRow, reasons, worst_rows
from tandemlift.pictures.report.findings_section import with_keys
from tandemlift.pictures.report.flight_report import html_table, number
from tandemlift.pictures.report.study.words import html_row_command, shown_column, shown_quantity

MOST_VALUES = 6  # of what varied


def html_worst(rows: StudyRows) -> str:
    """The worst rows as a table."""
    worst = worst_rows(rows)
    if not worst:
        return "<p>No row flew.</p>"
    lines = [_line(rows, one, said) for one, said in zip(worst, reasons(rows, worst), strict=True)]
    titles = ("Row", "Why", "What varied", "Fly it again, with figures")
    head = "<tr>" + "".join(f'<th scope="col">{title}</th>' for title in titles) + "</tr>"
    note = "Failed flights first, the soonest stopped first; then the worst values of each quantity in turn."
    return f'<p class="soft">{note}</p>\n{html_table(head, lines, "worst")}'


def _line(rows: StudyRows, one: WorstRow, said: dict[str, Any]) -> str:
    row = int(rows.number[one.place])
    cells = (_why(rows, one, said), _what(rows, one.place, said), html_row_command(rows.study.folder, row))
    return f'<tr><td class="number">{row}</td>' + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def _why(rows: StudyRows, one: WorstRow, said: dict[str, Any]) -> str:
    found = f"; findings: {escape(said['finding_kinds'].replace(',', ', '))}" if said["finding_kinds"] else ""
    if one.quantity is None:
        return f"<strong>{escape(said['outcome'])}</strong>: {with_keys(_cause(said))}{found}"
    values = rows.values[one.quantity.name]
    shown = shown_quantity(one.quantity, values)
    value, median = (number(float(v) * shown.scale) for v in (values[one.place], np.median(finite(values))))
    return f"{escape(shown.words)} {value} {shown.unit}".rstrip() + (
        f"; the median of all is {median} {shown.unit}".rstrip() + found
    )


def _cause(said: dict[str, Any]) -> str:
    """Why a flight failed, without its outcome, which stands before it."""
    return str(said["reason"]).removeprefix(said["outcome"]).removeprefix(":").strip() or "no reason was kept"


def _what(rows: StudyRows, place: int, said: dict[str, Any]) -> str:
    telling = [name for name in WHO if len(rows.labels[name].names) > 1]
    parts = [rows.labels[name].names[rows.labels[name].codes[place]] for name in telling]
    names = [name for name in rows.study.varied if name in rows.varied]
    values = [
        f'<span class="key"><code>{escape(name)}</code> {_shown(said[name], shown_column(name).unit)}</span>'
        for name in names[:MOST_VALUES]
    ]
    more = [f"and {len(names) - MOST_VALUES} more"] if len(names) > MOST_VALUES else []
    return ", ".join([*[escape(part) for part in parts if part], *values, f"seed {said['seed']}", *more])


def _shown(value: object, unit: str) -> str:
    return f"{number(value) if isinstance(value, (int, float)) else escape(str(value))} {unit}".rstrip()
