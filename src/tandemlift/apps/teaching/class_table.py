"""The table of a class, from the grades of its notebooks."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path

from tandemlift.apps.teaching.grading import Grade
from tandemlift.apps.teaching.hand_ins import Notebook, Skipped
from tandemlift.apps.teaching.running import graded_each
from tandemlift.core.files import write_file
from tandemlift.core.types import Progress

NONE, LATER = "–", "not graded yet"


def table_of(notebooks: Iterable[Notebook], grades: Mapping[Notebook, Grade]) -> list[list[str]]:
    """The table of a class: a row for each name, a column for the points of each exercise, and their sum."""
    exercises = sorted({one.exercise for one in notebooks})
    best = dict[str, dict[str, int | None]]()
    for one in notebooks:
        row, got = best.setdefault(_line(one.name), {}), grades.get(one)
        points = [row.get(one.exercise), got.points if got else None]
        row[one.exercise] = max((some for some in points if some is not None), default=None)
    rows = list[list[str]]()
    for name, row in sorted(best.items()):
        cells = [NONE if e not in row else LATER if row[e] is None else str(row[e]) for e in exercises]
        rows.append([name, *cells, str(sum(points or 0 for points in row.values()))])
    return [["name", *exercises, "points"], *rows]


def remarks_of(grades: Mapping[Notebook, Grade]) -> list[tuple[str, str]]:
    """Name and remark of each notebook that did not run to its end, and of each check that failed, with its hint."""
    remarks = list[tuple[str, str]]()
    for one, got in sorted(grades.items()):
        said = [got.failure] * bool(got.failure) + [f"{c.title} {c.hint}" for c in got.checks if c.hint]
        remarks += [(_line(one.name), _line(f"{one.exercise}: {text}")) for text in said]
    return remarks


def csv_of(notebooks: Iterable[Notebook], grades: Mapping[Notebook, Grade], skipped: Iterable[Skipped]) -> str:
    """The table as the text of a CSV file, with a column of remarks, and a row for each name of `skipped`, too.

    Other texts than numbers that a spreadsheet would take for a formula begin with an apostrophe.
    """
    (*head, _), *rows = ([*row, ""] for row in table_of(notebooks, grades))
    said = [*remarks_of(grades), *((_line(one.name), _line(str(one))) for one in skipped)]
    missing = sorted({name for name, _ in said} - {row[0] for row in rows})
    rows += [[name, *[NONE] * (len(head) - 2), "0", ""] for name in missing]
    for row in rows:
        row[-1] = " | ".join(text for name, text in said if name == row[0])
    cells = ([f"'{cell}" if cell.startswith(("=", "+", "-", "@")) else cell for cell in row] for row in rows)
    csv.writer(text := io.StringIO()).writerows([[*head, "remarks"], *cells])
    return text.getvalue()


def fill(
    grades: dict[Notebook, Grade],
    hand_ins: tuple[Sequence[Notebook], Sequence[Skipped]],
    exercises: Path,
    seconds: float,
    path: Path | None,
    progress: Progress | None,
) -> None:
    """Grade notebooks, each within some seconds, into `grades`; write the table of `csv_of` at `path` after each."""
    with closing(graded_each(hand_ins[0], exercises, seconds)) as graded:
        for one, got in graded:
            grades[one] = got
            if path:
                write_file(path, csv_of(hand_ins[0], grades, hand_ins[1]))
            if progress:
                progress(len(grades), len(hand_ins[0]))


def lines_of(
    notebooks: Iterable[Notebook], grades: Mapping[Notebook, Grade], skipped: Iterable[Skipped]
) -> Iterator[str]:
    """The table with aligned columns, and what there is to say about its notebooks and about what is none."""
    table, remarks = table_of(notebooks, grades), [f"{name}, {text}" for name, text in remarks_of(grades)]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for name, *points in table:
        yield "  ".join([f"{name:{widths[0]}}", *(f"{p:>{w}}" for p, w in zip(points, widths[1:], strict=True))])
    remarks += [_line(str(one)) for one in skipped]
    yield from ["", *remarks] if remarks else []


def _line(text: str) -> str:
    """A text on one line, without characters that a terminal or a file of UTF-8 cannot show."""
    return "".join(c if c.isprintable() else "\ufffd" for c in " ".join(text.split()))
