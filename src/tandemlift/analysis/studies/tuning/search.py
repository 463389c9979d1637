"""A search: candidates are proposed, flown and compared until the budget is spent; and the best of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from tandemlift.analysis.studies.tuning.candidates import Cost, Trial
from tandemlift.analysis.studies.tuning.draws import Draw
from tandemlift.analysis.studies.tuning.optimisers import EvolutionStrategy
from tandemlift.analysis.studies.tuning.task import Task, Values

TuneProgress = Callable[[int, int, Cost], None]
"""Called with (candidates tried, candidates in all, the lowest cost so far)."""
SPENT, INTERRUPTED = "budget spent", "interrupted"


class CandidateResult(NamedTuple):
    """A candidate that has flown: its values and its cost."""

    values: Values
    cost: Cost


class TuningSearch:
    """All candidates, the present values first, and the best of them.

    Args:
        task: the task of the search.
        draws: on which they fly.
        budget: most candidates to try.
        present: the present values, and their results.
        progress: called after each population.
        keep: called after each population that has flown.

    Attributes:
        known: candidates of this search that have flown before, the present values first: they are not flown again.
    """

    def __init__(
        self,
        task: Task,
        draws: Sequence[Draw],
        budget: int,
        present: tuple[Values, Trial],
        progress: TuneProgress | None = None,
        keep: Callable[[], object] | None = None,
    ) -> None:
        self.task, self.draws, self.budget, self.progress, self.keep = task, draws, budget, progress, keep
        self.known: Sequence[CandidateResult] = ()
        values, trial = present
        self.tried = [CandidateResult(values, task.cost(trial))]
        self.best = self.tried[0]
        self.ended = ""

    @property
    def records(self) -> tuple[tuple[int, Values], ...]:
        """The candidates that were better than all before them, with their numbers in the order of the search."""
        found, lowest = [], self.tried[0].cost.rank
        for number, tried in enumerate(self.tried[1:], 1):
            if tried.cost.rank < lowest:
                lowest = tried.cost.rank
                found.append((number, tried.values))
        return tuple(found)

    def run(self, optimiser: EvolutionStrategy) -> None:
        """Search until the budget is spent, the search converges, or Ctrl-C, which keeps the results so far.

        Args:
            optimiser: proposes the candidates.
        """
        try:
            while not self.ended:
                if len(self.tried) - 1 + optimiser.size > self.budget:
                    self.ended = SPENT
                else:
                    self._try_population(optimiser)
                    self.ended = optimiser.ended
        except KeyboardInterrupt:
            self.ended = INTERRUPTED

    def _try_population(self, optimiser: EvolutionStrategy) -> None:
        task, points = self.task, optimiser.ask()
        values = [task.as_flown(point) for point in points]
        tried = list(self.known[len(self.tried) : len(self.tried) + len(values)])
        flies = [one.values for one in tried] != values
        if flies:
            trials = task.fly_while_hopeful([task.changes(v) for v in values], self.draws)
            tried = [CandidateResult(v, task.cost(trial)) for v, trial in zip(values, trials, strict=True)]
        optimiser.tell(points, [one.cost.rank for one in tried])
        self.tried += tried
        self.best = min([self.best, *tried], key=lambda t: t.cost.rank)
        if flies and self.keep:
            self.keep()
        if self.progress:
            self.progress(len(self.tried) - 1, self.budget, self.best.cost)


FINALISTS = 8  # of each kind
DRAW_FACTOR = 16  # draws, for each draw of the search
DIVISOR, FINALS = 4, 4  # a quarter of the draws first; then the best four fly the others


def choose(
    search: TuningSearch, optimiser: EvolutionStrategy, draws: Sequence[Draw]
) -> tuple[Values, tuple[Cost, Cost]]:
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
    finalists = list(dict.fromkeys([*finalists, *once_best, task.as_flown(optimiser.centre)]))
    early = draws[: len(draws) // DIVISOR]
    judge = search.task.for_draws(early)
    costs = [judge.cost(trial) for trial in judge.fly([task.changes(values) for values in finalists], early)]
    last = [values for _, values in sorted(zip(costs, finalists, strict=True), key=lambda pair: pair[0].rank)[:FINALS]]
    old, *others = (task.cost(trial) for trial in task.fly([{}, *map(task.changes, last)], draws))
    chosen, lowest = min(zip(last, others, strict=True), key=lambda pair: pair[1].rank)
    return (chosen, (old, lowest)) if lowest.rank < old.rank else (present.values, (old, old))
