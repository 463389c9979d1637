"""Search by Optuna: for choices among words, and for the front of several goals."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

from tandemlift.analysis.studies.tuning.optimisers import BLOCK, Point
from tandemlift.analysis.studies.tuning.parameters import Tunable
from tandemlift.core.errors import extra
from tandemlift.core.types import Array


class ParzenEstimator:
    """Tree-structured Parzen estimator: samples where good candidates were denser than bad ones.

    Source: Bergstra et al., Algorithms for Hyper-Parameter Optimization, 2011; for several goals, Ozaki et al., 2022;
    by the package `optuna`.

    Args:
        parameters: numbers and choices.
        seed: of its random numbers.
        goals: number of costs of a candidate.

    Raises:
        InputError: the package is missing.
    """

    size = 2 * BLOCK
    ended = ""
    centre = None

    def __init__(self, parameters: Sequence[Tunable], seed: int, goals: int = 1) -> None:
        with extra("tune", "a search by Optuna"):
            import optuna
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        self.parameters = tuple(parameters)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # hide warnings that parts of Optuna are experimental
            sampler = optuna.samplers.TPESampler(seed=seed, multivariate=True, constant_liar=True)
            self._study = optuna.create_study(directions=["minimize"] * goals, sampler=sampler)
        self._spaces = {p.name: _space(optuna, p) for p in parameters}
        self._asked: list[Any] = []
        self._study.enqueue_trial({p.name: p.present for p in parameters})

    def ask(self) -> list[Point]:
        """The next candidates; the first one has the present values."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._asked = [self._study.ask(self._spaces) for _ in range(self.size)]
        return [tuple(trial.params[p.name] for p in self.parameters) for trial in self._asked]

    def tell(self, points: Sequence[Point], costs: Array) -> None:
        """Learn from the costs (candidates, goals) of the last candidates."""
        for trial, cost in zip(self._asked, costs, strict=True):
            self._study.tell(trial, [float(c) for c in cost])


def _space(optuna: Any, p: Tunable) -> Any:
    spaces = optuna.distributions
    if p.choices:
        return spaces.CategoricalDistribution(p.choices)
    if p.is_whole:
        return spaces.IntDistribution(int(p.low), int(p.high), log=False)
    return spaces.FloatDistribution(p.low, p.high, log=p.is_log)
