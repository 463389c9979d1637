"""A search in progress: proposes candidates, flies them, and reports their costs, until the budget is spent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.studies.tuning.candidates import Cost, Trial
from tandemlift.analysis.studies.tuning.draws import Draw
from tandemlift.analysis.studies.tuning.optimisers import Optimiser
from tandemlift.analysis.studies.tuning.task import Task, Values

TuneProgress = Callable[[int, int, Cost], None]
"""Called with (candidates tried, candidates in all, the lowest cost so far)."""
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
