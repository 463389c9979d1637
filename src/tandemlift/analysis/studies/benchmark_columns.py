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

from tandemlift.analysis.studies.benchmark_entry import Kind
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
MISSED = 0.5  # of the push: an estimate that misses more has no delay; by least squares, none at all would have 0 ms


def delay(row: Row) -> float | None:
    """The delay of an estimate [ms] in the nominal flight."""
    error, push = (math.hypot(*row.get(f"push_force_{x}_n") or (0.0,)) for x in ("rmse", "rms"))
    return None if error > MISSED * push else metric("push_delay_s", None, 1e3, NOMINAL)(row)


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
        Column("delay (ms)", "pushes", delay),
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


WIDTH, NAME = 80, 24  # of a terminal and of a name, in characters


def lines_of(kind: Kind, rows: Mapping[str, Scores], own: str = "") -> list[str]:
    """Tables as Markdown that fit a terminal: a column for each row of the scores; that of `own` is in every table."""

    def column(name: str) -> list[str]:
        head, numbers = name if len(name) <= NAME else f"{name[: NAME - 1]}…", [rows[name].get(t) for t in titles]
        shown = ("–" if x is None else f"{x:,.0f}" if abs(x) >= 1e3 else f"{x:.4g}" for x in numbers)
        return _wide([head, ":", *shown], str.rjust)

    titles = [column.title for column in TABLES[kind]]
    first = [_wide([kind, "", *titles], str.ljust), *([column(own)] if own else [])]
    tables = [first]
    for table_column in (column(name) for name in rows if name != own):
        if sum(len(c[0]) + 3 for c in (*tables[-1], table_column)) >= WIDTH:
            tables.append(first)
        tables[-1] = [*tables[-1], table_column]
    lines = [[f"| {' | '.join(row)} |" for row in zip(*table, strict=True)] for table in tables]
    return [line for table in lines for line in (*table, "")][:-1]


def _wide(texts: list[str], align: Callable[[str, int], str]) -> list[str]:
    """Texts of one width; the second, of the rule below the head, is filled with dashes."""
    size = max(map(len, texts))
    return [align(text, size) if i != 1 else "-" * (size - len(text)) + text for i, text in enumerate(texts)]


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
