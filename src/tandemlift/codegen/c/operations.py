"""The operations of a graph as expressions of C, with as few parentheses as the order of operations needs."""

from __future__ import annotations

from typing import NamedTuple

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
LIBRARY = {"sqrt": "sqrt", "fabs": "fabs", "floor": "floor"}
SINGLE_PRODUCT = ("fmul", "fdiv")


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
        return Expression(f"{LIBRARY[op]}{'f' * (real == 'float')}({x[0].text})", ATOM)
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
