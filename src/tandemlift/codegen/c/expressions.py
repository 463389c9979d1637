"""Numbers and operations of a graph as expressions of C, in double and in single precision."""

from __future__ import annotations

import math
import struct
from typing import Any, NamedTuple

import numpy as np

EPSILON = 2.220446049250313e-16  # of a double; in single precision, that of a float stands in its place
ROUNDS = 6755399441055744.0, 12582912.0  # adding it rounds to whole numbers: 1.5 · 2⁵², for a float 1.5 · 2²³
FLOAT_MIN, FLOAT_MAX = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)


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
        x = math.copysign(min(max(abs(x), FLOAT_MIN), FLOAT_MAX), x)
    text = str(np.float32(x))
    return text if any(c in text for c in ".e") else text + ".0"


ATOM, UNARY, PRODUCT, SUM, COMPARED, JOINED, CHOSEN = range(7)


class Expression(NamedTuple):
    """Text, and how loosely it binds."""

    text: str
    loose: int

    def within(self, loosest: int) -> str:
        """The text as an operand of an operation that allows no looser one."""
        return self.text if self.loose <= loosest else f"({self.text})"


ARITHMETIC = {
    "fadd": ("+", SUM, SUM),
    "fsub": ("-", SUM, SUM),
    "fmul": ("*", PRODUCT, PRODUCT),
    "fdiv": ("/", PRODUCT, PRODUCT),
}
WRAPPING = {"add": "+", "sub": "-", "mul": "*", "and": "&", "or": "|", "xor": "^"}
TRUTHS = {"and": "&&", "or": "||", "xor": "!="}
COMPARISONS = {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "==", "ne": "!="}
LIBRARY = ("sqrt", "fabs", "floor")


def expression(op: str, kind: str, given: str, x: list[Expression], real: str) -> Expression:
    """An operation on operands.

    Args:
        op: of the graph.
        kind: type of the result.
        given: type of the first operand.
        x: the operands.
        real: "double" or "float".
    """
    if op in ARITHMETIC:
        sign, loose, left = ARITHMETIC[op]
        return Expression(f"{x[0].within(left)} {sign} {x[1].within(loose - 1)}", loose)
    if op == "fneg":
        return Expression(f"-{x[0].within(ATOM)}", UNARY)
    if op in LIBRARY:
        return Expression(f"{op}{'f' * (real == 'float')}({x[0].text})", ATOM)
    if op == "select":
        return Expression(f"{x[0].within(UNARY)} ? {x[1].within(SUM)} : {x[2].within(SUM)}", CHOSEN)
    if op[1:4] == "cmp":
        return Expression(f"{x[0].within(SUM)} {COMPARISONS[op[-2:]]} {x[1].within(SUM)}", COMPARED)
    if given == "b" and op in TRUTHS:
        return _of_truths(op, x)
    return _of_integers(op, kind, x, real)


def _of_truths(op: str, x: list[Expression]) -> Expression:
    if op == "xor" and x[1].text == "true":
        return Expression(f"!{x[0].within(ATOM)}", UNARY)
    return Expression(f"{x[0].within(UNARY)} {TRUTHS[op]} {x[1].within(UNARY)}", JOINED)


def _of_integers(op: str, kind: str, x: list[Expression], real: str) -> Expression:
    """Integers wrap around, as machine integers do; in C only unsigned ones may."""
    if op in WRAPPING:
        a, b = (f"(uint64_t){v.within(ATOM)}" for v in x)
        return Expression(f"(int64_t)({a} {WRAPPING[op]} {b})", UNARY)
    if op == "shl":
        return Expression(f"(int64_t)((uint64_t){x[0].within(ATOM)} << {x[1].within(ATOM)})", UNARY)
    if op == "ashr":
        return Expression(f"shifted_right({x[0].text}, {x[1].text})", ATOM)
    if op == "uitofp":
        one, none = ("1.0f", "0.0f") if real == "float" else ("1.0", "0.0")
        return Expression(f"{x[0].within(UNARY)} ? {one} : {none}", CHOSEN)
    if op == "sitofp":
        return Expression(f"({real}){x[0].within(ATOM)}", UNARY)
    names = {"fptosi": "to_integer", "bitcast_i": "bits_of", "bitcast_f": "number_of"}
    return Expression(f"{names[op]}({x[0].text})", ATOM)
