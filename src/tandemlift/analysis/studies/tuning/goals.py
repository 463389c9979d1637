"""The goals of a search: metrics of a flight to minimize, each over its target or over its present value."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.tuning.parameters import toml_value
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.keys import is_number
from tandemlift.core.types import Array

INVERTED_METRICS = {"clearance_min_m"}  # metrics of which more is better: their inverse is minimized
SCALE_FLOOR = 1e-2  # of the largest component of a metric: the scale of smaller present values
CAP = 1e6  # largest ratio, of a metric that must be large and is not
Metrics = Mapping[str, Any]


class Goal(NamedTuple):
    """A metric to minimize, or one component of it.

    Attributes:
        name: as specified, such as `position_rmse_m` or `position_rmse_m.0`.
        target: the value that counts as one, a number or one for each component; None for the present value.
        targets: those of some cases, by name of the case.
    """

    name: str
    target: float | Sequence[float] | None = None
    targets: Mapping[str, Any] = {}

    @property
    def metric(self) -> str:
        """The name in metrics.json."""
        above, _, last = self.name.rpartition(".")
        return above if last.isdigit() else self.name

    @property
    def place(self) -> int | None:
        """The component of a metric that is a list; None for all of them."""
        last = self.name.rpartition(".")[2]
        return int(last) if last.isdigit() else None

    def with_targets(self, cases: Mapping[str, Mapping[str, Any]]) -> Goal:
        """This goal with the targets that cases have for it, by name of the case."""
        targets = {case: given[self.name] for case, given in cases.items() if self.name in given}
        return self._replace(targets={**targets, **self.targets})

    def measured(self, metrics: Metrics) -> list[float] | None:
        """Its components in the metrics of a flight; None if there is no number."""
        value = metrics.get(self.metric)
        values: list[Any] = value if isinstance(value, list) else [value]
        if not all(is_number(v) or isinstance(v, bool) for v in values):
            return None
        return [float(v) for v in (values if self.place is None else values[self.place : self.place + 1])]

    @property
    def is_larger_better(self) -> bool:
        """Whether more of the metric is better."""
        return self.metric in INVERTED_METRICS

    def labels(self, count: int) -> list[str]:
        """The names of its `count` components, as columns of a study."""
        return [self.name] if count == 1 else [f"{self.name}.{i}" for i in range(count)]

    def ratios(self, values: Array, scales: Array) -> Array:
        """Values (draws, components) over scales of the same shape; of a metric that must be large, the inverse."""
        if self.is_larger_better:
            return np.minimum(scales / np.maximum(values, scales / CAP), CAP)
        return values / scales


def goals_from(asked: str | Goal | Mapping[str, Any] | Iterable[str | Goal]) -> tuple[Goal, ...]:
    """Goals from names, or from names with their targets.

    Raises:
        InputError: there is none, one is given twice, or a target is not a positive number.
    """
    if isinstance(asked, Mapping):
        goals = [Goal(name, target) for name, target in asked.items()]
    else:
        given: Iterable[str | Goal] = [asked] if isinstance(asked, (str, Goal)) else asked
        goals = [Goal(one) if isinstance(one, str) else one for one in given]
    if not goals:
        raise InputError("--minimize: needs a metric, such as position_rmse_m")
    for goal in goals:
        if sum(other.name == goal.name for other in goals) > 1:
            raise InputError(f"--minimize {goal.name}: is given twice")
        _check_target(goal.name, goal.target)
    return tuple(goals)


def goal_of(text: str) -> tuple[str, Any]:
    """The metric of METRIC[=TARGET], and its target or None.

    Raises:
        InputError: the target is no value of TOML.
    """
    name, equals, literal = (part.strip() for part in text.partition("="))
    return name, toml_value(f"--minimize {text}", literal) if equals else None


def _check_target(name: str, target: Any) -> None:
    values = target if isinstance(target, (list, tuple)) else [target]
    if target is not None and not (values and all(is_number(v) and 0.0 < v < math.inf for v in values)):
        raise InputError(
            f"--minimize {name}={target}: the target must be a number > 0, or a list with one for each component"
        )


def check_goals(goals: Sequence[Goal], flown: Sequence[Metrics]) -> None:
    """Check that flights have the metrics of all goals.

    Raises:
        InputError: a metric is unknown, is no number, or has fewer components.
    """
    if not flown:
        return
    numbers = {name for metrics in flown for name, v in metrics.items() if _is_numeric(v)}
    for goal in goals:
        for target in (goal.target, *goal.targets.values()):
            _check_target(goal.name, target)
        if goal.metric not in flown[0] or goal.metric in ("outcome", "findings", "events", "steps", "wall_s"):
            raise unknown("metric", goal.metric, sorted(numbers - {"steps", "wall_s"}))
        sizes = {len(v) if isinstance(v, list) else 1 for m in flown if (v := m[goal.metric]) is not None}
        if not sizes:
            raise InputError(
                f"--minimize {goal.name}: no flight has a number for it; metrics 'after 10 s' need longer flights"
            )
        if goal.place is not None and goal.place >= max(sizes):
            raise InputError(f"--minimize {goal.name}: {goal.metric} has {max(sizes)} components, from 0 on")
        for target in (goal.target, *goal.targets.values()):
            count = 1 if goal.place is not None else max(sizes)
            if isinstance(target, (list, tuple)) and len(target) != count:
                raise InputError(f"--minimize {goal.name}: the target has {len(target)} numbers, the metric {count}")


def _is_numeric(value: object) -> bool:
    values = value if isinstance(value, list) else [value]
    return bool(values) and all(is_number(v) for v in values)


def scales_of(goal: Goal, cases: Sequence[str], present: Array) -> Array:
    """The scales of a goal's values (draws, components).

    It is the target, that of the draw's case if there is one; else, for each component, the median of the present
    values over all draws that have one, and one where no draw has any.

    Args:
        goal: the goal.
        cases: the case of each draw.
        present: present values (draws, components), NaN where there is none.
    """
    known = present[np.isfinite(present).all(axis=1)]
    own = np.median(np.abs(known), axis=0) if len(known) else np.ones(present.shape[1])
    own = np.maximum(own, SCALE_FLOOR * own.max()) if own.max() > 0.0 else np.ones(present.shape[1])
    if goal.target is not None:
        own = np.broadcast_to(np.asarray(goal.target, float), own.shape)
    rows = [np.broadcast_to(np.asarray(goal.targets[c], float), own.shape) if c in goal.targets else own for c in cases]
    return np.array(rows)
