"""The page of a tuning: one HTML file that needs nothing else: verdict, evidence, figures, values, draws, mission."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from typing import Any

from tandemlift.analysis.studies.tuning.candidates import Cost
from tandemlift.analysis.studies.tuning.parameters import Tunable
from tandemlift.analysis.studies.tuning.result import MISSION_FILE, Tuning
from tandemlift.core.errors import shown
from tandemlift.core.files import versions
from tandemlift.pictures.drawing.style import save
from tandemlift.pictures.report.page import DASH, html, html_figures, html_row, html_table, number, write_page
from tandemlift.pictures.report.study import tuning_figures
from tandemlift.pictures.report.study.tuning_figures import axis_label, shown_scale

METHODS = {"cma": "CMA-ES", "optuna": "Optuna's tree-structured Parzen estimator"}
HEADS = ("old median", "worst", "new median", "worst", "difference", "95 % from", "to")  # of the text
FEW_DRAWS = 12  # draws whose changes are listed


def write_results(found: Tuning, folder: Path) -> None:
    """Write a tuning into a folder that is there: mission, evidence, figures, and the page, without references.

    Args:
        found: from `tune` or `train`.
        folder: of the files.
    """
    drawn = tuning_figures.drawn_figures(found)
    found.save(folder)
    for name, figure in drawn.items():
        for kind in ("png", "pdf"):
            save(figure, folder / "figures" / f"{name}.{kind}")
    write_page(
        folder / "tune.html",
        "tuning",
        name=found.name,
        about=what_was_done(found),
        verdict=html(_verdict(found)),
        evidence=html(_evidence(found)),
        figures=html(html_figures(drawn, tuning_figures.CAPTIONS) if drawn else ""),
        front=html(_front(found)),
        values=html(_values(found)),
        draws=html(_draws(found)),
        file=MISSION_FILE,
        mission=found.to_toml(folder),
        versions=f"Searched with {', '.join(f'{name} {version}' for name, version in versions('compiled').items())}.",
    )


def tuning_lines(found: Tuning) -> Iterator[str]:
    """The result of a tuning in lines of text: the search, old against new on holdout draws, and the front."""
    yield f"{found.name}: {what_was_done(found)}"
    if not found.is_finished:
        old, new = (cost_words(cost, len(found.draws)) for cost in found.costs)
        yield f"  cost on the draws of the search: {old}; now {new}"
    if found.evidence is not None:
        words = "better" if found.is_better else "not better"
        yield f"  {words} on {len(found.holdout)} holdout draws: {found.evidence.words}"
        rows = [(c.label, (*c.old, *c.new, c.difference, *(c.interval or ()))) for c in found.evidence.comparisons]
        width = max((len(label) for label, _ in rows), default=0) + 2
        if rows:
            yield "  " + " " * width + "  ".join(head.rjust(10) for head in HEADS)
        for label, values in rows:
            yield f"  {label.ljust(width)}" + "  ".join(f"{value:10.4g}" for value in values)
    for place, point in enumerate(found.front, 1):
        costs = "  ".join(cost_words(cost, len(found.holdout)) for cost in point.holdout or point.costs)
        yield f"  front {place}: {costs}"


def what_was_done(found: Tuning) -> str:
    """The search in a sentence."""
    tried, task = len(found.history) - 1, found.task
    what = f"{len(task.parameters)} value{'s' * (len(task.parameters) != 1)}"
    draws = f"{len(found.draws)} draw{'s' * (len(found.draws) != 1)}"
    return f"{what} searched by {METHODS[found.optimiser]}: {tried} candidates on {draws} each; {found.ended}"


def _verdict(found: Tuning) -> str:
    if found.evidence is None:
        return '<p class="verdict missed"><strong>Unfinished</strong>: interrupted; not flown on holdout draws.</p>'
    if found.is_better:
        return f'<p class="verdict"><strong>Better</strong> on holdout draws: {escape(found.evidence.words)}.</p>'
    return (
        f'<p class="verdict missed"><strong>Not better</strong> on holdout draws: {escape(found.evidence.words)}.</p>'
    )


def cost_words(cost: Cost, draws: int) -> str:
    """A cost in words: the ratio, and bad outcomes if there are any."""
    return f"{cost.ratio:.4g}" + (f", {cost.bad} of {draws} bad" if cost.bad else "")


def _evidence(found: Tuning) -> str:
    """The table of old against new."""
    if found.evidence is None:
        return ""
    rows = []
    for c in found.evidence.comparisons:
        words, unit = axis_label(c.label)
        scale, unit = shown_scale(unit, max((abs(x) for x in (*c.old, *c.new) if not math.isnan(x)), default=0.0))
        interval = DASH if c.interval is None else f"{number(c.interval[0] * scale)} to {number(c.interval[1] * scale)}"
        cells = [DASH if math.isnan(x) else number(x * scale) for x in (*c.old, *c.new, c.difference)]
        cells += [interval, DASH if math.isnan(c.improved) else f"{100.0 * c.improved:.0f} %", unit]
        rows.append(html_row(f"{escape(words)}<br><code>{escape(c.label)}</code>", *cells))
    count = len(found.holdout)
    rows.append(_bad_row(found, count))
    of_values = ("Present<br>median", "<br>worst", "New<br>median", "<br>worst")
    heads = ("", *of_values, "Difference<br>median", "<br>95 %", "Improved", "Unit")
    note = (
        f"On {count} holdout draws, which the search never saw; both fly the same draws. Medians and worst values are "
        "of draws that went well. The difference is new minus present, draw by draw, over draws that went well with "
        "both; its interval holds for any distribution."
    )
    table = html_table(heads, rows, "compared part")
    return f'<section>\n<h2>Evidence</h2>\n<p class="soft">{note}</p>\n{table}\n</section>'


def _bad_row(found: Tuning, count: int) -> str:
    assert found.evidence is not None
    old, new = (f"{cost.bad} of {count}" for cost in found.evidence.costs)
    return (
        f'<tr><th scope="row">Bad outcomes</th><td class="one" colspan="2">{old}</td>'
        f'<td class="one" colspan="2">{new}</td><td></td><td></td><td></td><td></td></tr>'
    )


def _front(found: Tuning) -> str:
    """The table of the front."""
    if not found.front:
        return ""
    goals = [axis_label(goal.name)[0] for goal in found.task.goals]
    heads = ("", *(f"{g}<br>search" for g in goals), *(f"{g}<br>holdout" for g in goals), "")
    rows = [
        html_row(
            f"{place}{' (the mission below)' if point.values == found.new else ''}",
            *(cost_words(cost, len(found.draws)) for cost in point.costs),
            *(cost_words(cost, len(found.holdout)) for cost in point.holdout),
            "",
        )
        for place, point in enumerate(found.front, 1)
    ]
    note = "Costs of candidates that no other one beats in all goals; the present values have a cost of about one."
    table = html_table(heads, rows, "compared part")
    return f'<section>\n<h2>Front</h2>\n<p class="soft">{note}</p>\n{table}\n</section>'


def _values(found: Tuning) -> str:
    rows = [
        html_row(f"<code>{escape(p.name)}</code>", _value(old), _value(new), _span(p))
        for p, old, new in zip(found.task.parameters, found.old, found.new, strict=True)
    ]
    return html_table(("Key", "Present", "New", "Searched"), rows, "compared part")


def _value(value: object) -> str:
    return escape(shown(value)) if isinstance(value, (bool, str)) else number(value)


def _span(p: Tunable) -> str:
    if p.choices:
        return escape(", ".join(map(shown, p.choices)))
    return f"{number(p.low)} to {number(p.high)}"


def _draws(found: Tuning) -> str:
    """The keys that the draws of the search change."""
    listed = found.draws[:FEW_DRAWS]
    rows = [
        html_row(f"{i} {escape(draw.case or '')}".rstrip(), f"<code>{escape(_words(draw.changes))}</code>")
        for i, draw in enumerate(listed, 1)
    ]
    more = f"; the first {len(listed)} are listed" if len(found.draws) > len(listed) else ""
    note = (
        f"Every candidate flew the same {len(found.draws)} draws{more}. <code>evidence.json</code> lists all "
        "draws, holdout ones too, with outcomes and values."
    )
    return f'<p class="soft">{note}</p>\n{html_table((), rows, "setup")}'


def _words(changes: Mapping[str, Any]) -> str:
    return ", ".join(f"{key} = {shown(_short(value))}" for key, value in changes.items())


def _short(value: object) -> object:
    """Numbers with four digits."""
    if isinstance(value, float):
        return float(f"{value:.4g}")
    return [_short(v) for v in value] if isinstance(value, (list, tuple)) else value
