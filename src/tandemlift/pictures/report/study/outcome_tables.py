"""Tables of a study: how often each outcome came, by group, on the page, as CSV and for LaTeX; and the worst rows."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.execution.statistics import Share, finite, share
from tandemlift.analysis.studies.study_rows import WHO, RowGroup, StudyRows
from tandemlift.analysis.studies.worst import WorstRow, reasons, worst_rows
from tandemlift.core.files import write_files
from tandemlift.core.phases import OUTCOMES
from tandemlift.pictures.report.metric_tables import NUMBER, latex_number, latex_table, latex_text
from tandemlift.pictures.report.page import Cell, number, strong, with_keys
from tandemlift.pictures.report.study.words import row_command, shown_column, shown_quantity

MOST_GROUPS = 24  # rows of a table to be read


def tabled_groups(rows: StudyRows) -> list[RowGroup]:
    """The groups that a table shows: all of them, or those with most bad outcomes."""
    worst = sorted(rows.groups, key=lambda group: -float(rows.bad[group.places].mean()))
    return rows.groups if len(rows.groups) <= MOST_GROUPS else worst[:MOST_GROUPS]


def outcome_counts(rows: StudyRows, groups: Sequence[RowGroup]) -> Iterator[tuple[str, Share, dict[str, int]]]:
    """For each of some groups, and for all rows if there are several: its name, its bad rows, its rows by outcome."""
    codes, names = rows.labels["outcome"]
    order = [kind.name for kind in OUTCOMES] + [REFUSED]
    known = sorted(range(len(names)), key=lambda i: order.index(names[i]) if names[i] in order else len(order))
    everything = RowGroup("all rows", np.arange(len(rows)))
    for group in groups if len(rows.groups) == 1 else [*groups, everything]:
        numbers = np.bincount(codes[group.places], minlength=len(names))
        bad = share(int(rows.bad[group.places].sum()), len(group.places))
        yield group.name, bad, {names[i]: int(numbers[i]) for i in known}


def outcomes_as_csv(rows: StudyRows) -> str:
    """All groups: rows, share of bad outcomes with its interval of 95 %, and rows by outcome."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    for place, (name, bad, numbers) in enumerate(outcome_counts(rows, rows.groups)):
        if not place:
            table.writerow(["group", "rows", "bad", "bad_share", "bad_share_low", "bad_share_high", *numbers])
        table.writerow([name, bad.total, bad.number, bad.value, bad.low, bad.high, *numbers.values()])
    return text.getvalue()


def outcomes_as_latex(rows: StudyRows) -> str:
    """The groups that the page shows, with the share of bad outcomes and its interval in percent."""
    lines, head = [], list[str]()
    for name, bad, numbers in outcome_counts(rows, tabled_groups(rows)):
        percents = [100.0 * value for value in (bad.value, bad.low, bad.high)]
        head = ["Group", *map(_over_two, ("Rows", r"Bad (\%)", r"from (\%)", r"to (\%)", *map(latex_text, numbers)))]
        lines.append([latex_text(name), *map(latex_number, (bad.total, *percents, *numbers.values()))])
    note = f"Outcomes of the study {rows.study.name}; the interval of the bad ones is that of Clopper and Pearson, 95 %"
    return latex_table(f"l{NUMBER * (len(head) - 1)}", head, lines, note)


def _over_two(head: str) -> str:
    return rf"\multicolumn{{2}}{{c}}{{{head}}}"


def write_outcomes(rows: StudyRows, folder: Path) -> None:
    """Write outcomes.csv and outcomes.tex into a folder, both or none."""
    write_files(folder, {"outcomes.csv": outcomes_as_csv(rows), "outcomes.tex": outcomes_as_latex(rows)})


MOST_VALUES = 6  # of the varied keys


class ShownRow(NamedTuple):
    """A row of the worst ones: its number, why it is among them, what varied, and the command that flies it again."""

    number: int
    why: str
    varied: list[Cell]
    command: str


def shown_worst(rows: StudyRows) -> Iterator[ShownRow]:
    """The worst rows: failed flights first, the soonest stopped first; then the worst of each quantity in turn."""
    worst = worst_rows(rows)
    for one, said in zip(worst, reasons(rows, worst), strict=True):
        row = int(rows.number[one.place])
        yield ShownRow(row, _why(rows, one, said), _varied(rows, one.place, said), row_command(rows.study.folder, row))


def _why(rows: StudyRows, one: WorstRow, said: dict[str, Any]) -> str:
    found = f"; findings: {said['finding_kinds'].replace(',', ', ')}" if said["finding_kinds"] else ""
    if one.quantity is None:
        return strong(said["outcome"]) + ": " + with_keys(_cause(said)) + found
    values = rows.values[one.quantity.name]
    shown = shown_quantity(one.quantity, values)
    value, median = (number(float(v) * shown.scale) for v in (values[one.place], np.median(finite(values))))
    return f"{shown.words} {value} {shown.unit}".rstrip() + (
        f"; the median of all is {median} {shown.unit}".rstrip() + found
    )


def _cause(said: dict[str, Any]) -> str:
    """Why a flight failed, without its outcome, which stands before it."""
    return str(said["reason"]).removeprefix(said["outcome"]).removeprefix(":").strip() or "no reason was kept"


def _varied(rows: StudyRows, place: int, said: dict[str, Any]) -> list[Cell]:
    """What varied in a row: the groups it belongs to, keys with their values as pairs, and the seed."""
    telling = [name for name in WHO if len(rows.labels[name].names) > 1]
    parts = [rows.labels[name].names[rows.labels[name].codes[place]] for name in telling]
    names = [name for name in rows.study.varied if said.get(name) is not None]
    values = [(name, _shown(said[name], shown_column(name).unit)) for name in names[:MOST_VALUES]]
    more = [f"and {len(names) - MOST_VALUES} more"] if len(names) > MOST_VALUES else []
    return [*filter(None, parts), *values, f"seed {said['seed']}", *more]


def _shown(value: object, unit: str) -> str:
    return f"{number(value) if isinstance(value, (int, float)) else value} {unit}".rstrip()
