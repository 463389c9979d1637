"""The table of a class, from the grades of its notebooks."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence

from tandemlift.apps.live.grading import Grade, Notebook


def table_of(grades: Mapping[Notebook, Grade]) -> list[list[str]]:
    """The table of a class: a row for each name, a column for the points of each exercise, and their sum."""
    exercises = sorted({one.exercise for one in grades})
    best = dict[str, dict[str, int]]()
    for one, got in grades.items():
        row = best.setdefault(one.name, {})
        row[one.exercise] = max(got.points, row.get(one.exercise, 0))
    rows = [[name, *(str(row.get(e, "–")) for e in exercises), str(sum(row.values()))] for name, row in best.items()]
    return [["name", *exercises, "points"], *sorted(rows)]


def remarks_of(grades: Mapping[Notebook, Grade]) -> list[str]:
    """A line for each notebook that did not run to its end, and for each check that failed, with its hint."""
    lines = list[str]()
    for one, got in sorted(grades.items()):
        lines += [f"{one.name}, {one.exercise}: {got.failure}"] if got.failure else []
        lines += [f"{one.name}, {one.exercise}: {c.title} {c.hint}" for c in got.checks if c.hint]
    return lines


def csv_of(table: Sequence[Sequence[str]]) -> str:
    """The table as the text of a CSV file."""
    csv.writer(text := io.StringIO()).writerows(table)
    return text.getvalue()


def lines_of(table: Sequence[Sequence[str]], remarks: Sequence[str]) -> Iterator[str]:
    """The table with aligned columns, and what there is to say about its notebooks."""
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for name, *points in table:
        yield "  ".join([f"{name:{widths[0]}}", *(f"{p:>{w}}" for p, w in zip(points, widths[1:], strict=True))])
    yield from ["", *remarks] if remarks else []
