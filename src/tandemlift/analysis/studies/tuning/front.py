"""The Pareto front of several goals: candidates that cannot be improved in one goal without loss in another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tandemlift.analysis.studies.tuning.result import FrontPoint
from tandemlift.analysis.studies.tuning.search import CandidateResult
from tandemlift.analysis.studies.tuning.task import Values

MOST = 12  # points that are shown, and flown on holdout draws


def front_of(tried: Sequence[CandidateResult], chosen: Values) -> tuple[FrontPoint, ...]:
    """The candidates that no other one dominates, in the order of their first goal; at most `MOST`, evenly spread.

    The chosen one is among them, unless another one dominates it.
    """
    ranks = np.array([[cost.rank for cost in t.apart] for t in tried])
    kept: list[int] = []
    for i in sorted(range(len(tried)), key=lambda i: (*ranks[i], i)):
        if not any(np.all(ranks[j] <= ranks[i]) for j in kept):
            kept.append(i)
    places = np.unique(np.linspace(0, len(kept) - 1, min(len(kept), MOST)).round().astype(int))
    shown = [k for k in range(len(kept)) if k in places or tried[kept[k]].values == chosen]
    return tuple(FrontPoint(tried[kept[k]].values, tried[kept[k]].apart) for k in shown)
