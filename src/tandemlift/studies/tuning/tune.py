"""Tuning of a mission: the search, and the evidence on fresh draws."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from tandemlift.common.errors import InputError, unknown
from tandemlift.settings import Mission
from tandemlift.studies.tuning.candidates import Aim, Source
from tandemlift.studies.tuning.draws import FRESH, SEARCH, Draw, default_draws
from tandemlift.studies.tuning.evidence import evidence_of
from tandemlift.studies.tuning.front import front_of
from tandemlift.studies.tuning.goals import Goal, goals_from
from tandemlift.studies.tuning.hunt import INTERRUPTED, Hunt, TuneProgress
from tandemlift.studies.tuning.parameters import Parameter, Range, parameters_of
from tandemlift.studies.tuning.result import Tuning, present_values
from tandemlift.studies.tuning.searches import EvolutionSearch, Search
from tandemlift.studies.tuning.task import Task, started

FACTORS = {"cma": 1000.0, "optuna": 10.0}  # by which a number may differ: a search that moves can go far
POPULATIONS = 60  # of the default budget
MOST_DRAWS = 1_000_000


class How(NamedTuple):
    """How to search and to compare; see `tune`."""

    over: Iterable[str] | Mapping[str, Range] = ()
    draws: int | Sequence[Draw] = 8
    fresh: int | Sequence[Draw] = 200
    budget: int | None = None
    optimiser: str | None = None
    aim: Aim = "mean"
    seed: int = 0
    threads: int | None = None


def tune(
    mission: str | os.PathLike[str],
    goals: str | Goal | Mapping[str, Any] | Iterable[str | Goal],
    *,
    changes: Mapping[str, Any] | None = None,
    controller: str | None = None,
    progress: TuneProgress | None = None,
    **how: Any,
) -> Tuning:
    """Search values of a mission that make metrics small, and fly them on fresh draws against the present ones.

    A bad outcome counts first: of two candidates, the one with fewer draws that fail, are refused or have no number for
    a goal is better, whatever the goals say. Then the goals count, each over its target or its present value. Ctrl-C
    ends the search and keeps the best so far.

    Args:
        mission: name of a built-in mission, or path of a TOML file.
        goals: metrics to make small, by their names in metrics.json, of lists also one component, such as
            "position_rmse_m.2"; or a table of such names with their targets.
        changes: changes of the mission by dotted key, before the search.
        controller: name of another controller than the mission's.
        progress: called after each population.
        how: any of

            over: dotted keys, tables or patterns of what to search, with a range [low, high] or a list of words for
            each if it is a table; by default the gains of the controller.
            draws: flights on which candidates are compared, or how many of `default_draws`; 8.
            fresh: flights on which old and new are compared in the end, or how many; 200.
            budget: most candidates to try; by default 60 populations; with 0 only the present values fly.
            optimiser: "cma", or "optuna" for choices and for the front of several goals; by default what suits.
            aim: whether the "mean" over draws counts, or the "worst"; the mean.
            seed: of search and draws; 0.
            threads: that fly; by default one for each processor.

    Returns:
        What was found, whether it is better or not.

    Raises:
        InputError: bad input, a package is missing, or no draw can be flown.
    """
    if strange := set(how) - set(How._fields):
        raise unknown("argument of tune", min(strange), How._fields)
    source = Source(os.fspath(mission), dict(changes or {}), controller)
    return _tuned(source, goals_from(goals), How(**how), progress)


def _tuned(source: Source, goals: tuple[Goal, ...], how: How, progress: TuneProgress | None) -> Tuning:
    if how.aim not in ("mean", "worst"):
        raise unknown("aim", how.aim, ("mean", "worst"))
    loaded = source.load()
    kind, parameters = _parameters(loaded, goals, how)
    compared, unseen = _draws(loaded, how, parameters)
    search = _search(kind, parameters, how.seed, len(goals))
    allowed = POPULATIONS * search.size if how.budget is None else how.budget
    if allowed != 0 and allowed < search.size:
        raise InputError(f"--budget {allowed}: must be at least {search.size}, which are tried at a time, or 0")
    task, trial = started(Task(source, loaded, parameters, goals, (), (), how.aim, how.threads), compared)
    hunt = Hunt(task, compared, allowed, (present_values(task), trial), progress)
    is_front = len(goals) > 1 and kind == "optuna"
    hunt.run(search, is_front=is_front)
    present = hunt.tried[0]
    found = Tuning(
        task=task,
        optimiser=kind,
        seed=how.seed,
        budget=allowed,
        draws=tuple(compared),
        fresh=tuple(unseen),
        old=present.values,
        new=hunt.best.values,
        costs=(present.cost, hunt.best.cost),
        history=tuple(t.cost for t in hunt.tried),
        apart=tuple(t.apart for t in hunt.tried),
        ended=hunt.ended,
        is_finished=hunt.ended != INTERRUPTED,
        front=front_of(hunt.tried) if is_front else (),
    )
    return _with_evidence(found) if found.is_finished else found


def _with_evidence(found: Tuning) -> Tuning:
    """The result with what fresh draws say of the new values and of the front; unfinished if Ctrl-C comes."""
    task = found.task.for_draws(found.fresh)
    front = [task.changes(point.values) for point in found.front]
    try:
        old, new, *others = task.fly([{}, found.changes, *front], found.fresh)
    except KeyboardInterrupt:
        return found._replace(ended=INTERRUPTED, is_finished=False)
    points = [p._replace(fresh=tuple(task.costs_apart(t))) for p, t in zip(found.front, others, strict=True)]
    return found._replace(evidence=evidence_of(old, new, task.goals, task.scales, task.aim), front=tuple(points))


def _parameters(mission: Mission, goals: Sequence[Goal], how: How) -> tuple[str, tuple[Parameter, ...]]:
    """The optimiser, and the parameters that it searches."""
    if how.optimiser is not None and how.optimiser not in FACTORS:
        raise unknown("optimiser", how.optimiser, FACTORS)
    over = [how.over] if isinstance(how.over, str) else how.over
    ranges = over if isinstance(over, Mapping) else dict.fromkeys(over)
    kind = how.optimiser or ("optuna" if len(goals) > 1 else "cma")
    found = parameters_of(mission, ranges, FACTORS[kind])
    if how.optimiser is None and any(p.choices for p in found):
        return "optuna", parameters_of(mission, ranges, FACTORS["optuna"])
    return kind, found


def _search(kind: str, parameters: Sequence[Parameter], seed: int, goals: int) -> Search:
    if kind == "cma":
        return EvolutionSearch(parameters, seed)
    from tandemlift.studies.tuning.optuna_search import EstimatorSearch

    return EstimatorSearch(parameters, seed, goals)


def _draws(mission: Mission, how: How, parameters: Sequence[Parameter]) -> tuple[list[Draw], list[Draw]]:
    """The draws of the search, and fresh ones.

    Raises:
        InputError: there are none, they change what is searched, or a fresh draw is one of the search.
    """
    given = (("draws", how.draws, SEARCH), ("fresh", how.fresh, FRESH))
    found = []
    for name, draws, stream in given:
        count = draws if isinstance(draws, int) else len(draws)
        if not 1 <= count <= MOST_DRAWS:
            raise InputError(f"--{name} {count}: must be from 1 to {MOST_DRAWS}")
        found.append(default_draws(mission, draws, how.seed, stream) if isinstance(draws, int) else list(draws))
    for key in sorted({key for draw in (*found[0], *found[1]) for key in draw.changes}):
        for p in parameters:
            if f"{p.key}.".startswith(f"{key}.") or key.startswith(f"{p.key}."):
                raise InputError(f"--over {p.key}: the draws change {key}; a key is either searched or drawn")
    if any(draw in found[0] for draw in found[1]):
        raise InputError("--fresh: a fresh draw is one of the draws of the search; give them another mission.seed")
    return found[0], found[1]
