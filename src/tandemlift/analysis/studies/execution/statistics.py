"""Estimates with their intervals: of a share of rows, and of a quantile of numbers."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array

CONFIDENCE = 0.95


class Share(NamedTuple):
    """The number of rows with a property, with the interval of its probability."""

    number: int
    total: int
    low: float
    high: float

    @property
    def value(self) -> float:
        """The share; NaN of no rows."""
        return self.number / self.total if self.total else math.nan


class IntervalEstimate(NamedTuple):
    """A number with its interval; NaN if there is too little data."""

    value: float
    low: float
    high: float


def _check_confidence(confidence: float) -> None:
    if not 0.0 < confidence < 1.0:
        raise InputError(f"confidence = {confidence!r}: must be between 0 and 1")


def share(count: int, total: int, confidence: float = CONFIDENCE) -> Share:
    """A share with the two-sided interval of Clopper and Pearson.

    Args:
        count: rows that have the property.
        total: rows in all; of none, the interval is all of [0, 1].
        confidence: of the interval.

    Raises:
        InputError: the numbers are no counts, or SciPy is not installed (extra: study).
    """
    _check_confidence(confidence)
    high = upper_bound(count, total, (1.0 + confidence) / 2.0)
    from scipy.special import betaincinv  # which the upper bound found installed

    low = float(betaincinv(count, total - count + 1, (1.0 - confidence) / 2.0)) if count else 0.0
    return Share(count, total, low, high)


def upper_bound(count: int, total: int, confidence: float = CONFIDENCE) -> float:
    """The probability that is not exceeded, with a confidence: the one-sided bound of Clopper and Pearson.

    Without a single event in n rows it is 1 - (1 - confidence)^(1/n), nearly 3 / n at 95 %. Arguments and errors are
    those of `share`.
    """
    _check_confidence(confidence)
    if not 0 <= count <= total:
        raise InputError(f"count = {count!r}: must be from 0 to the total of {total!r}")
    with extra("study", "statistics"):
        from scipy.special import betaincinv
    return float(betaincinv(count + 1, total - count, confidence)) if count < total else 1.0


def finite(values: Array) -> Array:
    """The values that are numbers."""
    return values[np.isfinite(values)]


def quantile(values: Array, at: float = 0.5, confidence: float = CONFIDENCE) -> IntervalEstimate:
    """A quantile of the finite values, with an interval between two of them.

    Args:
        values: (n,), in any order.
        at: which quantile; 0.5 is the median.
        confidence: at least that of the interval; where the values are too few for it, its bounds are NaN.

    Raises:
        InputError: a number is not between 0 and 1, or SciPy is not installed (extra: study).
    """
    _check_confidence(confidence)
    if not 0.0 < at < 1.0:
        raise InputError(f"at = {at!r}: must be between 0 and 1")
    with extra("study", "statistics"):
        from scipy.stats import binom
    ordered = np.sort(finite(values))
    count, beyond = len(ordered), (1.0 - confidence) / 2.0
    if not count:
        return IntervalEstimate(math.nan, math.nan, math.nan)
    first, last = int(binom.ppf(beyond, count, at)), int(binom.ppf(1.0 - beyond, count, at)) + 1  # numbers from 1
    low = float(ordered[first - 1]) if first >= 1 else math.nan
    high = float(ordered[last - 1]) if last <= count else math.nan
    return IntervalEstimate(float(np.quantile(ordered, at)), low, high)
