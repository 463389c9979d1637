"""Paired comparison of old and new values on draws that the search never used."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.execution.statistics import finite, quantile
from tandemlift.analysis.studies.tuning.candidates import Aim, Cost, Trial, cost_of
from tandemlift.analysis.studies.tuning.goals import Goal
from tandemlift.core.types import Array


class Comparison(NamedTuple):
    """One component of a goal; NaN where there are no draws for a number.

    Attributes:
        label: its name.
        old: median and worst of the old values, over draws without a bad outcome.
        new: those of the new values, likewise.
        difference: median of new minus old, over draws without a bad outcome of either.
        interval: of that median, with 95 % confidence; None for fewer than six draws.
        improved: fraction of these draws in which it improved.
    """

    label: str
    old: tuple[float, float]
    new: tuple[float, float]
    difference: float
    interval: tuple[float, float] | None
    improved: float


class Evidence(NamedTuple):
    """The comparison of the new values with the old ones on holdout draws.

    Attributes:
        old: the old values flown.
        new: the new values flown.
        costs: of old and new.
        comparisons: one for each component of each goal.
        score: the interval of the median difference of the draws' scores, new minus old; None for few draws.
        better: whether the new values are better.
        words: the reason, in a sentence.
    """

    old: Trial
    new: Trial
    costs: tuple[Cost, Cost]
    comparisons: tuple[Comparison, ...]
    score: tuple[float, float] | None
    better: bool
    words: str


def median_interval(values: Array) -> tuple[float, float] | None:
    """Bounds between which the median of a population lies with 95 % confidence; None for fewer than six values."""
    found = quantile(values)
    return None if math.isnan(found.low) or math.isnan(found.high) else (found.low, found.high)


def evidence_of(old: Trial, new: Trial, goals: Sequence[Goal], scales: Sequence[Array], aim: Aim) -> Evidence:
    """Compare two trials on the same draws.

    The new values are better if fewer outcomes are bad, or, of as many, if their cost is lower; where the cost is a
    mean, the whole interval of the median difference of the draws' scores must be below zero too.
    """
    costs = (cost_of(old, goals, scales, aim), cost_of(new, goals, scales, aim))
    both = ~old.bad & ~new.bad
    comparisons = [
        _compared(label, goal, a[:, i], b[:, i])
        for goal, a, b in zip(goals, old.values, new.values, strict=True)
        for i, label in enumerate(goal.labels(a.shape[1]))
    ]
    differences = _scores(new, goals, scales, aim)[both] - _scores(old, goals, scales, aim)[both]
    score = median_interval(differences)
    better, words = _verdict(costs, score, len(both), aim)
    return Evidence(old, new, costs, tuple(comparisons), score, better, words)


def _compared(label: str, goal: Goal, old: Array, new: Array) -> Comparison:
    differences = finite(new - old)
    improved = differences > 0.0 if goal.is_larger_better else differences < 0.0
    return Comparison(
        label,
        _median_and_worst(goal, old),
        _median_and_worst(goal, new),
        float(np.median(differences)) if len(differences) else math.nan,
        median_interval(differences),
        float(improved.mean()) if len(differences) else math.nan,
    )


def _median_and_worst(goal: Goal, values: Array) -> tuple[float, float]:
    known = finite(values)
    if not len(known):
        return math.nan, math.nan
    return float(np.median(known)), float(known.min() if goal.is_larger_better else known.max())


def _scores(trial: Trial, goals: Sequence[Goal], scales: Sequence[Array], aim: Aim) -> Array:
    """One number for each draw: the mean of its ratios, or the worst of them."""
    ratios = [goal.ratios(v, s) for goal, v, s in zip(goals, trial.values, scales, strict=True)]
    if aim == "mean":
        return np.asarray(np.mean([r.mean(axis=1) for r in ratios], axis=0))
    return np.asarray(np.max([r.max(axis=1) for r in ratios], axis=0))


def _verdict(costs: tuple[Cost, Cost], score: tuple[float, float] | None, draws: int, aim: Aim) -> tuple[bool, str]:
    old, new = costs
    if new.bad != old.bad:
        better = new.bad < old.bad
        return better, f"{'fewer' if better else 'more'} bad outcomes: {new.bad} of {draws}, {old.bad} before"
    if old.bad == draws:
        return False, f"all {draws} outcomes are bad, before and after"
    change = f"the cost is {new.ratio:.4g}, {old.ratio:.4g} before"
    if new.ratio >= old.ratio:
        return False, change
    if aim == "mean" and score is not None and score[1] >= 0.0:
        chance = f"the median difference is between {score[0]:.2g} and {score[1]:.2g}"
        return False, f"{change}, which may be chance: {chance}"
    return True, change


def as_table(evidence: Evidence, draws: Sequence[Any], goals: Sequence[Goal]) -> dict[str, Any]:
    """The evidence as JSON: verdict, costs, comparisons, and each draw with its changes, outcomes and values."""
    return {
        "better": evidence.better,
        "why": evidence.words,
        "draws": len(draws),
        "old": _cost(evidence.costs[0]),
        "new": _cost(evidence.costs[1]),
        "score_difference_interval": evidence.score,
        "comparisons": [
            {
                "metric": c.label,
                "old_median": _or_null(c.old[0]),
                "old_worst": _or_null(c.old[1]),
                "new_median": _or_null(c.new[0]),
                "new_worst": _or_null(c.new[1]),
                "median_difference": _or_null(c.difference),
                "median_difference_interval": c.interval,
                "improved_fraction": _or_null(c.improved),
            }
            for c in evidence.comparisons
        ],
        "rows": [
            {
                "case": draw.case,
                "changes": draw.changes,
                "old": _row(evidence.old, i, goals),
                "new": _row(evidence.new, i, goals),
            }
            for i, draw in enumerate(draws)
        ],
    }


def _cost(cost: Cost) -> dict[str, Any]:
    return {"bad_outcomes": cost.bad, "ratio": cost.ratio}


def _or_null(value: float) -> float | None:
    return None if math.isnan(value) else value


def _row(trial: Trial, i: int, goals: Sequence[Goal]) -> dict[str, Any]:
    """The outcome and the values of a draw; null where there are none."""
    values = {
        label: _or_null(float(x))
        for goal, column in zip(goals, trial.values, strict=True)
        for label, x in zip(goal.labels(column.shape[1]), column[i], strict=True)
    }
    return {"outcome": trial.outcomes[i], "reason": trial.reasons[i], **values}
