"""The outcomes of a study as tables: how often each came, by group; on the page, as CSV and for LaTeX."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.quantities import Share, share
from tandemlift.analysis.studies.study_rows import RowGroup, StudyRows
from tandemlift.core.files import atomic_write
from tandemlift.core.phases import OUTCOMES
from tandemlift.pictures.report.latex import NUMBER, latex_number, latex_table, latex_text

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
    """Write outcomes.csv and outcomes.tex into a folder; each appears whole or not at all."""
    for kind, text in (("csv", outcomes_as_csv(rows)), ("tex", outcomes_as_latex(rows))):
        with atomic_write(folder / f"outcomes.{kind}") as partial:
            partial.write_text(text, "utf-8")
