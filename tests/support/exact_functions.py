"""Operations by IEEE 754: exact rationals, rounded once to the nearest double, ties to even."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any


def rounded(exact: Fraction, sign: float) -> float:
    """The double nearest to an exact number; `sign` is that of a zero."""
    if exact == 0:
        return math.copysign(0.0, sign)
    try:
        size = abs(float(exact))  # Python rounds a quotient of integers once
    except OverflowError:
        size = math.inf
    return size if exact > 0 else -size


def sign_of(x: float) -> float:
    return math.copysign(1.0, x)


def finite(*values: float) -> bool:
    return all(map(math.isfinite, values))


def added(a: float, b: float) -> float:
    if not finite(a, b):
        opposite = math.isinf(a) and math.isinf(b) and a != b
        return math.nan if opposite or a != a or b != b else a if math.isinf(a) else b
    return rounded(Fraction(a) + Fraction(b), -1.0 if sign_of(a) < 0.0 and sign_of(b) < 0.0 else 1.0)


def multiplied(a: float, b: float) -> float:
    sign = sign_of(a) * sign_of(b)
    if not finite(a, b):
        return math.nan if a != a or b != b or a == 0.0 or b == 0.0 else sign * math.inf
    return rounded(Fraction(a) * Fraction(b), sign)


def divided(a: float, b: float) -> float:
    sign = sign_of(a) * sign_of(b)
    if a != a or b != b or (math.isinf(a) and math.isinf(b)) or (a == 0.0 and b == 0.0):
        return math.nan
    if math.isinf(a) or b == 0.0:
        return sign * math.inf
    return sign * 0.0 if math.isinf(b) else rounded(Fraction(a) / Fraction(b), sign)


def once(a: float, b: float, c: float) -> float:
    """a b + c."""
    if not finite(a, b, c):
        return c if finite(a, b) else added(multiplied(a, b), c)
    both = sign_of(a) * sign_of(b) < 0.0 and sign_of(c) < 0.0
    return rounded(Fraction(a) * Fraction(b) + Fraction(c), -1.0 if both else 1.0)


def root(x: float) -> float:
    if not x > 0.0 or math.isinf(x):
        return x if x == 0.0 or x == math.inf else math.nan
    exact, bits = Fraction(x), 700
    squared = (exact.numerator << (2 * bits)) // exact.denominator
    whole = math.isqrt(squared)
    more = whole * whole != squared or (exact.numerator << (2 * bits)) % exact.denominator != 0
    return rounded(Fraction(2 * whole + more, 2 << bits), 1.0)


def below(x: float) -> float:
    """⌊x⌋."""
    return math.copysign(math.floor(x), x) if finite(x) else x


EXACT: dict[str, Callable[..., Any]] = {
    "+": added,
    "-": lambda a, b: added(a, -b),
    "*": multiplied,
    "/": divided,
    "fma": once,
    "sqrt": root,
    "floor": below,
    "abs": lambda x: math.copysign(x, 1.0),
    "negative": lambda x: -x,
    "minimum": lambda a, b: a if a < b else b,
    "maximum": lambda a, b: a if a > b else b,
    "where": lambda condition, a, b: a if condition else b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "&": lambda a, b: a and b,
    "|": lambda a, b: a or b,
    "^": lambda a, b: a is not b,
    "~": lambda a: not a,
}
