"""Distributions of a drawn number, each by its inverse distribution function: from numbers in [0, 1) to values.

A number that is uniform in [0, 1) then becomes one of the distribution, and evenly spread points stay evenly spread.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from tandemlift.core.errors import extra
from tandemlift.core.keys import Positive, Table, key, must
from tandemlift.core.types import Array


class Distribution(Table):
    """The common keys of all distributions."""

    numbers: ClassVar[int] = 1  # that one value needs
    count: Annotated[int, Field(ge=1, le=100)] | None = key(
        None, "1", "draw a list of this many independent values", unset="one value"
    )
    relative: bool = key(False, None, "whether the value multiplies the mission's own")

    @property
    def dimensions(self) -> int:
        """Numbers in [0, 1) that a draw needs."""
        return self.numbers * (self.count or 1)

    @abstractmethod
    def values(self, u: Array) -> list[Any]:
        """Plain values of draws at points u (n, dimensions) in [0, 1)."""


class _OneByOne(Distribution):
    """A distribution whose values need one number each."""

    @abstractmethod
    def at(self, u: Array) -> Sequence[object] | np.ndarray:
        """Values (n,) at points u (n,)."""

    def values(self, u: Array) -> list[Any]:
        """Plain values of draws at points u (n, dimensions): numbers or strings, or lists of `count` of them."""
        parts = [_plain(self.at(column)) for column in u.T]
        return [list(row) for row in zip(*parts, strict=True)] if self.count else parts[0]


def _plain(values: Sequence[object] | np.ndarray) -> list[Any]:
    return values.tolist() if isinstance(values, np.ndarray) else list(values)


class _Between(Distribution):
    low: float = key(..., None, "lowest value")
    high: float = key(..., None, "highest value")

    @model_validator(mode="after")
    def _in_order(self) -> _Between:
        if not self.low < self.high:
            raise must("range", f"have low = {self.low:g} below high = {self.high:g}")
        return self


class Uniform(_OneByOne, _Between):
    """Every value between `low` and `high` is equally likely."""

    distribution: Literal["uniform"]
    step: Positive | None = key(None, None, "values are rounded to multiples of this", unset="they are not")

    def at(self, u: Array) -> Array:
        """Values (n,) at points u (n,)."""
        values = self.low + (self.high - self.low) * u
        if self.step is None:
            return values
        first, last = math.ceil(self.low / self.step - 1e-9), math.floor(self.high / self.step + 1e-9)
        return np.minimum(first + np.floor((last - first + 1) * u), last) * self.step

    @model_validator(mode="after")
    def _steps(self) -> Uniform:
        if self.step is not None and math.floor(self.high / self.step + 1e-9) < math.ceil(self.low / self.step - 1e-9):
            raise must("range", f"hold a multiple of step = {self.step:g} between low and high")
        return self


class LogUniform(_OneByOne, _Between):
    """The logarithm is uniform between those of `low` and `high`."""

    distribution: Literal["log-uniform"]

    def at(self, u: Array) -> Array:
        """Values (n,) at points u (n,)."""
        values = np.exp(np.log(self.low) + (np.log(self.high) - np.log(self.low)) * u)
        return np.clip(values, self.low, self.high)  # which rounding may leave

    @model_validator(mode="after")
    def _positive(self) -> LogUniform:
        if self.low <= 0.0:
            raise must("range", f"have low above 0, not {self.low:g}")
        return self


class Normal(_OneByOne):
    """A normal distribution, cut off at `low` and `high` where these are given."""

    distribution: Literal["normal"]
    mean: float = key(..., None, "mean, before it is cut off")
    deviation: Positive = key(..., None, "standard deviation, before it is cut off")
    low: float | None = key(None, None, "lowest value", unset="no limit")
    high: float | None = key(None, None, "highest value", unset="no limit")

    def at(self, u: Array) -> Array:
        """Values (n,) at points u (n,)."""
        with extra("study", "a normal distribution"):
            from scipy.special import ndtri
        ends = [self._share(x, otherwise) for x, otherwise in ((self.low, 0.0), (self.high, 1.0))]
        inside = np.clip(ends[0] + (ends[1] - ends[0]) * u, 1e-16, 1.0 - 1e-16)
        values = self.mean + self.deviation * ndtri(inside)
        return np.clip(values, -np.inf if self.low is None else self.low, np.inf if self.high is None else self.high)

    def _share(self, limit: float | None, otherwise: float) -> float:
        """The share of the whole distribution below a limit."""
        if limit is None:
            return otherwise
        return 0.5 * math.erfc((self.mean - limit) / self.deviation / math.sqrt(2.0))

    @model_validator(mode="after")
    def _holds_something(self) -> Normal:
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise must("range", f"have low = {self.low:g} below high = {self.high:g}")
        if self._share(self.high, 1.0) - self._share(self.low, 0.0) < 1e-6:
            raise must("range", "leave at least a millionth of the distribution between low and high")
        return self


class Integer(_OneByOne):
    """Every whole number from `low` to `high` is equally likely."""

    distribution: Literal["integer"]
    low: int = key(..., "1", "lowest value")
    high: int = key(..., "1", "highest value")

    def at(self, u: Array) -> NDArray[np.int64]:
        """Values (n,) at points u (n,)."""
        return np.minimum(self.low + np.floor((self.high - self.low + 1) * u).astype(np.int64), self.high)

    @model_validator(mode="after")
    def _in_order(self) -> Integer:
        if self.low > self.high or max(abs(self.low), abs(self.high)) > 10**15:
            raise must("range", f"have low = {self.low} at most high = {self.high}, both within 1e15")
        return self


class Among(_OneByOne):
    """One of some values, all equally likely."""

    distribution: Literal["choice"]
    among: tuple[Any, ...] = key(..., None, "values to choose from")

    def at(self, u: Array) -> list[Any]:
        """Values (n,) at points u (n,)."""
        return [self.among[min(int(x * len(self.among)), len(self.among) - 1)] for x in u]

    @model_validator(mode="after")
    def _is_given(self) -> Among:
        if not self.among:
            raise must("range", "have a value among which to choose")
        if self.relative and not all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in self.among):
            raise must("range", "have numbers to choose from where relative = true")
        return self


class Horizontal(_Between):
    """A horizontal vector of any direction, whose length is uniform between `low` and `high`: [x, y, 0]."""

    numbers: ClassVar[int] = 2
    distribution: Literal["horizontal"]

    def values(self, u: Array) -> list[Any]:
        """Vectors (n, 3) at points u (n, 2), as lists."""
        length, angle = self.low + (self.high - self.low) * u[:, 0], 2.0 * np.pi * u[:, 1]
        return np.stack([length * np.cos(angle), length * np.sin(angle), 0.0 * angle], axis=1).tolist()

    @model_validator(mode="after")
    def _one_length(self) -> Horizontal:
        if self.count is not None or self.relative or self.low < 0.0:
            raise must("range", "have low of at least 0, and neither count nor relative")
        return self


DISTRIBUTIONS: dict[str, type[Distribution]] = {
    "uniform": Uniform,
    "log-uniform": LogUniform,
    "normal": Normal,
    "integer": Integer,
    "choice": Among,
    "horizontal": Horizontal,
}
