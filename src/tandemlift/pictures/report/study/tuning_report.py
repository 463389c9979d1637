"""The page of a tuning: one HTML file that needs nothing else: verdict, evidence, figures, values, draws, mission."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from tandemlift.analysis.studies.tuning.candidates import Cost
from tandemlift.analysis.studies.tuning.result import MISSION_FILE, Tuning
from tandemlift.core.errors import shown
from tandemlift.core.files import versions
from tandemlift.pictures.drawing.style import save
from tandemlift.pictures.report.page import (
    DASH,
    Cell,
    PageTable,
    Verdict,
    code,
    number,
    shown_figures,
    split_unit,
    write_page,
)
from tandemlift.pictures.report.study import tuning_figures
from tandemlift.pictures.report.study.tuning_figures import shown_scale

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
        verdict=_verdict(found),
        evidence=_evidence(found),
        bad=[f"{cost.bad} of {len(found.holdout)}" for cost in found.evidence.costs] if found.evidence else [],
        figures=shown_figures(drawn, tuning_figures.CAPTIONS),
        values=PageTable("compared part", ("Key", "Present", "New", "Searched"), _values(found)),
        draws=PageTable("setup", (), _draws(found)),
        counts=(len(found.draws), len(found.holdout)),
        file=MISSION_FILE,
        mission=found.to_toml(folder),
        versions=f"Searched with {', '.join(f'{name} {version}' for name, version in versions('compiled').items())}.",
    )


def tuning_lines(found: Tuning) -> Iterator[str]:
    """The result of a tuning in lines of text: the search, and old against new on holdout draws."""
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


def what_was_done(found: Tuning) -> str:
    """The search in a sentence."""
    tried, task = len(found.history) - 1, found.task
    what = f"{len(task.parameters)} value{'s' * (len(task.parameters) != 1)}"
    draws = f"{len(found.draws)} draw{'s' * (len(found.draws) != 1)}"
    return f"{what} searched by CMA-ES: {tried} candidates on {draws} each; {found.ended}"


def _verdict(found: Tuning) -> Verdict:
    if found.evidence is None:
        return Verdict("Unfinished", ": interrupted; not flown on holdout draws.", "missed")
    head, look = ("Better", "") if found.is_better else ("Not better", "missed")
    return Verdict(head, f" on holdout draws: {found.evidence.words}.", look)


def cost_words(cost: Cost, draws: int) -> str:
    """A cost in words: the ratio, and bad outcomes if there are any."""
    return f"{cost.ratio:.4g}" + (f", {cost.bad} of {draws} bad" if cost.bad else "")


def _evidence(found: Tuning) -> list[tuple[str, str, list[str]]]:
    """Old against new: label, name and cells of each component."""
    rows = []
    for c in found.evidence.comparisons if found.evidence else ():
        words, unit = split_unit(c.label)
        scale, unit = shown_scale(unit, max((abs(x) for x in (*c.old, *c.new) if not math.isnan(x)), default=0.0))
        interval = DASH if c.interval is None else f"{number(c.interval[0] * scale)} to {number(c.interval[1] * scale)}"
        cells = [DASH if math.isnan(x) else number(x * scale) for x in (*c.old, *c.new, c.difference)]
        cells += [interval, DASH if math.isnan(c.improved) else f"{100.0 * c.improved:.0f} %", unit]
        rows.append((words, c.label, cells))
    return rows


def _values(found: Tuning) -> Iterator[Sequence[Cell]]:
    for p, old, new in zip(found.task.parameters, found.old, found.new, strict=True):
        yield code(p.name), number(old), number(new), f"{number(p.low)} to {number(p.high)}"


def _draws(found: Tuning) -> list[Sequence[Cell]]:
    """The keys that the first draws of the search change."""
    listed = enumerate(found.draws[:FEW_DRAWS], 1)
    return [(f"{i} {draw.case or ''}".rstrip(), code(_words(draw.changes))) for i, draw in listed]


def _words(changes: Mapping[str, Any]) -> str:
    return ", ".join(f"{key} = {shown(_short(value))}" for key, value in changes.items())


def _short(value: object) -> object:
    """Numbers with four digits."""
    if isinstance(value, float):
        return float(f"{value:.4g}")
    return [_short(v) for v in value] if isinstance(value, (list, tuple)) else value
