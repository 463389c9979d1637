"""The tables of a study's page: flights, outcomes, findings, quantiles of metrics."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from html import escape
from typing import Any

import numpy as np

from tandemlift.analysis.studies.design.keys import changes_in
from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.design.statistics import IntervalEstimate, Share, finite, quantile, share, upper_bound
from tandemlift.analysis.studies.study_rows import StudyRows
from tandemlift.analysis.studies.table import Study
from tandemlift.core.errors import shown
from tandemlift.core.findings import KIND_OF
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Array
from tandemlift.pictures.report.page import DASH, html_row, html_table, number, with_keys
from tandemlift.pictures.report.study.outcome_tables import MOST_GROUPS, outcome_counts, tabled_groups
from tandemlift.pictures.report.study.words import QuantityDisplay, html_row_command, shown_column, shown_quantity

MOST_COLUMNS = 6  # of groups beside each other
MOST_REASONS = 5
MOST_REFUSED = 1_000  # rows of which the reasons are read
MOST_LISTED = 8  # values of a key, or changes of a case
THIN = "\u202f"


def count(value: int) -> str:
    """A whole number with its digits in groups of three."""
    return f"{value:,}".replace(",", THIN)


def percent(value: float) -> str:
    """A share in percent, to three digits."""
    text = f"{100.0 * value:.3g}"
    return f"{number(100.0 * value) if 'e' in text else text.replace('-', '−')} %"


def html_share(part: Share) -> str:
    """A share in percent over its interval."""
    if not part.total:
        return DASH
    low, high = percent(part.low).removesuffix(" %"), percent(part.high)
    return f"{percent(part.value)}<br><small>{low} to {high}</small>"


def verdict(rows: StudyRows) -> str:
    """The share of failed flights with its interval; the numbers of refused and missing rows."""
    flown = len(rows) - int(rows.refused.sum())
    failed = int(rows.bad.sum()) - int(rows.refused.sum())
    if failed:
        part = share(failed, flown)
        said = f"<strong>{count(failed)} of {count(flown)} flights failed</strong>: {percent(part.value)}, with 95 % "
        said += f"confidence between {percent(part.low)} and {percent(part.high)}."
    elif flown:
        most, high = percent(upper_bound(0, flown)), percent(share(0, flown).high)
        said = f"<strong>None of {count(flown)} flights failed</strong>: with 95 % confidence at most {most} do "
        said += f"(one-sided bound; the intervals in the tables are two-sided: 0 to {high})."
    else:
        said = "<strong>No flight</strong>."
    if refused := int(rows.refused.sum()):
        said += f" {count(refused)} rows could not be flown and were refused."
    if missing := rows.study.missing:
        said += f" {count(missing)} of {count(rows.study.plan.count)} rows are missing."
    look = "verdict missed" if failed or refused or missing else "verdict"
    return f'<p class="{look}">{said}</p>'


def what_was_flown(study: Study) -> str:
    """Missions, controllers and varied keys, as a table."""
    return html_table((), (html_row(escape(what), escape(said)) for what, said in _flown(study)), "setup")


def _flown(study: Study) -> Iterator[tuple[str, str]]:
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
        yield "Grid", f"{key}: {len(values)} values, {listed}{_unit(key)}"
    for key, distribution in plan.drawn.items():
        said = distribution.model_dump(exclude_defaults=True)
        kind = said.pop("distribution")
        yield (
            "Drawn",
            f"{key}: {kind}, {', '.join(f'{name} {shown(value)}' for name, value in said.items())}{_unit(key)}",
        )
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


def _left_out(rows: StudyRows) -> str:
    """A note of the groups that a table leaves out."""
    count = len(rows.groups)
    return f'<p class="soft">The {MOST_GROUPS} with most bad outcomes of {count}.</p>' if count > MOST_GROUPS else ""


def outcomes(rows: StudyRows) -> str:
    """The counts of each outcome by group, and the share of the bad ones with its interval."""
    lines, names = [], list[str]()
    for group, bad, numbers in outcome_counts(rows, tabled_groups(rows)):
        cells, names = [count(bad.total), html_share(bad), *map(count, numbers.values())], list(numbers)
        lines.append(html_row(escape(group), *cells))
    bad_names = ", ".join([*FAILURES, *([REFUSED] if rows.refused.any() else [])])
    titles = ("", "rows", "bad<br><small>95 % interval</small>", *map(escape, names))
    said = f'<p class="soft">Bad: {bad_names}. Intervals are those of Clopper and Pearson.</p>'
    return f"{said}\n{html_table(titles, lines, 'counts')}{_left_out(rows)}{_refusals(rows)}"


def _refusals(rows: StudyRows) -> str:
    """Why rows were refused: the most frequent reasons, numbers apart, each with a row."""
    places = np.flatnonzero(rows.refused)
    if not len(places):
        return ""
    looked_at = places[:: max(1, len(places) // MOST_REFUSED)]
    found = defaultdict[str, list[dict[str, Any]]](list)
    for row in rows.study.rows(rows.number[looked_at].tolist(), ["row", "reason"]):
        found[re.sub(r"[\d.]+", "0", row["reason"] or "")].append(row)
    items = [_refusal(rows, same, len(looked_at)) for same in sorted(found.values(), key=len, reverse=True)]
    return f"\n<h3>Refused rows</h3>\n<ul>{''.join(items[:MOST_REASONS])}</ul>"


def _refusal(rows: StudyRows, same: Sequence[dict[str, Any]], looked_at: int) -> str:
    first = same[0]
    said = f"{percent(len(same) / looked_at)} of them, such as row {first['row']}: {with_keys(first['reason'] or '')}"
    return f"<li>{said}{html_row_command(rows.study.folder, first['row'])}</li>"


def findings(rows: StudyRows) -> str:
    """The number of rows with each kind of finding, by group if these are few."""
    if not rows.finding_counts:
        return "<p>No row has a finding.</p>"
    groups = rows.groups if 1 < len(rows.groups) <= MOST_COLUMNS else []
    flown, lines = ~rows.refused, []
    for kind, has in rows.finding_counts.items():
        meaning = KIND_OF[kind].meaning if kind in KIND_OF else ""
        parts = [share(int(has[g.places].sum()), int(flown[g.places].sum())) for g in groups]
        whole = share(int(has.sum()), int(flown.sum()))
        cells = [count(int(has.sum())), html_share(whole), *map(html_share, parts)]
        lines.append(html_row(f'{escape(kind)}<br><small class="meaning">{with_keys(meaning)}</small>', *cells))
    titles = ("kind", "rows", "share<br><small>95 % interval</small>", *[escape(g.name) for g in groups])
    return html_table(titles, lines, "counts")


def measured(rows: StudyRows) -> str:
    """Quantiles of each quantity by group, with the interval of the median."""
    parts = []
    for quantity in rows.quantities:
        values = rows.values[quantity.name]
        look = shown_quantity(quantity, values)
        of_group = ((g.name, _quantiles(values[g.places], look, quantity.low_is_bad)) for g in tabled_groups(rows))
        lines = [html_row(escape(name), *quantiles) for name, quantiles in of_group]
        worst = "lowest" if quantity.low_is_bad else "highest"
        titles = ("", "rows", "median<br><small>95 % interval</small>", "5 %", "95 %", worst)
        unit = f" [{look.unit}]" if look.unit else ""
        name = f"<code>{escape(quantity.name)}</code>" + (f", {quantity.combined}" if quantity.combined else "")
        title = f'<h3>{escape(look.words)}{unit}</h3>\n<p class="soft">{name}</p>'
        parts.append(f"{title}\n{html_table(titles, lines, 'counts')}{_left_out(rows)}")
    if not parts:
        return ""
    left_out = int(rows.bad.sum())
    said = f" Without {count(left_out)} rows with a bad outcome." if left_out else ""
    return f'<section>\n<h2>Measured</h2>\n<p class="soft">Of all rows that have the number.{said}</p>\n' + (
        "\n".join(parts) + "\n</section>"
    )


def _quantiles(values: Array, look: QuantityDisplay, low_is_bad: bool) -> Sequence[str]:
    known = finite(values) * look.scale
    if not len(known):
        return [count(0), *[DASH] * 4]
    median, (low, high) = quantile(known), np.quantile(known, [0.05, 0.95])
    worst = known.min() if low_is_bad else known.max()
    return [count(len(known)), html_estimate(median), *[number(float(v)) for v in (low, high, worst)]]


def html_estimate(estimate: IntervalEstimate) -> str:
    """A number over its interval."""
    bounds = [number(v) if np.isfinite(v) else DASH for v in (estimate.low, estimate.high)]
    return f"{number(estimate.value)}<br><small>{bounds[0]} to {bounds[1]}</small>"
