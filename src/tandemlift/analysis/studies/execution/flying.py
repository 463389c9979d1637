"""Flies a chunk: from its rows to the columns of its table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tandemlift.analysis.studies.design.plan import StudyRow
from tandemlift.analysis.studies.design.settings import REFUSED, KeepTable
from tandemlift.analysis.studies.execution.chunk import Chunk
from tandemlift.analysis.studies.execution.columns import Columns, columns_of_rows
from tandemlift.analysis.studies.execution.many import Keep, fly_each
from tandemlift.core.errors import InputError
from tandemlift.missions import Mission
from tandemlift.missions.loading import MissionTemplate


def fly_chunk(chunk: Chunk) -> Columns:
    """Fly the rows of a chunk, on one thread.

    Returns:
        The columns of its table, by name.
    """
    templates = {i: variant.template() for i, variant in chunk.variants.items()}
    results = [_Result(row, templates[row.variant]) for row in chunk.rows]
    ready = [result for result in results if result.mission is not None]
    for result, metrics in zip(ready, _flown(ready, chunk, "metrics"), strict=True):
        result.take(metrics)
    kept = [result for result in results if _is_kept(result, chunk.keep)]
    flights = dict(zip([result.row.number for result in kept], _flown(kept, chunk, "flights"), strict=True))
    return columns_of_rows(chunk, [(r.row, r.metrics, r.refusal) for r in results], flights)


class _Result:
    """A row, its mission, and its metrics or the reason of its refusal."""

    def __init__(self, row: StudyRow, template: MissionTemplate) -> None:
        self.row, self.refusal = row, ""
        self.mission: Mission | None = None
        self.metrics: dict[str, Any] | None = None
        try:
            self.mission = template.mission(row.changes)
        except InputError as error:
            self.refusal = str(error)

    def take(self, metrics: dict[str, Any] | InputError) -> None:
        if isinstance(metrics, InputError):
            self.refusal = str(metrics)
        else:
            self.metrics = metrics

    @property
    def outcome(self) -> str:
        return REFUSED if self.metrics is None else self.metrics["outcome"]


def _flown(results: Sequence[_Result], chunk: Chunk, keep: Keep) -> list[Any]:
    """The flights or metrics of rows with missions, or the reasons of their refusals; bit-identical when repeated."""
    missions = [result.mission for result in results if result.mission is not None]
    engines = [chunk.variants[result.row.variant].engine for result in results]
    return fly_each(missions, engines, keep=keep, threads=1, refusals=True)


def _is_kept(result: _Result, keep: KeepTable) -> bool:
    """Whether channels of a row go into the table."""
    if not keep.channels or result.metrics is None:
        return False
    number = result.row.number
    every = keep.every is not None and number % keep.every == 0
    return every or number in keep.rows or result.outcome in keep.outcomes
