"""The choice among the best candidates, on more draws than in the search, because the best of many is biased."""

from __future__ import annotations

from collections.abc import Sequence

from tandemlift.analysis.studies.tuning.candidates import Cost
from tandemlift.analysis.studies.tuning.draws import Draw
from tandemlift.analysis.studies.tuning.optimisers import Optimiser
from tandemlift.analysis.studies.tuning.search import TuningSearch
from tandemlift.analysis.studies.tuning.task import Task, Values

FINALISTS = 8  # of each kind
TIMES = 16  # draws, for each draw of the search
EARLY, LAST = 4, 4  # a quarter of the draws first; then the best four fly the others


def choose(search: TuningSearch, optimiser: Optimiser, draws: Sequence[Draw]) -> tuple[Values, tuple[Cost, Cost]]:
    """The best of the best candidates, and the costs of the present values and of its own, on draws for the choice.

    The finalists are the candidates of the lowest cost, those that were the best at some time, which are often farther
    from failures, and the final centre of the search.

    Args:
        search: after the search.
        optimiser: that proposed the candidates.
        draws: used neither in the search nor for the evidence.
    """
    task, present = search.task.for_draws(draws), search.tried[0]
    ranked = sorted(search.tried[1:], key=lambda tried: tried.cost.rank)
    finalists = list(dict.fromkeys(tried.values for tried in ranked))[:FINALISTS]
    once_best = [values for _, values in search.records[-FINALISTS:]]
    finalists = list(dict.fromkeys([*finalists, *once_best, *_centre(task, optimiser)]))
    early = draws[: len(draws) // EARLY]
    judge = search.task.for_draws(early)
    costs = [judge.cost(trial) for trial in judge.fly([task.changes(values) for values in finalists], early)]
    last = [values for _, values in sorted(zip(costs, finalists, strict=True), key=lambda pair: pair[0].rank)[:LAST]]
    old, *others = (task.cost(trial) for trial in task.fly([{}, *map(task.changes, last)], draws))
    chosen, lowest = min(zip(last, others, strict=True), key=lambda pair: pair[1].rank)
    return (chosen, (old, lowest)) if lowest.rank < old.rank else (present.values, (old, old))


def _centre(task: Task, optimiser: Optimiser) -> list[Values]:
    point = optimiser.centre
    if point is None:
        return []
    return [tuple(p.as_flown(x) for p, x in zip(task.parameters, point, strict=True))]
