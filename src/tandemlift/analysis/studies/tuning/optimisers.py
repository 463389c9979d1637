"""The optimiser: it proposes candidates and receives their costs, until its budget is spent."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tandemlift.analysis.studies.tuning.parameters import Tunable
from tandemlift.core.errors import extra
from tandemlift.core.types import Array

BLOCK = 8  # candidates: as many as fly in one block
FIRST_STEP, FAR_STEP = 0.35, 1.0  # of a coordinate: standard deviation of the first candidates; from a bad start
TOGETHER = 0.7  # correlation of the components of a vector in the first candidates
PARTS = 6.0  # of a narrow range, or of one that is not logarithmic, that make one unit of its coordinate
Point = tuple[Any, ...]


class EvolutionStrategy:
    """CMA-ES: samples of a normal distribution that moves, grows and rotates towards the better half of them.

    At first the positive components of one vector mostly change together, as gains are usually too high on all axes.

    Source: Hansen, The CMA Evolution Strategy: A Tutorial, arXiv 1604.00772; by the package `cma`. It uses nothing of a
    cost but the order of candidates.

    Args:
        parameters: numbers; the search begins at their present values.
        seed: of its random numbers; equal seeds give bit-identical candidates.
        step: standard deviation of its first candidates; of a positive number, about the logarithm of a factor.

    Raises:
        InputError: the package is missing.
    """

    def __init__(self, parameters: Sequence[Tunable], seed: int, step: float = FIRST_STEP) -> None:
        with extra("tune", "CMA-ES"):
            from cma.boundary_handler import BoundTransform
        usual = 4 + int(3.0 * math.log(len(parameters)))
        self.size = BLOCK * max(1, -(-usual // BLOCK))
        self._coordinates = [_Coordinate(p) for p in parameters]
        ends = [[0.0] * len(parameters), [c.of(c.parameter.high) for c in self._coordinates]]
        self._bounds = BoundTransform(ends)
        self._start = np.array(self._bounds.inverse([c.of(c.parameter.present) for c in self._coordinates]))
        self._together = _together([p.key if p.is_log else p.name for p in parameters])
        self._strategy = _strategy(len(parameters), self.size, seed, step)
        self._asked: list[Array] = []

    @property
    def ended(self) -> str:
        """The reason why it proposes no more candidates; "" while it does."""
        reasons = self._strategy.stop()
        return f"converged ({', '.join(sorted(reasons))})" if reasons else ""

    @property
    def centre(self) -> Point:
        """The mean of the normal distribution."""
        return self._values(self._strategy.result.xfavorite)

    def ask(self) -> list[Point]:
        """The next candidates: a value for each parameter, within its bounds."""
        self._asked = self._strategy.ask()
        return [self._values(point) for point in self._asked]

    def _values(self, point: Array) -> Point:
        inside = self._bounds.transform(self._start + self._together @ point)
        return tuple(c.value(float(x)) for c, x in zip(self._coordinates, inside, strict=True))

    def tell(self, points: Sequence[Point], costs: Sequence[float]) -> None:
        """Learn from the costs of the last candidates."""
        self._strategy.tell(self._asked, [float(cost) for cost in costs])


def _together(keys: Sequence[str]) -> Array:
    """Root (d, d) of the covariance of the first candidates: components of one key are correlated by `TOGETHER`."""
    same = np.array([[a == b for b in keys] for a in keys])
    root = np.linalg.cholesky(np.where(same, TOGETHER, 0.0) + (1.0 - TOGETHER) * np.eye(len(keys)))
    return np.asarray(root, np.float64)


class _Coordinate:
    """A parameter as a coordinate in which a step of one is about as large for all of them."""

    def __init__(self, p: Tunable) -> None:
        self.parameter = p
        width = math.log(p.high / p.low) if p.is_log else p.high - p.low
        self.unit = min(1.0, width / PARTS) if p.is_log else width / PARTS

    def of(self, value: float) -> float:
        """The coordinate of a value."""
        p = self.parameter
        return math.log(value / p.low) / self.unit if p.is_log else (value - p.low) / self.unit

    def value(self, coordinate: float) -> float:
        """The value at a coordinate, within its bounds."""
        p = self.parameter
        value = p.low * math.exp(coordinate * self.unit) if p.is_log else p.low + coordinate * self.unit
        return min(max(value, p.low), p.high)


def _strategy(dimensions: int, size: int, seed: int, step: float) -> Any:
    """The strategy of the package `cma` from zero, silent, without files, with random numbers of its own."""
    import cma

    rng = np.random.default_rng(seed)
    options = {
        "popsize": size,
        "randn": lambda *shape: rng.standard_normal(shape),
        "seed": math.nan,  # NumPy's own random numbers are left alone
        "verbose": -10,
        "verb_log": 0,
        "verb_disp": 0,
    }
    return cma.CMAEvolutionStrategy([0.0] * dimensions, step, options)
