"""Sensitivity of a quantity: Sobol' indices from rows sampled for them, else estimates from other rows.

A first-order index is the share of a quantity's variance that an input explains alone, a total index the share in which
it participates; a second-order index is the share that two explain together beyond each alone. Rows of
`sampling = "saltelli"` give all of them (Saltelli et al. 2010, 10.1016/j.cpc.2009.09.018). Any other independent draws
give first-order indices (RBD-FAST: Tarantola et al. 2006, 10.1016/j.ress.2005.06.003). SALib estimates both, with
intervals by resampling. Spearman's rank correlation says in which direction an input acts.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.studies.design.statistics import CONFIDENCE, IntervalEstimate
from tandemlift.analysis.studies.study_rows import RowGroup, StudyRows
from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array

FEWEST = 100  # rows of a first-order estimate from other rows: ten for each of its ten harmonics
MOST = 40_000  # rows that estimates from other rows use, drawn at random from more
RESAMPLES = (40, 200)  # least and most
MOST_RESAMPLED = 2_500_000  # rows, or base points, times resamples: memory and time
SALTELLI = "Sobol' indices of a Saltelli design"
RBD_FAST = "first-order indices by RBD-FAST"


class Sensitivity(NamedTuple):
    """The sensitivity of a quantity.

    Attributes:
        method: of the estimate of the indices.
        rows: number of rows used.
        left_out: number of rows without a value.
        first: first-order index of each input.
        total: total index of each input; empty if the rows do not give them.
        second: second-order index of each pair of inputs; empty if the rows do not give them.
        ranks: Spearman's rank correlation of each input with the quantity.
    """

    method: str
    rows: int
    left_out: int
    first: dict[str, IntervalEstimate]
    total: dict[str, IntervalEstimate]
    second: dict[tuple[str, str], IntervalEstimate]
    ranks: dict[str, float]

    @property
    def strongest(self) -> list[str]:
        """The inputs, the most influential first."""
        found = self.total or self.first
        return sorted(found, key=lambda name: -found[name].value)


def analyse(inputs: Mapping[str, Array], values: Array, sampling: str = "random", seed: int = 1) -> Sensitivity:
    """Estimate the sensitivity of a quantity to its inputs.

    Args:
        inputs: drawn numbers (n,) by name: independent of each other, in the order of the draws.
        values: the quantity (n,) in the same order; NaN where a row has none.
        sampling: of the inputs, as in `study.sampling`.
        seed: of the resampling; above 0.

    Raises:
        InputError: there are too few rows, the quantity does not vary, a row of a Saltelli design has no value, or
            SALib is not installed (extra: study).
    """
    known = np.isfinite(values)
    if not inputs:
        raise InputError("sensitivity: no number is drawn at random")
    if known.sum() < 2 or np.ptp(values[known]) <= 1e-12 * np.abs(values[known]).max():
        raise InputError("sensitivity: the quantity is the same in all rows that have it")
    rows = np.random.default_rng(seed).permutation(np.flatnonzero(known))[:MOST]
    found = _saltelli(inputs, values, seed) if sampling == "saltelli" else _as_they_are(inputs, values, rows, seed)
    ranks = {name: _rank_correlation(x[rows], values[rows]) for name, x in inputs.items()}
    return found._replace(ranks=ranks, left_out=int((~known).sum()))


def _problem(names: Mapping[str, Any]) -> dict[str, Any]:
    """The inputs as SALib describes them; its estimates use their number alone."""
    return {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}


def _saltelli(inputs: Mapping[str, Array], values: Array, seed: int) -> Sensitivity:
    """Sobol' indices of all orders up to two, and total ones."""
    holes, step = int((~np.isfinite(values)).sum()), 2 * len(inputs) + 2
    if holes or len(values) % step:
        missing = f"{holes} of {len(values)} rows have no value" if holes else f"there are {len(values)} rows"
        raise InputError(
            f"sensitivity: {missing}, and a Saltelli design must be whole: all of the {step} rows of each base point; "
            "take a quantity that every row has, such as the share of bad outcomes"
        )
    with extra("study", "sensitivity"):
        from SALib.analyze import sobol
    base = len(values) // step
    options = {"calc_second_order": True, "num_resamples": _resamples(base), "conf_level": CONFIDENCE, "seed": seed}
    with _quiet():
        found = sobol.analyze(_problem(inputs), np.asarray(values, np.float64), **options)

    def one(kind: str, *at: int) -> IntervalEstimate:
        value, half = float(found[kind][at]), float(found[f"{kind}_conf"][at])
        return IntervalEstimate(value, value - half, value + half)

    names = list(inputs)
    return Sensitivity(
        method=SALTELLI,
        rows=len(values),
        left_out=0,
        first={name: one("S1", i) for i, name in enumerate(names)},
        total={name: one("ST", i) for i, name in enumerate(names)},
        second={(names[i], names[j]): one("S2", i, j) for i, j in combinations(range(len(names)), 2)},
        ranks={},
    )


def _as_they_are(inputs: Mapping[str, Array], values: Array, rows: NDArray[np.intp], seed: int) -> Sensitivity:
    """First-order indices from some rows of any independent draws, in no order: else equal inputs would keep one."""
    if len(rows) < FEWEST:
        raise InputError(f"sensitivity: {len(rows)} rows have a value; needs at least {FEWEST}")
    with extra("study", "sensitivity"):
        from SALib.analyze import rbd_fast
    points = np.column_stack([x[rows] for x in inputs.values()])
    options = {"num_resamples": _resamples(len(rows)), "conf_level": CONFIDENCE, "seed": seed}
    with _quiet():
        found = rbd_fast.analyze(_problem(inputs), points, values[rows], **options)
    if not np.isfinite([found["S1"], found["S1_conf"]]).all():
        raise InputError("sensitivity: the quantity differs in too few rows for intervals by resampling")
    pairs = zip(inputs, found["S1"], found["S1_conf"], strict=True)
    first = {name: IntervalEstimate(float(v), float(v - half), float(v + half)) for name, v, half in pairs}
    return Sensitivity(RBD_FAST, len(rows), 0, first, total={}, second={}, ranks={})


def _resamples(rows: int) -> int:
    """The number of resamples for that many rows."""
    return int(np.clip(MOST_RESAMPLED // rows, *RESAMPLES))


@contextmanager
def _quiet() -> Iterator[None]:
    """Leave out SALib's warnings of resamples in which the quantity does not vary."""
    with np.errstate(invalid="ignore", divide="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        yield


def _rank_correlation(x: Array, y: Array) -> float:
    """Spearman's correlation of two columns; NaN where one of them does not vary."""
    with extra("study", "sensitivity"):
        from scipy.stats import rankdata
    a, b = (rankdata(v) - (len(v) + 1) / 2.0 for v in (x, y))
    scale = math.sqrt(float(a @ a) * float(b @ b))
    return float(a @ b) / scale if scale else math.nan


def influence(rows: StudyRows, group: RowGroup, values: Array) -> Sensitivity:
    """The sensitivity of a quantity in the rows of a group.

    Of a Saltelli design, the mean over grid points and seeds of each draw is analysed. Otherwise each row is, with the
    columns of the grid as further inputs, because draws are the same at all of its points.

    Args:
        rows: of a study.
        group: of them.
        values: the quantity (rows,) of all rows; NaN where there is none.

    Raises:
        InputError: the rows do not allow an estimate; with the reason.
    """
    draw, found = rows.draw[group.places], values[group.places]
    drawn = rows.drawn
    if rows.study.settings.study.sampling == "saltelli":
        return analyse(drawn, _means(draw, found, rows.study.plan.point_count), "saltelli")
    grid = {name: rows.varied[name][group.places] for name in rows.study.grid if name in rows.varied}
    inputs = {**grid, **{name: points[draw] for name, points in drawn.items()}}
    if not inputs:
        raise InputError("sensitivity: nothing varies on a grid or at random")
    return analyse(inputs, found, rows.study.settings.study.sampling)


def _means(draw: Array, values: Array, count: int) -> Array:
    """The mean of each draw (count,); NaN where a row of it has no value, or is missing."""
    number = np.bincount(draw, minlength=count)
    sums = np.bincount(draw, weights=values, minlength=count)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(number == number.max(initial=1), sums / number, np.nan))
