"""A search: candidates are proposed, flown and compared until the budget is spent; the best of them, and the front."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from tandemlift.analysis.studies.tuning.candidates import Cost, Trial
from tandemlift.analysis.studies.tuning.draws import Draw
from tandemlift.analysis.studies.tuning.optimisers import EvolutionStrategy
from tandemlift.analysis.studies.tuning.optuna_optimiser import ParzenEstimator
from tandemlift.analysis.studies.tuning.result import FrontPoint
from tandemlift.analysis.studies.tuning.task import Task, Values

TuneProgress = Callable[[int, int, Cost], None]
"""Called with (candidates tried, candidates in all, the lowest cost so far)."""
Optimiser: TypeAlias = EvolutionStrategy | ParzenEstimator
"""Proposes values of parameters, and learns from their costs."""
SPENT, INTERRUPTED = "budget spent", "interrupted"


class CandidateResult(NamedTuple):
    """A candidate that has flown: its values, its cost, and its cost for each goal alone."""

    values: Values
    cost: Cost
    apart: tuple[Cost, ...]


class TuningSearch:
    """All candidates, the present values first, and the best of them.

    Args:
        task: the task of the search.
        draws: on which they fly.
        budget: most candidates to try.
        present: the present values, and their results.
        progress: called after each population.
    """

    def __init__(
        self,
        task: Task,
        draws: Sequence[Draw],
        budget: int,
        present: tuple[Values, Trial],
        progress: TuneProgress | None = None,
    ) -> None:
        self.task, self.draws, self.budget, self.progress = task, draws, budget, progress
        self.tried = [self._judged(*present)]
        self.best = self.tried[0]
        self.ended = ""

    def _judged(self, values: Values, trial: Trial) -> CandidateResult:
        return CandidateResult(values, self.task.cost(trial), tuple(self.task.costs_apart(trial)))

    @property
    def records(self) -> tuple[tuple[int, Values], ...]:
        """The candidates that were better than all before them, with their numbers in the order of the search."""
        found, lowest = [], self.tried[0].cost.rank
        for number, tried in enumerate(self.tried[1:], 1):
            if tried.cost.rank < lowest:
                lowest = tried.cost.rank
                found.append((number, tried.values))
        return tuple(found)

    def run(self, optimiser: Optimiser, *, is_front: bool) -> None:
        """Search until the budget is spent, the search converges, or Ctrl-C, which keeps the results so far.

        Args:
            optimiser: proposes the candidates.
            is_front: whether it receives a cost for each goal, and not one for all together.
        """
        try:
            while not self.ended:
                if len(self.tried) - 1 + optimiser.size > self.budget:
                    self.ended = SPENT
                else:
                    self._try_population(optimiser, is_front)
                    self.ended = optimiser.ended
        except KeyboardInterrupt:
            self.ended = INTERRUPTED

    def _try_population(self, optimiser: Optimiser, is_front: bool) -> None:
        task, points = self.task, optimiser.ask()
        values = [tuple(p.as_flown(x) for p, x in zip(task.parameters, point, strict=True)) for point in points]
        trials = task.fly_while_hopeful([task.changes(v) for v in values], self.draws)
        tried = [self._judged(v, trial) for v, trial in zip(values, trials, strict=True)]
        optimiser.tell(points, np.array([[c.rank for c in (t.apart if is_front else (t.cost,))] for t in tried]))
        self.tried += tried
        self.best = min([self.best, *tried], key=lambda t: t.cost.rank)
        if self.progress:
            self.progress(len(self.tried) - 1, self.budget, self.best.cost)


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
