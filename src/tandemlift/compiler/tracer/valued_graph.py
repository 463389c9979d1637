"""A graph of which the value of every node is known, for code that sometimes needs to know it.

Values are computed as machine code computes them, in IEEE doubles, each operation rounded by itself. Where Python asks
a symbol for a truth, the answer is the present one, and is kept as a guard: for other inputs, the graph is right while
all guards keep their truth. Where Python needs a plain number, the inputs that it depends on are kept, with the
place that asked: the graph is right only for their present values.
"""

from __future__ import annotations

import math
import operator
import struct
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.compiler.tracer.graph import Graph
from tandemlift.compiler.tracer.symbol import Symbol

WORD = 1 << 64
HERE = str(Path(__file__).parent)


class Guard(NamedTuple):
    """A branch that was taken: its condition, a symbol of type `b`, and whether it holds."""

    condition: Symbol
    holds: bool


def _wrapped(i: int) -> int:
    """An integer in 64 bits, signed."""
    return (i + WORD // 2) % WORD - WORD // 2


def _divided(a: float, b: float) -> float:
    if b != 0.0:
        return a / b
    return math.nan if a == 0.0 or math.isnan(a) else math.copysign(math.inf, a) * math.copysign(1.0, b)


def _truncated(x: float) -> int:
    """As LLVM's saturating conversion: NaN gives 0, a number out of range the nearest integer."""
    if math.isnan(x):
        return 0
    return int(min(max(x, -(2.0**63)), 2.0**63)) if abs(x) < 2.0**63 else (WORD // 2 - 1 if x > 0.0 else -WORD // 2)


COMPARISONS = {"eq": operator.eq, "ne": operator.ne, "lt": operator.lt, "le": operator.le}
COMPARISONS |= {"gt": operator.gt, "ge": operator.ge}
OPERATIONS: dict[str, Callable[..., Any]] = {  # of plain numbers, by the name of their node
    "fadd": operator.add,
    "fsub": operator.sub,
    "fmul": operator.mul,
    "fdiv": _divided,
    "fneg": operator.neg,
    "fabs": abs,
    "sqrt": lambda x: math.sqrt(x) if x >= 0.0 else math.nan,
    "floor": lambda x: math.copysign(math.floor(x), x) if math.isfinite(x) else x,
    "select": lambda condition, a, b: a if condition else b,
    "add": lambda a, b: _wrapped(a + b),
    "sub": lambda a, b: _wrapped(a - b),
    "mul": lambda a, b: _wrapped(a * b),
    "and": operator.and_,
    "or": operator.or_,
    "xor": operator.xor,
    "shl": lambda a, b: _wrapped(a << b),
    "ashr": operator.rshift,
    "sitofp": float,
    "uitofp": float,
    "fptosi": _truncated,
    "bitcast_f": lambda i: struct.unpack("<d", struct.pack("<q", i))[0],
    "bitcast_i": lambda x: struct.unpack("<q", struct.pack("<d", x))[0],
    **{f"fcmp o{name}": test for name, test in COMPARISONS.items() if name != "ne"},
    "fcmp une": operator.ne,
    **{f"icmp {name if name in ('eq', 'ne') else 's' + name}": test for name, test in COMPARISONS.items()},
}


def evaluated(graph: Graph, inputs: Sequence[float]) -> list[Any]:
    """The values of all nodes of a graph of single numbers whose input i has the value `inputs[i]`."""
    values = list[Any]()
    for op, args in zip(graph.ops, graph.args, strict=True):
        values.append(_value(op, args, values, inputs))
    return values


def _value(op: str, args: tuple[Any, ...], values: list[Any], inputs: Sequence[float]) -> Any:
    if op == "const":
        return struct.unpack("<d", args[0])[0] if isinstance(args[0], bytes) else args[0]
    if op == "in":
        return inputs[args[1]]
    return OPERATIONS[op](*[values[a] for a in args])


class ValuedGraph(Graph):
    """A graph whose input i has the value `numbers[i]`.

    Attributes:
        values: of the nodes.
        guards: the branches that were taken, by the node of their condition.
        used: the inputs that plain numbers were made of, each with why and where it was first.
    """

    def __init__(self, numbers: Sequence[float]) -> None:
        super().__init__()
        self.numbers = tuple(numbers)
        self.values: list[Any] = []
        self.guards: dict[int, Guard] = {}
        self.used: dict[int, str] = {}

    def node(self, op: str, args: tuple[Any, ...], kind: str, count: int = -1) -> int:
        """The number of a node; a new one is evaluated."""
        node = super().node(op, args, kind, count)
        if node == len(self.values):
            self.values.append(_value(op, args, self.values, self.numbers))
        return node

    def truth(self, symbol: Symbol) -> bool:
        """The truth of a symbol, kept as a guard."""
        if symbol.type != "b":
            symbol = symbol != 0
        holds = bool(self.values[symbol.node])
        if symbol.node not in self.guards and self.inputs_of(symbol):
            self.guards[symbol.node] = Guard(symbol, holds)
        return holds

    def plain(self, symbol: Symbol, *, rounded: bool = False) -> float:
        """The value of a symbol; the inputs that it depends on are kept."""
        reason = f"is {'rounded to a whole number' if rounded else 'used as a plain number'} by {_asking()}"
        for number in self.inputs_of(symbol):
            self.used.setdefault(number, reason)
        return float(self.values[symbol.node])

    def power(self, base: Any, exponent: Any) -> Any:
        """A power: a product for whole exponents to 3, a root for a half, else by exponential and logarithm."""
        functions: Any = Symbol.functions
        if not isinstance(exponent, Symbol) and exponent in (0, 1, 2, 3):
            return (1.0, base, base * base, base * base * base)[int(exponent)]
        if not isinstance(exponent, Symbol) and exponent == 0.5:
            return functions.sqrt(base)
        return functions.exp(functions.log(base) * exponent)

    def inputs_of(self, symbol: Symbol) -> list[int]:
        """The numbers of the inputs that a symbol depends on."""
        return [self.args[node][1] for node in self.needed([symbol.node]) if self.ops[node] == "in"]


def _asking() -> str:
    """The function that needed a plain number, and its module."""
    frame = sys._getframe(2)
    while frame.f_back and frame.f_code.co_filename.startswith(HERE):
        frame = frame.f_back
    name = frame.f_code.co_qualname.partition(".<locals>")[0]
    return f"{frame.f_globals.get('__name__', '')}.{name}".removeprefix("tandemlift.")
