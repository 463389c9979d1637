"""Candidates flown on draws, and their costs: bad outcomes first, then the goals."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.tuning.draws import Draw, MissionSource
from tandemlift.analysis.studies.tuning.goals import Goal
from tandemlift.core.errors import InputError
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Array
from tandemlift.missions import Mission
from tandemlift.simulation.fly import fly_many

NO_NUMBER, FOUND = "no number", "findings"
ASIDE = 0.1  # weight of the worst beside the mean, so that no draw comes near to failing; of the mean beside the worst
Aim = Literal["mean", "worst"]
Changes = dict[str, Any]


class Trial(NamedTuple):
    """The results of a candidate on some draws.

    Attributes:
        outcomes: of each draw; also "refused", "no number" where a goal has none, or "findings" where these are bad.
        reasons: of a draw's refusal, "" for others.
        flown: fraction of the mission that was flown, (draws,).
        metrics: of each draw; none for a refused one.
        values: for each goal (draws, components), NaN where the outcome is bad.
    """

    outcomes: tuple[str, ...]
    reasons: tuple[str, ...]
    flown: Array
    metrics: tuple[Mapping[str, Any], ...]
    values: tuple[Array, ...] = ()

    @property
    def bad(self) -> NDArray[np.bool_]:
        """Mask (draws,) of bad outcomes."""
        return np.array([outcome in FAILURES or outcome in (REFUSED, NO_NUMBER, FOUND) for outcome in self.outcomes])

    def strictly(self) -> Trial:
        """This trial, but a flight with findings is bad."""
        pairs = zip(self.outcomes, self.metrics, self.bad, strict=True)
        return self._replace(outcomes=tuple(FOUND if m.get("findings") and not bad else o for o, m, bad in pairs))

    def measured(self, goals: Sequence[Goal], sizes: Sequence[int]) -> Trial:
        """This trial with the values of goals, of so many components each."""
        found = [[goal.measured(m) for goal in goals] for m in self.metrics]
        outcomes = [
            NO_NUMBER if not bad and None in row else outcome
            for outcome, row, bad in zip(self.outcomes, found, self.bad, strict=True)
        ]
        trial = self._replace(outcomes=tuple(outcomes))
        values = tuple(np.full((len(outcomes), size), np.nan) for size in sizes)
        for i, bad in enumerate(trial.bad):
            for column, value in zip(values, found[i], strict=True):
                if not bad:
                    column[i] = value
        return trial._replace(values=values)


def joined(trial: Trial, more: Trial) -> Trial:
    """A trial on some draws, and on more of them."""
    values = tuple(np.concatenate(pair) for pair in zip(trial.values, more.values, strict=True))
    return Trial(
        outcomes=trial.outcomes + more.outcomes,
        reasons=trial.reasons + more.reasons,
        flown=np.concatenate([trial.flown, more.flown]),
        metrics=trial.metrics + more.metrics,
        values=values,
    )


def repeated(trial: Trial, more: int) -> Trial:
    """A trial in which all draws fail, and more draws with the outcome of the first, flown as far as the mean."""
    values = tuple(np.full((more, column.shape[1]), np.nan) for column in trial.values)
    far = np.full(more, trial.flown.mean())
    return joined(trial, Trial(trial.outcomes[:1] * more, trial.reasons[:1] * more, far, ({},) * more, values))


class Cost(NamedTuple):
    """Number of bad outcomes, and the goals' ratio over all other draws; if all are bad, the fraction not flown."""

    bad: int
    ratio: float

    @property
    def rank(self) -> float:
        """One number that orders costs: first by bad outcomes, then by ratio, whose term stays between -1 and 1."""
        return 2 * self.bad + self.ratio / (1.0 + abs(self.ratio))


def cost_of(trial: Trial, goals: Sequence[Goal], scales: Sequence[Array], aim: Aim) -> Cost:
    """The cost of a trial.

    Args:
        trial: with its values.
        goals: that count, with their scales.
        scales: of each goal (draws, components).
        aim: the "mean" of all ratios of value to scale and a little of the worst, or the "worst" and a little of the
            mean, so that the others do not drift.
    """
    good = ~trial.bad
    if not good.any():
        return Cost(len(good), float(1.0 - trial.flown.mean()))
    ratios = [goal.ratios(v[good], s[good]) for goal, v, s in zip(goals, trial.values, scales, strict=True)]
    mean = float(np.mean([r.mean() for r in ratios]))
    worst = max(float(r.max()) for r in ratios)
    return Cost(int((~good).sum()), mean + ASIDE * worst if aim == "mean" else worst + ASIDE * mean)


def fly_candidates(
    source: MissionSource, candidates: Sequence[Changes], draws: Sequence[Draw], threads: int | None = None
) -> list[Trial]:
    """Fly every candidate on every draw, all at once, so that blocks of flights fill."""
    rows = list[Mission | InputError]()

    def missions() -> Iterator[Mission | InputError]:  # made in flight: see `fly_chunk`
        for candidate, draw in itertools.product(candidates, draws):
            rows.append(_loaded(source, draw.changes, candidate))
            yield rows[-1]

    flown = fly_many(missions(), keep="metrics", threads=threads, refusals=True)
    results, count = list(zip(rows, flown, strict=True)), len(draws)
    return [_trial(results[i * count : (i + 1) * count]) for i in range(len(candidates))]


def _loaded(source: MissionSource, *changes: Changes) -> Mission | InputError:
    """A mission, or the reason of its refusal."""
    try:
        return source.load(*changes)
    except InputError as error:
        return error


def _trial(rows: Sequence[tuple[Any, Mapping[str, Any] | InputError]]) -> Trial:
    """A trial from missions and their metrics, or from the reasons of refusals."""
    refusals = [str(found) if isinstance(found, InputError) else "" for _, found in rows]
    metrics = [{} if isinstance(found, InputError) else found for _, found in rows]
    outcomes = [found.get("outcome", REFUSED) for found in metrics]
    shares = [
        found["steps"] / mission.mission.steps if found else 0.0
        for (mission, _), found in zip(rows, metrics, strict=True)
    ]
    return Trial(tuple(outcomes), tuple(refusals), np.array(shares), tuple(metrics))
