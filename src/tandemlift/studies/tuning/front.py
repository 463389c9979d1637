"""The front of several goals: what cannot be improved in one without loss in another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tandemlift.studies.tuning.candidates import Cost
from tandemlift.studies.tuning.result import FrontPoint
from tandemlift.studies.tuning.task import Values

MOST = 12  # points that are shown, and flown on fresh draws


def front_of(tried: Sequence[tuple[Values, tuple[Cost, ...]]]) -> tuple[FrontPoint, ...]:
    """The candidates that no other one beats, in the order of their first goal; at most `MOST`, evenly spread."""
    ranks = np.array([[cost.rank for cost in costs] for _, costs in tried]).reshape(len(tried), -1)
    kept: list[int] = []
    for i in sorted(range(len(tried)), key=lambda i: tuple(ranks[i])):
        if not any(np.all(ranks[j] <= ranks[i]) for j in kept):
            kept.append(i)
    places = np.unique(np.linspace(0, len(kept) - 1, min(len(kept), MOST)).round().astype(int)) if kept else ()
    return tuple(FrontPoint(*tried[kept[k]]) for k in places)
