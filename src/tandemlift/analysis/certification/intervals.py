"""Laws on intervals: bounds of what a law returns over a box of its inputs, by the law's own source.

An `Interval` carries `functions`, so `core.algebra` finds its elementary operations here. Ends may be arrays: a law
then runs on many boxes at once, and the bounds of a box cut in pieces are narrower.

Rounding is outward. A sum, product, quotient or root is rounded correctly, so one step of the last place covers it,
fused or not; `WIDE` steps cover an elementary function of NumPy and of compiled laws (at most 2.75 ulp). Ends that are
NaN mean that the law may return NaN somewhere in the box. A comparison that the box does not decide selects both
branches. Source: Moore, Kearfott and Cloud, Introduction to Interval Analysis, 2009, ch. 2 and 5.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tandemlift.core.types import Array

ULPS = 4  # steps of the last place
SLACK = 1e-12  # relative, of an argument that may be a quarter turn


def _down(x: Any, steps: int = 1) -> Any:
    for _ in range(steps):
        x = np.nextafter(x, -np.inf)
    return x


def _up(x: Any, steps: int = 1) -> Any:
    for _ in range(steps):
        x = np.nextafter(x, np.inf)
    return x


class Truth:
    """Whether a comparison can be true, and whether it can be false, in each box."""

    functions: Any

    def __init__(self, true: Any, false: Any) -> None:
        self.true, self.false = true, false

    def __and__(self, other: Any) -> Truth:
        b = _truth(other)
        return Truth(self.true & b.true, self.false | b.false)

    def __or__(self, other: Any) -> Truth:
        b = _truth(other)
        return Truth(self.true | b.true, self.false & b.false)

    __rand__, __ror__ = __and__, __or__


def _truth(x: Any) -> Truth:
    return x if isinstance(x, Truth) else Truth(np.bool_(x), np.bool_(not x))


class Interval:
    """All numbers from `lo` to `hi`, numbers or arrays of one shape; NaN where the value may be no number."""

    __array_ufunc__ = None  # a NumPy number on the left defers to our operators
    __hash__ = None  # type: ignore[assignment]
    functions: Any

    def __init__(self, lo: Any, hi: Any) -> None:
        self.lo, self.hi = lo, hi

    def __neg__(self) -> Interval:
        return Interval(-self.hi, -self.lo)

    def __add__(self, other: Any) -> Interval:
        b = _interval(other)
        low, high = self.lo + b.lo, self.hi + b.hi
        return Interval(
            np.where((self.lo == 0.0) | (b.lo == 0.0), low, _down(low)),
            np.where((self.hi == 0.0) | (b.hi == 0.0), high, _up(high)),
        )

    def __sub__(self, other: Any) -> Interval:
        return self + -_interval(other)

    def __rsub__(self, other: Any) -> Interval:
        return _interval(other) + -self

    def __mul__(self, other: Any) -> Interval:
        b = _interval(other)
        if b is self:
            b = a = _size(self)
            return Interval(_product(a.lo, b.lo)[0], _product(a.hi, b.hi)[1])
        ends = [_product(x, y) for x in (self.lo, self.hi) for y in (b.lo, b.hi)]
        return Interval(_least(low for low, _ in ends), -_least(-high for _, high in ends))

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other: Any) -> Interval:
        return _quotient(self, _interval(other))

    def __rtruediv__(self, other: Any) -> Interval:
        return _quotient(_interval(other), self)

    def __lt__(self, other: Any) -> Truth:
        b = _interval(other)
        return Truth(~(self.lo >= b.hi), ~(self.hi < b.lo))

    def __le__(self, other: Any) -> Truth:
        b = _interval(other)
        return Truth(~(self.lo > b.hi), ~(self.hi <= b.lo))

    def __gt__(self, other: Any) -> Truth:
        return _interval(other) < self

    def __ge__(self, other: Any) -> Truth:
        return _interval(other) <= self

    def __eq__(self, other: Any) -> Truth:  # type: ignore[override]
        b = _interval(other)
        return Truth(~((self.lo > b.hi) | (self.hi < b.lo)), ~((self.lo == b.hi) & (self.hi == b.lo)))

    def __ne__(self, other: Any) -> Truth:  # type: ignore[override]
        equal = self == other
        return Truth(equal.false, equal.true)


def _interval(x: Any) -> Interval:
    return x if isinstance(x, Interval) else Interval(np.float64(x), np.float64(x))


def _least(ends: Any) -> Any:
    return np.minimum.reduce(np.broadcast_arrays(*ends))


def _product(a: Any, b: Any) -> tuple[Any, Any]:
    """Bounds of the product of two ends; 0 times anything is 0."""
    p, exact = a * b, (a == 0.0) | (b == 0.0)
    return np.where(exact, 0.0, _down(p)), np.where(exact, 0.0, _up(p))


def _quotient(a: Interval, b: Interval) -> Interval:
    ends = [x / y for x in (a.lo, a.hi) for y in (b.lo, b.hi)]
    return _unless((b.lo <= 0.0) & (b.hi >= 0.0), Interval(_down(_least(ends)), _up(-_least(-q for q in ends))))


def _unless(bad: Any, x: Interval) -> Interval:
    """x, and no number where `bad`."""
    return Interval(np.where(bad, np.nan, x.lo), np.where(bad, np.nan, x.hi))


def _monotone(function: Callable[[Any], Any], least: float = -math.inf) -> Callable[[Any], Interval]:
    def bounded(x: Interval) -> Interval:
        return Interval(np.maximum(_down(function(x.lo), ULPS), least), _up(function(x.hi), ULPS))

    return bounded


def _periodic(function: Callable[[Any], Any], top: float) -> Callable[[Any], Interval]:
    """Bounds of a sine or cosine, whose maxima are at top + 2πk."""

    def reaches(x: Interval, at: float) -> Any:
        slack = SLACK * (1.0 + np.maximum(abs(x.lo), abs(x.hi)))
        return np.floor((x.hi - at + slack) / math.tau) >= np.ceil((x.lo - at - slack) / math.tau)

    def bounded(x: Interval) -> Interval:
        a, b = function(x.lo), function(x.hi)
        low, high = np.maximum(_down(np.minimum(a, b), ULPS), -1.0), np.minimum(_up(np.maximum(a, b), ULPS), 1.0)
        widened = Interval(np.where(reaches(x, top + math.pi), -1.0, low), np.where(reaches(x, top), 1.0, high))
        return _unless(np.isnan(a + b), widened)

    return bounded


def _tangent(x: Interval) -> Interval:
    turns = [np.floor(end / math.pi + 0.5) for end in (x.lo * (1.0 - SLACK) - SLACK, x.hi * (1.0 + SLACK) + SLACK)]
    return _unless(turns[0] != turns[1], _monotone(np.tan)(x))


def _angle(y: Interval, x: Interval) -> Interval:
    ends = [np.arctan2(b, a) for a in (x.lo, x.hi) for b in (y.lo, y.hi)]
    cut, turn = (x.lo <= 0.0) & (y.lo <= 0.0) & (y.hi >= 0.0), _up(math.pi)
    low, high = _down(_least(ends), ULPS), _up(-_least(-end for end in ends), ULPS)
    found = Interval(np.where(cut, -turn, low), np.where(cut, turn, high))
    return _unless(np.isnan(low), found)


def _size(x: Interval) -> Interval:
    around = (x.lo <= 0.0) & (x.hi >= 0.0)
    low, high = np.minimum(abs(x.lo), abs(x.hi)), np.maximum(abs(x.lo), abs(x.hi))
    return Interval(np.where(around, 0.0, low), high)


def _root(x: Interval) -> Interval:
    return _unless(x.lo < 0.0, Interval(np.maximum(_down(np.sqrt(abs(x.lo))), 0.0), _up(np.sqrt(abs(x.hi)))))


def _where(condition: Any, a: Any, b: Any) -> Interval:
    t, a, b = _truth(condition), _interval(a), _interval(b)
    both = t.true & t.false
    return Interval(
        np.where(both, np.minimum(a.lo, b.lo), np.where(t.true, a.lo, b.lo)),
        np.where(both, np.maximum(a.hi, b.hi), np.where(t.true, a.hi, b.hi)),
    )


OPERATIONS: dict[str, Callable[..., Interval]] = {
    "sqrt": _root,
    "sin": _periodic(np.sin, 0.5 * math.pi),
    "cos": _periodic(np.cos, 0.0),
    "tan": _tangent,
    "atan2": _angle,
    "tanh": _monotone(np.tanh),
    "exp": _monotone(lambda x: np.exp(np.minimum(x, 709.0)), 0.0),
    "expm1": _monotone(lambda x: np.expm1(np.minimum(x, 709.0)), -1.0),
    "log": lambda x: _unless(x.lo <= 0.0, _monotone(np.log)(x)),
    "absolute": _size,
    "minimum": lambda a, b: Interval(np.minimum(a.lo, b.lo), np.minimum(a.hi, b.hi)),
    "maximum": lambda a, b: Interval(np.maximum(a.lo, b.lo), np.maximum(a.hi, b.hi)),
}


class _Functions:
    """The elementary operations of intervals, by name."""

    where = staticmethod(_where)

    def __getattr__(self, name: str) -> Callable[..., Interval]:
        return lambda *args: OPERATIONS[name](*map(_interval, args))


Interval.functions = Truth.functions = _Functions()


def bounds(function: Callable[[Sequence[Any]], Sequence[Any]], low: Array, high: Array) -> tuple[Array, Array]:
    """(Least, largest) values (p) of a function's p numbers over N boxes together; NaN where one may be no number.

    Args:
        function: of n numbers, in the operations of `core.algebra`.
        low, high: (n, N) ends of the boxes.
    """
    with np.errstate(all="ignore"):
        found = [_interval(y) for y in function([Interval(a, b) for a, b in zip(low, high, strict=True)])]
    return np.array([np.min(y.lo) for y in found]), np.array([np.max(y.hi) for y in found])
