"""The worst rows of a study: failed flights first, then the worst of each quantity, each with the reason."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.study_rows import Places, Quantity, StudyRows
from tandemlift.core.phases import FAILURES

ROW_COUNT = 10
OF_OUTCOMES = ("diverged", "crashed", "not-lifted")  # the worst first


class WorstRow(NamedTuple):
    """A row that is among the worst.

    Attributes:
        place: among the rows in memory.
        quantity: of which it has one of the worst values; None for a failed flight.
    """

    place: int
    quantity: Quantity | None


def worst_rows(rows: StudyRows, most: int = ROW_COUNT) -> list[WorstRow]:
    """The worst rows that flew.

    Failed flights come first: diverged, crashed, not lifted, the soonest stopped first. If there are many, places are
    left for the worst of each quantity among those that did not fail.
    """
    failed, others = _failed(rows), _worst_values(rows, most)
    reserved = min(len(rows.quantities), len(others), most // 3)
    first = [WorstRow(int(place), None) for place in failed[: most - reserved]]
    return first + others[: most - len(first)]


def _worst_values(rows: StudyRows, most: int) -> list[WorstRow]:
    """Rows with the worst values, of each quantity in turn."""
    ranked = [_ranked(rows, quantity, most) for quantity in rows.quantities]
    found = dict[int, WorstRow]()
    for turn in range(most):
        for quantity, places in zip(rows.quantities, ranked, strict=True):
            if turn < len(places):
                found.setdefault(int(places[turn]), WorstRow(int(places[turn]), quantity))
    return list(found.values())[:most]


def _failed(rows: StudyRows) -> Places:
    """Places of the failed flights, the worst first."""
    codes, names = rows.labels["outcome"]
    order = {name: OF_OUTCOMES.index(name) if name in OF_OUTCOMES else len(OF_OUTCOMES) for name in FAILURES}
    rank = np.array([order.get(name, -1) for name in names] or [-1])
    severity = rank[codes]
    places = np.flatnonzero(severity >= 0)
    return places[np.lexsort((rows.steps[places], severity[places]))]


def _ranked(rows: StudyRows, quantity: Quantity, most: int) -> Places:
    """Places of the worst values of a quantity, the worst first; none that is better than the median."""
    values = rows.values[quantity.name]
    places = np.flatnonzero(np.isfinite(values))
    badness = values[places] * (1.0 if quantity.low_is_bad else -1.0)
    worse = badness <= np.median(badness) if len(places) else slice(0)
    places, badness = places[worse], badness[worse]
    if len(places) > most:
        near = np.argpartition(badness, most)[:most]
        places, badness = places[near], badness[near]
    return places[np.lexsort((places, badness))]


def reasons(rows: StudyRows, worst: list[WorstRow]) -> list[dict[str, Any]]:
    """The columns of the worst rows: outcome, reason, kinds of findings, seed and varied keys."""
    columns = ["outcome", "reason", "finding_kinds", "seed", *rows.varied]
    return rows.study.rows([int(rows.number[row.place]) for row in worst], columns)
