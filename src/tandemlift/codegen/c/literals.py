"""Numbers as text of C, in double and in single precision."""

from __future__ import annotations

import math
import struct
from typing import Any

import numpy as np

EPSILON = 2.220446049250313e-16  # of a double; in single precision, that of a float stands in its place
ROUNDS = 6755399441055744.0, 12582912.0  # adding it rounds to whole numbers: 1.5 · 2⁵², for a float 1.5 · 2²³
SMALLEST, LARGEST = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)


def literal(value: Any, kind: str, real: str) -> str:
    """A constant of a graph.

    In single precision a number too small for a normal float becomes the smallest (it guards a division), and one that
    is too large the largest.

    Args:
        value: a truth, an integer, or the bytes of a double.
        kind: its type in the graph.
        real: "double" or "float".
    """
    if kind == "b":
        return "true" if value else "false"
    if kind == "i":
        return f"INT64_C({value})" if abs(value) >= 1 << 31 else str(value)
    return number(struct.unpack("<d", value)[0], real)


def number(x: float, real: str) -> str:
    """A number, to the last bit in double."""
    if math.isnan(x):
        return "NAN"
    if math.isinf(x):
        return "INFINITY" if x > 0 else "(-INFINITY)"
    text = repr(x) if real == "double" else single(x) + "f"
    return f"({text})" if text.startswith("-") else text


def single(x: float) -> str:
    """The shortest text of the float that stands for a number."""
    if x == EPSILON:
        x = float(np.finfo(np.float32).eps)
    if abs(x) == ROUNDS[0]:
        x = math.copysign(ROUNDS[1], x)
    if x:
        x = math.copysign(min(max(abs(x), SMALLEST), LARGEST), x)
    text = str(np.float32(x))
    return text if any(c in text for c in ".e") else text + ".0"
