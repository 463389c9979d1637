"""A task of tuning: parameters, goals and the cost of candidates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.tuning.candidates import (
    Aim,
    Changes,
    Cost,
    Trial,
    cost_of,
    fly_candidates,
    joined,
    repeated,
)
from tandemlift.analysis.studies.tuning.draws import Draw, MissionSource
from tandemlift.analysis.studies.tuning.goals import Goal, check_goals, scales_of
from tandemlift.analysis.studies.tuning.parameters import Tunable, Value, changes_at
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.simulation.results import SHAPES

Values = tuple[Value, ...]
TRIAL_DRAWS = 4  # draws in which a candidate must not always fail to be flown on the others


class Task(NamedTuple):
    """The task of a search.

    Attributes:
        source: of missions.
        parameters: those that are searched.
        goals: metrics to minimize.
        sizes: components of each goal.
        scales: of each goal, equal for all draws except for targets of cases.
        aim: "mean" or "worst".
        threads: that fly; None for one for each processor.
        strict: whether a flight with findings is bad.
    """

    source: MissionSource
    parameters: tuple[Tunable, ...]
    goals: tuple[Goal, ...]
    sizes: tuple[int, ...]
    scales: tuple[Array, ...]
    aim: Aim
    threads: int | None
    strict: bool = False

    def as_flown(self, point: Sequence[Any]) -> Values:
        """The values of a point that an optimiser proposes, as they are flown."""
        return tuple(p.as_flown(x) for p, x in zip(self.parameters, point, strict=True))

    def changes(self, values: Values) -> Changes:
        """The values of parameters as changes of the mission."""
        return changes_at(self.parameters, values)

    def fly(self, candidates: Sequence[Changes], draws: Sequence[Draw]) -> list[Trial]:
        """The trials of candidates on draws."""
        trials = fly_candidates(self.source, candidates, draws, self.threads)
        return [self.judged(trial).measured(self.goals, self.sizes) for trial in trials]

    def judged(self, trial: Trial) -> Trial:
        """A trial by this task's definition of a bad outcome."""
        return trial.strictly() if self.strict else trial

    def fly_while_hopeful(self, candidates: Sequence[Changes], draws: Sequence[Draw]) -> list[Trial]:
        """As `fly`; a candidate that fails in all of the first draws flies no others, and counts as failing there."""
        first = self.fly(candidates, draws[:TRIAL_DRAWS])
        hopeful = [i for i, trial in enumerate(first) if not trial.bad.all()]
        rest = dict(zip(hopeful, self.fly([candidates[i] for i in hopeful], draws[TRIAL_DRAWS:]), strict=True))
        more = len(draws) - len(draws[:TRIAL_DRAWS])
        return [joined(trial, rest[i]) if i in rest else repeated(trial, more) for i, trial in enumerate(first)]

    def cost(self, trial: Trial) -> Cost:
        """The cost of a trial, all goals together."""
        return cost_of(trial, self.goals, self.scales, self.aim)

    def for_draws(self, draws: Sequence[Draw]) -> Task:
        """This task on other draws: goals without a target of the draw's case keep their scales."""
        scales = [
            np.array([_of_case(goal, draw.case, scale) for draw in draws])
            for goal, scale in zip(self.goals, self.scales, strict=True)
        ]
        return self._replace(scales=tuple(scales))


def _of_case(goal: Goal, case: str, scales: Array) -> Array:
    own = goal.targets.get(case)
    return np.median(scales, axis=0) if own is None else np.broadcast_to(np.asarray(own, float), scales[0].shape)


def started(task: Task, draws: Sequence[Draw]) -> tuple[Task, Trial]:
    """The task with sizes and scales of its goals, from the present values flown on all draws; and their trial.

    Raises:
        InputError: no draw can be flown, or a goal is unknown or has no number.
    """
    trial = task.judged(*fly_candidates(task.source, [{}], draws, task.threads))
    if all(outcome == REFUSED for outcome in trial.outcomes):
        raise InputError(f"no draw can be flown; the first is refused: {trial.reasons[0]}")
    flown = [SHAPES | {k: v for k, v in m.items() if v is not None} for m in trial.metrics if m]
    fine = [metrics for metrics, bad in zip(trial.metrics, trial.bad, strict=True) if not bad]
    check_goals(task.goals, fine or flown)
    sizes = tuple(max(_size(goal, metrics) for metrics in flown) for goal in task.goals)
    trial = trial.measured(task.goals, sizes)
    cases = [draw.case for draw in draws]
    scales = tuple(scales_of(goal, cases, values) for goal, values in zip(task.goals, trial.values, strict=True))
    if len(task.goals) > 1 and trial.bad.all() and any(goal.target is None and not goal.targets for goal in task.goals):
        raise InputError(
            "--minimize: with the present values every draw ends badly, so several goals need targets to compare"
        )
    return task._replace(sizes=sizes, scales=scales), trial


def _size(goal: Goal, metrics: Mapping[str, Any]) -> int:
    value = metrics.get(goal.metric)
    return len(value) if isinstance(value, list) and goal.place is None else 1
