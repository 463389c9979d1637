"""The tables of a study's page: flights, outcomes, findings, quantiles of metrics."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.design.keys import changes_in
from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.execution.statistics import Share, finite, quantile, share, upper_bound
from tandemlift.analysis.studies.study_rows import StudyRows
from tandemlift.analysis.studies.table import Study
from tandemlift.core.errors import shown
from tandemlift.core.findings import KIND_OF
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Array
from tandemlift.pictures.report.page import DASH, Cell, PageTable, Verdict, html, number, split_unit, with_keys
from tandemlift.pictures.report.study.outcome_tables import MOST_GROUPS, outcome_counts, tabled_groups
from tandemlift.pictures.report.study.words import QuantityDisplay, row_command, shown_column, shown_quantity

MOST_COLUMNS = 6  # of groups beside each other
MOST_REASONS = 5
MOST_REFUSED = 1_000  # rows of which the reasons are read
MOST_LISTED = 8  # values of a key, or changes of a case
THIN_SPACE = "\u202f"


def count(value: int) -> str:
    """A whole number with its digits in groups of three."""
    return f"{value:,}".replace(",", THIN_SPACE)


def counted(value: int, noun: str) -> str:
    """A number of things, such as 2 rows."""
    return f"{count(value)} {noun}{'' if value == 1 else 's'}"


def percent(value: float) -> str:
    """A share in percent, to three digits."""
    text = f"{100.0 * value:.3g}"
    return f"{number(100.0 * value) if 'e' in text else text.replace('-', '−')} %"


def share_cell(part: Share) -> Cell:
    """A share in percent over its interval."""
    if not part.total:
        return DASH
    low, high = percent(part.low).removesuffix(" %"), percent(part.high)
    return percent(part.value), f"{low} to {high}"


def verdict(rows: StudyRows) -> Verdict:
    """The numbers of flights that failed and that have findings, with bounds; those of refused and missing rows."""
    flown = len(rows) - int(rows.refused.sum())
    failed = int(rows.bad.sum()) - int(rows.refused.sum())
    head, said = "No flight", "."
    if failed:
        part = share(failed, flown)
        head = f"{count(failed)} of {count(flown)} flights failed" if flown > 1 else "The flight failed"
        low, high = percent(part.low), percent(part.high)
        said = f". {percent(part.value)} fail, with 95 % confidence between {low} and {high}."
    elif flown:
        most, high = percent(upper_bound(0, flown)), percent(share(0, flown).high)
        head = f"None of {count(flown)} flights failed" if flown > 1 else "The flight did not fail"
        said = f". With 95 % confidence, at most {most} fail "
        said += f"(one-sided bound; the intervals in the tables are two-sided: 0 to {high})."
    if kinds := rows.finding_counts:
        kind, has = next(iter(kinds.items()))
        having = int(np.any(list(kinds.values()), axis=0).sum())
        head += f"; {count(having)} {'has' if having == 1 else 'have'} findings"
        said = f", most often {kind} ({percent(int(has.sum()) / flown)}){said}"
    if refused := int(rows.refused.sum()):
        said += f" {counted(refused, 'row')} could not be flown and {'was' if refused == 1 else 'were'} refused."
    if missing := rows.study.missing:
        said += f" {count(missing)} of {count(rows.study.plan.count)} rows {'is' if missing == 1 else 'are'} missing."
    return Verdict(head, said, "missed" if failed or refused or missing or kinds else "")


def what_was_flown(study: Study) -> Iterator[tuple[str, str]]:
    """Missions, controllers and varied keys."""
    plan, settings = study.plan, study.settings
    for what, names in (
        ("Missions", [v.mission for v in plan.variants]),
        ("Controllers", [v.controller for v in plan.variants]),
        ("Engines", [v.engine for v in plan.variants]),
    ):
        yield what, ", ".join(dict.fromkeys(names))
    if settings.set:
        yield "Set in all", _changes(settings.set)
    for case in settings.cases:
        yield f"Case {case.name}", _changes(case.set) or "as it is"
    for key, values in plan.grid.items():
        listed = ", ".join(map(shown, values[:MOST_LISTED])) + (", …" if len(values) > MOST_LISTED else "")
        yield "Grid", f"{key}: {counted(len(values), 'value')}, {listed}{_unit(key)}"
    for key, distribution in plan.drawn.items():
        said = distribution.model_dump(exclude_defaults=True)
        kind = said.pop("distribution")
        numbers = ", ".join(f"{name} {shown(value)}" for name, value in said.items())
        yield "Drawn", f"{key}: {kind}, {numbers}{'' if distribution.relative else _unit(key)}"
    if plan.drawn:
        yield "Draws", f"{plan.point_count}, sampling {settings.study.sampling}, seed {settings.study.seed}"
    if settings.study.seeds > 1:
        yield "Seeds", f"{settings.study.seeds} of each"
    yield "Rows", f"{len(study)} of {plan.count}"


def _unit(key: str) -> str:
    unit = shown_column(key).unit
    return f" {unit}" if unit else ""


def _changes(tables: dict[str, Any]) -> str:
    found = [f"{key} = {shown(value)}" for key, value in changes_in(tables).items()]
    return ", ".join(found[:MOST_LISTED]) + (
        f" and {len(found) - MOST_LISTED} more" if len(found) > MOST_LISTED else ""
    )


def left_out(rows: StudyRows) -> str:
    """A note of the groups that a table leaves out."""
    count = len(rows.groups)
    return f"The {MOST_GROUPS} with most bad outcomes of {count}." if count > MOST_GROUPS else ""


def bad_kinds(rows: StudyRows) -> str:
    """The outcomes that count as bad."""
    return ", ".join([*FAILURES, *([REFUSED] if rows.refused.any() else [])])


def outcomes(rows: StudyRows) -> PageTable:
    """The counts of each outcome by group, and the share of the bad ones with its interval."""
    lines, names = list[Sequence[Cell]](), list[str]()
    for group, bad, numbers in outcome_counts(rows, tabled_groups(rows)):
        lines.append((group, count(bad.total), share_cell(bad), *map(count, numbers.values())))
        names = list(numbers)
    return PageTable("counts", ("", "rows", ("bad", "95 % interval"), *names), lines)


def refusals(rows: StudyRows) -> list[tuple[str, str, str]]:
    """Why rows were refused: the most frequent reasons, numbers apart, each with a row and the command to fly it."""
    places = np.flatnonzero(rows.refused)
    looked_at = places[:: max(1, len(places) // MOST_REFUSED)]
    found = defaultdict[str, list[dict[str, Any]]](list)
    for row in rows.study.rows(rows.number[looked_at].tolist(), ["row", "reason"]) if len(places) else ():
        found[re.sub(r"[\d.]+", "0", row["reason"] or "")].append(row)
    frequent = sorted(found.values(), key=len, reverse=True)[:MOST_REASONS]
    return [
        (
            f"{percent(len(same) / len(looked_at))} of them, such as row {same[0]['row']}: ",
            same[0]["reason"] or "",
            row_command(rows.study.folder, same[0]["row"]),
        )
        for same in frequent
    ]


def findings(rows: StudyRows) -> PageTable | None:
    """The number of rows with each kind of finding, by group if these are few; None without a finding."""
    if not rows.finding_counts:
        return None
    groups = rows.groups if 1 < len(rows.groups) <= MOST_COLUMNS else []
    flown, lines = ~rows.refused, list[Sequence[Cell]]()
    for kind, has in rows.finding_counts.items():
        meaning = html('{}<br><small class="meaning">{}</small>').format(
            kind, with_keys(KIND_OF[kind].meaning if kind in KIND_OF else "")
        )
        parts = [share(int(has[g.places].sum()), int(flown[g.places].sum())) for g in groups]
        whole = share(int(has.sum()), int(flown.sum()))
        lines.append((meaning, count(int(has.sum())), share_cell(whole), *map(share_cell, parts)))
    return PageTable("counts", ("kind", "rows", ("share", "95 % interval"), *(g.name for g in groups)), lines)


class QuantityTable(NamedTuple):
    """Quantiles of a quantity: its label and unit, its name with how it is formed, and the table."""

    label: str
    name: str
    combined: str
    table: PageTable


def measured(rows: StudyRows) -> Iterator[QuantityTable]:
    """Quantiles of each quantity by group, with the interval of the median."""
    for quantity in rows.quantities:
        values = rows.values[quantity.name]
        look = shown_quantity(quantity, values)
        lines = [(g.name, *_quantiles(values[g.places], look, quantity.low_is_bad)) for g in tabled_groups(rows)]
        worst = "lowest" if quantity.low_is_bad else "highest"
        titles = ("", "rows", ("median", "95 % interval"), "5th percentile", "95th percentile", worst)
        label = f"{look.words} [{look.unit}]" if look.unit else look.words
        yield QuantityTable(label, quantity.name, quantity.combined, PageTable("counts", titles, lines))


def _quantiles(values: Array, look: QuantityDisplay, low_is_bad: bool) -> Sequence[Cell]:
    known = finite(values) * look.scale
    if not len(known):
        return [count(0), *[DASH] * 4]
    median, (low, high) = quantile(known), np.quantile(known, [0.05, 0.95])
    worst = known.min() if low_is_bad else known.max()
    bounds = [number(v) if np.isfinite(v) else DASH for v in (median.low, median.high)]
    middle: Cell = (number(median.value), f"{bounds[0]} to {bounds[1]}")
    middle = middle[0] if bounds == [DASH, DASH] else middle  # of few rows there is no interval
    return [count(len(known)), middle, *[number(float(v)) for v in (low, high, worst)]]


def influence(rows: StudyRows) -> PageTable | None:
    """The rank correlation of each varied column with each quantity; None if nothing varies."""
    if not rows.ranked:
        return None
    titles = [split_unit(name)[0] for name in rows.ranked]
    columns = list(dict.fromkeys(name for found in rows.ranked.values() for name in found))
    lines = [
        (name, *(f"{found[name]:z.2f}".replace("-", "−") if name in found else DASH for found in rows.ranked.values()))
        for name in columns
    ]
    return PageTable("counts", ("", *titles), lines)
