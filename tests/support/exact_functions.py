"""Product and sum in one operation by exact rationals; the other operations of IEEE 754 are those of NumPy."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np


def once(a: float, b: float, c: float) -> float:
    """a b + c, rounded once to the nearest double, ties to even."""
    if not (math.isfinite(a) and math.isfinite(b)):
        with np.errstate(all="ignore"):
            return float(np.add(np.multiply(a, b), c))
    if not math.isfinite(c):
        return c  # a b may be beyond all doubles, but is finite
    exact = Fraction(a) * Fraction(b) + Fraction(c)
    if exact == 0:
        is_negative = math.copysign(1.0, a) * math.copysign(1.0, b) < 0.0 and math.copysign(1.0, c) < 0.0
        return -0.0 if is_negative else 0.0
    try:
        return float(exact)  # Python rounds a quotient of integers once
    except OverflowError:
        return math.inf if exact > 0 else -math.inf
