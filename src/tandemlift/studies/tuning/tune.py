"""Tuning of a mission: the search, and the evidence on fresh draws."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from tandemlift.common.errors import InputError, unknown
from tandemlift.studies.tuning.candidates import Aim, Cost, Source
from tandemlift.studies.tuning.draws import FRESH, SEARCH, Draw, default_draws
from tandemlift.studies.tuning.evidence import evidence_of
from tandemlift.studies.tuning.front import front_of
from tandemlift.studies.tuning.goals import Goal, goals_from
from tandemlift.studies.tuning.parameters import Parameter, Range, parameters_of
from tandemlift.studies.tuning.result import Tuning, present_values
from tandemlift.studies.tuning.searches import EvolutionSearch, Search
from tandemlift.studies.tuning.task import Task, Values, started

OPTIMISERS = ("cma", "optuna")
FACTORS = {"cma": 1000.0, "optuna": 10.0}  # by which a number may differ: a search that moves can go far
POPULATIONS = 60  # of the default budget
Optimiser = Literal["cma", "optuna"]
TuneProgress = Callable[[int, int, Cost], None]
"""Called with (candidates tried, candidates in all, the lowest cost so far)."""


def tune(
    mission: str | os.PathLike[str],
    goals: str | Goal | Mapping[str, Any] | Iterable[str | Goal],
    *,
    over: Iterable[str] | Mapping[str, Range] = (),
    draws: int | Sequence[Draw] = 8,
    fresh: int | Sequence[Draw] = 200,
    budget: int | None = None,
    optimiser: Optimiser | None = None,
    aim: Aim = "mean",
    seed: int = 0,
    threads: int | None = None,
    changes: Mapping[str, Any] | None = None,
    controller: str | None = None,
    progress: TuneProgress | None = None,
) -> Tuning:
    """Search values of a mission that make metrics small, and fly them on fresh draws against the present ones.

    A bad outcome counts first: of two candidates, the one with fewer draws that fail, are refused or have no number for
    a goal is better, whatever the goals say. Then the goals count, each over its target or its present value. Ctrl-C
    ends the search and keeps the best so far.

    Args:
        mission: name of a built-in mission, or path of a TOML file.
        goals: metrics to make small, by their names in metrics.json, of lists also one component, such as
            "position_rmse_m.2"; or a table of such names with their targets.
        over: dotted keys, tables or patterns of what to search, with a range [low, high] or a list of words for each if
            it is a table; by default the gains of the controller.
        draws: flights on which candidates are compared, or how many of `default_draws`.
        fresh: flights on which old and new are compared in the end, or how many.
        budget: most candidates to try; by default 60 populations; with 0 only the present values fly.
        optimiser: "cma", or "optuna" for choices and for the front of several goals; by default what suits.
        aim: whether the mean over draws counts, or the worst.
        seed: of search and draws.
        threads: that fly; by default one for each processor.
        changes: changes of the mission by dotted key, before the search.
        controller: name of another controller than the mission's.
        progress: called after each population.

    Returns:
        What was found, whether it is better or not.

    Raises:
        InputError: bad input, a package is missing, or no draw can be flown.
    """
    source = Source(os.fspath(mission), dict(changes or {}), controller)
    loaded, asked = source.load(), goals_from(goals)
    ranges = over if isinstance(over, Mapping) else dict.fromkeys([over] if isinstance(over, str) else over)
    kind, parameters = _optimiser(optimiser, asked), ()
    parameters = parameters_of(loaded, ranges, FACTORS[kind])
    if optimiser is None and any(p.choices for p in parameters):
        kind = "optuna"
        parameters = parameters_of(loaded, ranges, FACTORS[kind])
    if aim not in ("mean", "worst"):
        raise InputError(f"--aim {aim}: must be mean or worst")
    compared = default_draws(loaded, _count("--draws", draws), seed, SEARCH) if isinstance(draws, int) else list(draws)
    unseen = default_draws(loaded, _count("--fresh", fresh), seed, FRESH) if isinstance(fresh, int) else list(fresh)
    _check_draws(compared, unseen, parameters)
    search = _search(kind, parameters, seed, len(asked))
    allowed = POPULATIONS * search.size if budget is None else budget
    if 0 != allowed < search.size:
        raise InputError(f"--budget {allowed}: must be at least {search.size}, which are tried at a time, or 0")
    blank = Task(source, loaded, parameters, asked, (), (), aim, threads)
    task, present = started(blank, compared)
    hunt = _Hunt(task, compared, allowed, progress)
    hunt.run(search, task.cost(present))
    found = Tuning(
        task=task,
        optimiser=kind,
        seed=seed,
        budget=allowed,
        draws=tuple(compared),
        fresh=tuple(unseen),
        old=present_values(task),
        new=hunt.best or present_values(task),
        costs=(hunt.history[0], hunt.lowest),
        history=tuple(hunt.history),
        ended=hunt.ended,
        is_finished=hunt.ended != INTERRUPTED,
        front=front_of(hunt.tried) if len(asked) > 1 and kind == "optuna" else (),
    )
    return with_evidence(found) if found.is_finished else found


INTERRUPTED = "interrupted"


class _Hunt:
    """A search in progress: all that was tried, and the best of it."""

    def __init__(self, task: Task, draws: Sequence[Draw], budget: int, progress: TuneProgress | None) -> None:
        self.task, self.draws, self.budget, self.progress = task, draws, budget, progress
        self.tried: list[tuple[Values, tuple[Cost, ...]]] = []
        self.history: list[Cost] = []
        self.best: Values | None = None
        self.lowest = Cost(0, 0.0)
        self.ended = ""

    def run(self, search: Search, present: Cost) -> None:
        """Try candidates until the budget is spent, the search converges, or Ctrl-C."""
        self.history, self.lowest = [present], present
        try:
            while not self.ended:
                if len(self.history) - 1 + search.size > self.budget:
                    self.ended = "budget spent"
                elif search.ended:
                    self.ended = search.ended
                else:
                    self._population(search)
        except KeyboardInterrupt:
            self.ended = INTERRUPTED

    def _population(self, search: Search) -> None:
        task, points = self.task, search.ask()
        values = [
            tuple(p.as_flown(x) for p, x in zip(task.parameters, point, strict=True)) for point in points
        ]
        trials = task.fly([task.changes(v) for v in values], self.draws)
        costs = [task.cost(trial) for trial in trials]
        apart = [task.costs_apart(trial) for trial in trials]
        search.tell(points, np.array([[c.rank for c in row] for row in apart]) if self._is_front(search)
                    else np.array([[c.rank] for c in costs]))
        for v, cost, row in zip(values, costs, apart, strict=True):
            self.history.append(cost)
            self.tried.append((v, tuple(row)))
            if cost.rank < self.lowest.rank:
                self.best, self.lowest = v, cost
        if self.progress:
            self.progress(len(self.history) - 1, self.budget, self.lowest)

    def _is_front(self, search: Search) -> bool:
        return len(self.task.goals) > 1 and not isinstance(search, EvolutionSearch)


def with_evidence(found: Tuning) -> Tuning:
    """The result with what fresh draws say, of the new values and of the front."""
    task = found.task.for_draws(found.fresh)
    front = [task.changes(point.values) for point in found.front]
    old, new, *others = task.fly([{}, found.changes, *front], found.fresh)
    points = [p._replace(fresh=tuple(task.costs_apart(t))) for p, t in zip(found.front, others, strict=True)]
    return found._replace(evidence=evidence_of(old, new, task.goals, task.scales, task.aim), front=tuple(points))


def _optimiser(given: str | None, goals: Sequence[Goal]) -> str:
    if given is not None and given not in OPTIMISERS:
        raise unknown("optimiser", given, OPTIMISERS)
    return given or ("optuna" if len(goals) > 1 else "cma")


def _search(kind: str, parameters: Sequence[Parameter], seed: int, goals: int) -> Search:
    if kind == "cma":
        return EvolutionSearch(parameters, seed)
    from tandemlift.studies.tuning.optuna_search import EstimatorSearch

    return EstimatorSearch(parameters, seed, goals)


def _count(option: str, given: int) -> int:
    if not 1 <= given <= 1_000_000:
        raise InputError(f"{option} {given}: must be from 1 to 1000000")
    return given


def _check_draws(compared: Sequence[Draw], unseen: Sequence[Draw], parameters: Sequence[Parameter]) -> None:
    """Refuse draws that change what is searched, and fresh draws that the search has seen."""
    if not compared or not unseen:
        raise InputError("--draws: needs at least one draw")
    varied = {key for draw in (*compared, *unseen) for key in draw.changes}
    for p in parameters:
        for key in varied:
            if p.key == key or p.key.startswith(f"{key}.") or key.startswith(f"{p.key}."):
                raise InputError(f"--over {p.key}: the draws change {key}; a key is either searched or drawn")
    if any(draw in compared for draw in unseen):
        raise InputError("--fresh: a fresh draw is one of the draws of the search; give them another mission.seed")
