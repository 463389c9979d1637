"""Tuning of a mission, and training of its policy: the search, and the evidence on holdout draws."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from tandemlift.analysis.studies.design.keys import overlap
from tandemlift.analysis.studies.tuning.candidates import Aim
from tandemlift.analysis.studies.tuning.draws import (
    CHOICE_SEED,
    HOLDOUT_SEED,
    Draw,
    DrawSource,
    MissionSource,
    Study,
    default_study,
)
from tandemlift.analysis.studies.tuning.goals import Goal, goals_from
from tandemlift.analysis.studies.tuning.holdout import evidence_of
from tandemlift.analysis.studies.tuning.optimisers import FAR_STEP, FIRST_STEP, EvolutionStrategy
from tandemlift.analysis.studies.tuning.parameters import Range, Tunable, parameters_of
from tandemlift.analysis.studies.tuning.result import Tuning, present_values
from tandemlift.analysis.studies.tuning.search import (
    DRAW_FACTOR,
    INTERRUPTED,
    CandidateResult,
    TuneProgress,
    TuningSearch,
    choose,
)
from tandemlift.analysis.studies.tuning.task import Task, started
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.progress import progress_or_own

FACTOR = 1000.0  # by which a number without a range may differ from its present value
POPULATIONS = 60  # of the default budget
MOST_DRAWS = 1_000_000
POLICY, WEIGHTS = "compliance.policy", (-4.0, 4.0)  # the range of a weight
EFFORT = ("human_work_j", "human_force_mean_n")  # the work alone can be negative: the vehicle then shakes the hand


class How(NamedTuple):
    """Options of search and comparison; see `tune`."""

    parameters: Iterable[str] | Mapping[str, Range] = ()
    draws: int | Study = 8
    holdout: int = 200
    budget: int | None = None
    aim: Aim = "mean"
    seed: int = 0
    threads: int | None = None
    strict: bool = False
    folder: str | os.PathLike[str] | None = None


def tune(
    mission: str | os.PathLike[str],
    goals: str | Goal | Mapping[str, Any] | Iterable[str | Goal],
    *,
    changes: Mapping[str, Any] | None = None,
    controller: str | None = None,
    progress: TuneProgress | None = None,
    **how: Any,
) -> Tuning:
    """Search values of a mission that minimize metrics, and compare them with the present ones on holdout draws.

    A bad outcome counts first: of two candidates, the one with fewer draws that fail, are refused or have no number for
    a goal is better, whatever the goals say. Then the goals count, each over its target or its present value. Ctrl-C
    ends the search and keeps the best so far.

    Args:
        mission: name of a built-in mission, or path of a TOML file.
        goals: metrics to minimize, by their names in metrics.json, of lists also one component, such as
            "position_rmse_m.2"; or a table of such names with their targets.
        changes: changes of the mission by dotted key, before the search.
        controller: name of another controller than the mission's.
        progress: called after each population; by default, a notebook shows a bar.
        how: any of

            parameters: dotted keys, tables or patterns of searched values, with a range [low, high] for each
            if it is a table; by default the gains of the controller.
            draws: the study whose rows compare candidates, as file or tables, or the number of draws of
            `default_study`; 8.
            holdout: number of draws on which old and new are compared in the end; 200.
            budget: most candidates to try; by default 60 populations; with 0 only the present values fly.
            aim: whether the "mean" over draws counts, or the "worst"; the mean.
            seed: of search and draws; 0.
            threads: that fly; by default one for each processor.
            strict: whether a flight with findings counts as a bad outcome.
            folder: where mission and evidence so far are written after each population, as by `Tuning.save`. The same
            search goes on there where it was stopped, with the same result.

    Returns:
        The result, whether it is better or not.

    Raises:
        InputError: bad input, a package is missing, or no draw can be flown.
    """
    if strange := set(how) - set(How._fields):
        raise unknown("argument of tune", min(strange), How._fields)
    source = MissionSource(os.fspath(mission), dict(changes or {}), controller)
    return _tuned(source, goals_from(goals), How(**how), progress)


def train(
    mission: str | os.PathLike[str],
    *,
    changes: Mapping[str, Any] | None = None,
    hidden: int = 6,
    persons: int = 24,
    progress: TuneProgress | None = None,
    **how: Any,
) -> Tuning:
    """Train a policy that saves persons work and force, and compare it with the mission as it is on other persons.

    It is a search for `compliance.policy.weights` on random persons, the same for all candidates. It begins with those
    of the mission, or with zero, which are its admittance alone.

    Args:
        mission: name of a built-in mission, or path of a TOML file, with a person.
        changes: changes of the mission by dotted key.
        hidden: number of hidden units of a new network.
        persons: number of persons in the search.
        progress: as of `tune`.
        how: holdout, budget, seed, threads, strict and folder, as of `tune`.

    Returns:
        The result, whether it is better or not.

    Raises:
        InputError: bad input, the package is missing, or the mission has no person.
    """
    if strange := set(how) - (allowed := {"holdout", "budget", "seed", "threads", "strict", "folder"}):
        raise unknown("argument of train", min(strange), sorted(allowed))
    _check_count("--persons", persons)
    source = MissionSource(os.fspath(mission), dict(changes or {}))
    policy = source.load().compliance.policy
    if policy.model == "none":
        fresh = {f"{POLICY}.model": "network", f"{POLICY}.weights": policy.zeros(hidden)}
        source = MissionSource(source.name, {**source.changes, **fresh})
    seed, weights = how.get("seed", 0), f"{POLICY}.weights"
    study = {"name": "persons", "missions": [source.name], "draws": persons, "seed": seed, "persons": "random"}
    draws = {"study": study, "set": {key: value for key, value in source.changes.items() if key != weights}}
    how |= {"parameters": {weights: WEIGHTS}, "draws": draws}
    return _tuned(source, goals_from(EFFORT), How(**how), progress)


def _tuned(source: MissionSource, goals: tuple[Goal, ...], how: How, progress: TuneProgress | None) -> Tuning:
    if how.aim not in ("mean", "worst"):
        raise unknown("aim", how.aim, ("mean", "worst"))
    _check_count("--holdout", how.holdout)
    asked = [how.parameters] if isinstance(how.parameters, str) else how.parameters
    parameters = parameters_of(source.mission, asked if isinstance(asked, Mapping) else dict.fromkeys(asked), FACTOR)
    if isinstance(how.draws, int):
        _check_count("--draws", how.draws)
    study = default_study(source, how.draws, how.seed) if isinstance(how.draws, int) else how.draws
    drawn = DrawSource(study, source.mission.mission.name, source.changes)
    compared, unseen = drawn.search_draws(), drawn.other_draws(how.holdout, HOLDOUT_SEED)
    _check_apart(compared, parameters)
    goals = tuple(goal.with_targets(drawn.targets) for goal in goals)
    task, trial = started(Task(source, parameters, goals, (), (), how.aim, how.threads, how.strict), compared)
    optimiser = EvolutionStrategy(task.parameters, how.seed, FAR_STEP if trial.bad.all() else FIRST_STEP)
    budget = POPULATIONS * optimiser.size if how.budget is None else how.budget
    if budget != 0 and budget < optimiser.size:
        raise InputError(f"--budget {budget}: must be at least {optimiser.size}, which are tried at a time, or 0")
    search = TuningSearch(task, compared, budget, (present_values(task), trial), progress)

    def so_far() -> Tuning:
        return Tuning(
            task=task,
            seed=how.seed,
            budget=budget,
            draws=tuple(compared),
            holdout=tuple(unseen),
            old=search.tried[0].values,
            new=search.best.values,
            costs=(search.tried[0].cost, search.best.cost),
            history=tuple(t.cost for t in search.tried),
            tried=tuple(t.values for t in search.tried),
            records=search.records,
            ended=search.ended or INTERRUPTED,
            is_finished=False,
        )

    if (folder := how.folder) is not None:
        search.keep = lambda: so_far().save(folder)
        search.known = [CandidateResult(*one) for one in so_far().tried_before(folder)]
    with progress_or_own("Tuning", None, "candidates") as shown:
        if shown and not progress:
            search.progress = lambda tried, most, cost: shown(tried, most)
        search.run(optimiser)
    found = so_far()._replace(is_finished=search.ended != INTERRUPTED)
    if budget and found.is_finished:
        try:
            new, costs = choose(search, optimiser, drawn.other_draws(DRAW_FACTOR * len(compared), CHOICE_SEED))
        except KeyboardInterrupt:
            return found._replace(ended=INTERRUPTED, is_finished=False)
        found = found._replace(new=new, costs=costs)
    return _with_evidence(found) if found.is_finished else found


def _with_evidence(found: Tuning) -> Tuning:
    """The result with the comparison on holdout draws; unfinished after Ctrl-C."""
    task = found.task.for_draws(found.holdout)
    try:
        old, new = task.fly([{}, found.changes], found.holdout)
    except KeyboardInterrupt:
        return found._replace(ended=INTERRUPTED, is_finished=False)
    return found._replace(evidence=evidence_of(old, new, task.goals, task.scales, task.aim))


def _check_count(option: str, count: int) -> None:
    if not 1 <= count <= MOST_DRAWS:
        raise InputError(f"{option} {count}: must be from 1 to {MOST_DRAWS}")


def _check_apart(draws: Sequence[Draw], parameters: Sequence[Tunable]) -> None:
    """Reject draws that change a searched key."""
    for key in sorted({key for draw in draws for key in draw.changes}):
        for p in parameters:
            if overlap(p.key, key):
                raise InputError(f"--parameter {p.key}: the draws change {key}; a key is either searched or drawn")
