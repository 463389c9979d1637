"""The columns of the benchmark's tables: what each is formed of, for controllers, observers and policies.

Means are sums of `math.fsum`, so that the numbers do not depend on the processor.
"""

from __future__ import annotations

import csv
import io
import json
import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from tandemlift.analysis.studies.design.benchmark_entry import Kind
from tandemlift.core.phases import FAILURES

Row = dict[str, Any]  # the metrics of a flight, with its case, and what its channels say; {} of a refused one
Scores = dict[str, float | None]  # by title


class Column(NamedTuple):
    """A number of a row: its title, its task, the number of a flight, and how these become one."""

    title: str
    task: str
    number: Callable[[Row], float | None]
    form: Callable[[list[float]], float] = statistics.fmean

    def of(self, rows: Sequence[Row]) -> float | None:
        """The number, to six digits; None without flights for it, or if it is infinite."""
        numbers = [x for x in map(self.number, rows) if x is not None]
        number = self.form(numbers) if numbers else math.inf
        return float(f"{number:.6g}") if math.isfinite(number) else None


def rms(numbers: list[float]) -> float:
    """The root of the mean of squares."""
    return math.sqrt(math.fsum(x * x for x in numbers) / len(numbers))


def metric(name: str, place: int | None = None, factor: float = 1.0, case: str = "") -> Callable[[Row], float | None]:
    """A metric, or one of its components, of flights that did not fail; of one case, or of all."""

    def number(row: Row) -> float | None:
        value = None if has_failed(row) or case not in ("", row["case"]) else row.get(name)
        return None if value is None else factor * (value if place is None else value[place])

    return number


def percent(has: Callable[[Row], object]) -> Callable[[Row], float]:
    """100 of a flight that has something, and 0 of others and of refused ones."""
    return lambda row: 100.0 * bool(row and has(row))


def has_failed(row: Row) -> bool:
    """Whether a flight was refused or failed."""
    return not row or row["outcome"] in FAILURES


def _axes(title: str, names: str, task: str, name: str, factor: float) -> list[Column]:
    """Columns of the components of an error."""
    return [Column(title.format(n), task, metric(name, i, factor), rms) for i, n in enumerate(names.split())]


def false_hands(case: str) -> Column:
    """The pushes that are followed in 1,000 minutes in which nobody pushes; flights have steps of 1 ms."""
    followed = metric("push_triggers_after_10s", case=case)

    def number(row: Row) -> float | None:
        hands = followed(row)
        return None if hands is None else 1e3 * hands * 60.0 / (1e-3 * row["steps"] - 10.0)

    return Column(f"false hands, {case}", "hover", number)


TRACKED, NOMINAL = "position_rmse_after_10s_m", "nominal"
TABLES: dict[Kind, tuple[Column, ...]] = {
    "controllers": (
        *_axes("RMSE {} (mm)", "x y z", "tracking", TRACKED, 1e3),
        Column("lost draws (%)", "draws", lambda row: 100.0 * has_failed(row)),
        *_axes("RMSE {}, draws (mm)", "x y z", "draws", TRACKED, 1e3),
        Column("through (%)", "corridor", percent(lambda row: row["score_s"] is not None)),
        Column("score (s)", "corridor", metric("score_s"), statistics.median),
        Column("work (J)", "corridor", lambda row: None if row.get("score_s") is None else row["human_work_j"]),
        Column("touches", "corridor", metric("touches")),
    ),
    "observers": (
        Column("lost (%)", "pushes", lambda row: 100.0 * has_failed(row)),
        *_axes("F {} (N)", "x y z", "pushes", "push_force_rmse_n", 1.0),
        *_axes("M {} (N m)", "roll pitch yaw", "pushes", "push_moment_rmse_n_m", 1.0),
        Column("delay (ms)", "pushes", metric("push_delay_s", None, 1e3, NOMINAL)),
        Column("smallest push (N)", "steps", metric("smallest_push_n"), max),
        *map(false_hands, (NOMINAL, "mass +20 %", "wind of 1 m/s", "wind of 2 m/s")),
    ),
    "policies": (
        Column("landed (%)", "persons", percent(lambda row: row["outcome"] == "landed")),
        Column("no finding (%)", "persons", percent(lambda row: not row["findings"])),
        Column("work (J)", "persons", metric("human_work_j")),
        Column("force (N)", "persons", metric("human_force_mean_n")),
        Column("led for (s)", "persons", metric("human_time_s")),
    ),
}
"""The columns, in the order of the tables."""


def lines_of(kind: Kind, rows: Mapping[str, Scores]) -> list[str]:
    """A table as Markdown."""
    titles = [column.title for column in TABLES[kind]]
    cells = [[name, *("" if row.get(t) is None else f"{row[t]:.4g}" for t in titles)] for name, row in rows.items()]
    columns = list(zip([kind, *titles], *cells, strict=True))
    sizes = [max(map(len, column)) for column in columns]
    body = [
        " | ".join([row[0].ljust(sizes[0]), *map(str.rjust, row[1:], sizes[1:])]) for row in zip(*columns, strict=True)
    ]
    rule = "|".join(["-" * (sizes[0] + 2), *("-" * (size + 1) + ":" for size in sizes[1:])])
    return [f"| {body[0]} |", f"|{rule}|", *(f"| {line} |" for line in body[1:])]


def json_of(tables: Mapping[Kind, Mapping[str, Scores]]) -> str:
    """Tables as JSON: by kind, row and title; null without a value."""
    return json.dumps(tables, indent=1, ensure_ascii=False) + "\n"


def csv_of(tables: Mapping[Kind, Mapping[str, Scores]]) -> str:
    """Tables as CSV, a line for each value; NaN for one that is missing."""
    write = csv.writer(text := io.StringIO(), lineterminator="\n").writerow
    write(("kind", "name", "column", "value"))
    for kind, rows in tables.items():
        for name, row in rows.items():
            for title, value in row.items():
                write((kind, name, title, "NaN" if value is None else value))
    return text.getvalue()
