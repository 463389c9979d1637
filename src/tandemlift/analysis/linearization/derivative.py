"""Values of a graph's nodes with their derivatives, node by node: forward differentiation in double precision.

A node's derivative is a row with an entry for each seed; None where the node depends on no seed.
"""

from __future__ import annotations

import functools
import math
import struct
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from tandemlift.compiler.machine_code.derivatives import OPERATIONS, PARTIALS, smooth_arguments
from tandemlift.compiler.tracer import LEAVES, Graph
from tandemlift.core.types import Array

TIE_TOLERANCE = 1e-9  # relative, of values that are equal
CURVED = 100.0  # excess of a value's change on a short distance over that of its derivative
MAX_FACTOR = 1e150  # of a factor whose product is split exactly


def once_rounded(a: float, b: float, c: float) -> float:
    """a b + c as machine code rounds it: once, by exact products and sums of halves (Dekker, Numer. Math. 18, 1971)."""
    p = a * b
    s = p + c
    if not (abs(a) < MAX_FACTOR and abs(b) < MAX_FACTOR and math.isfinite(s)):
        return s
    u, v = 134217729.0 * a, 134217729.0 * b
    a1, b1 = u - (u - a), v - (v - b)
    a2, b2 = a - a1, b - b1
    e = ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2
    t = s - p
    return s + (((p - (s - t)) + (c - t)) + e)


VALUE: dict[str, Callable[..., Any]] = {**OPERATIONS, "fma": once_rounded}


Row: TypeAlias = Array | None
"""The derivative of a node by every seed; None if it depends on none."""


def _sum(a: Row, b: Row) -> Row:
    return b if a is None else a if b is None else a + b


def difference(a: Row, b: Row) -> Row:
    """The derivative of a difference, from those of its terms."""
    return a if b is None else -b if a is None else a - b


def _scaled(row: Row, factor: float) -> Row:
    return None if row is None else row * factor


def row_of(op: str, x: Sequence[Any], d: Sequence[Row], v: Any) -> Row:
    """The derivative of an operation's result v, from its operands x and their derivatives.

    That of a root is 0 at 0 if the argument has none either, as for a sum of squares.
    """
    if op == "select":
        return d[1] if x[0] else d[2]
    if op == "sqrt" and v == 0.0 and d[0] is not None and not d[0].any():
        return d[0]
    return functools.reduce(_sum, map(_scaled, d, PARTIALS[op](x, v)), None)


class Sides(NamedTuple):
    """Truths of comparisons, and whether an absolute value is of a positive number, against those that hold, by node.

    A selection then has the derivative of the other branch. It has its value only if the branches do not meet at the
    edge, so that what is continuous does not change by the `distance` from the edge.
    """

    of: Mapping[int, bool]
    distance: float


def meet(x: Sequence[float], d: Sequence[Row], distance: float) -> bool:
    """Whether two branches of a selection have one value at an edge at a distance; `d`: their derivatives."""
    if x[0] == x[1]:
        return True
    steepest = max([1.0, *[np.abs(row).max() for row in d if row is not None]])
    return bool(abs(x[0] - x[1]) <= TIE_TOLERANCE * abs(x[0]) + CURVED * distance * steepest)


class Derivative:
    """The values of nodes of a graph and their derivatives, computed on first use.

    Args:
        graph: without large sets.
        sides: used instead of the actual ones.

    Attributes:
        values: of the nodes computed so far, by node.
        rows: their derivatives by each seed, by node; None for a node that depends on no seed.
    """

    def __init__(self, graph: Graph, sides: Sides | None = None) -> None:
        self.graph, self.sides = graph, sides or Sides({}, 0.0)
        self.values: dict[int, Any] = {}
        self.rows: dict[int, Any] = {}
        self._inputs: dict[str, tuple[Sequence[float], Sequence[Any] | None]] = {}
        self._truths: dict[int, bool] = {}  # that choose derivatives, where they are not those that choose values

    def reuse(self, other: Derivative, changed: set[int]) -> None:
        """Copy the results of another one, except for changed nodes."""
        self.values |= {n: v for n, v in other.values.items() if n not in changed}
        self.rows |= {n: row for n, row in other.rows.items() if n not in changed}

    def bind(self, kind: str, values: Sequence[float], rows: Sequence[Row] | None = None) -> None:
        """Set the inputs of a kind: their values and derivatives; without derivatives they depend on no seed."""
        self._inputs[kind] = values, rows

    def fix_row(self, node: int, row: Row) -> None:
        """Replace the derivative of a node, as if the node were an input."""
        self.compute([node])
        self.rows[node] = row

    def add_row(self, node: int, row: Row) -> None:
        """Add to the derivative of a node, as if an input were added to its value."""
        self.compute([node])
        self.rows[node] = _sum(self.rows[node], row)

    def compute(self, nodes: Iterable[int]) -> None:
        """Compute nodes and all that they depend on."""
        g, values, rows, sides = self.graph, self.values, self.rows, self.sides.of
        with np.errstate(all="ignore"):  # of branches that are not chosen, too
            for node in g.needed(nodes, values):
                op, args = g.ops[node], g.args[node]
                if op in LEAVES:
                    values[node], rows[node] = self._leaf(node)
                    continue
                x = [values[a] for a in args]
                values[node] = v = VALUE[op](*x)
                d = [rows[a] for a in args]
                passes = any(rows[a] is not None for a in smooth_arguments(g, node))
                rows[node] = row_of(op, x, d, v) if passes else None
                if sides:
                    self._take_side(node, op, args, x, d)

    def truth(self, node: int) -> bool:
        """The truth of a node that counts for derivatives."""
        return self._truths.get(node, self.values[node])

    def _take_side(self, node: int, op: str, args: Sequence[int], x: list[Any], d: list[Any]) -> None:
        truths, side = self._truths, self.sides.of.get(node)
        if op == "fabs":
            if side is not None:
                self.rows[node] = _scaled(d[0], 1.0 if side else -1.0)
        elif side is not None:
            truths[node] = side
        elif any(a in truths for a in args):
            chosen = [truths.get(a, value) for a, value in zip(args, x, strict=True)]
            if self.graph.types[node] == "b":
                truths[node] = VALUE[op](*chosen)
            elif op == "select":
                branch = 1 if chosen[0] else 2
                self.rows[node] = d[branch]
                if not meet(x[1:], d[1:], self.sides.distance):
                    self.values[node] = x[branch]

    def _leaf(self, node: int) -> tuple[Any, Any]:
        op, args = self.graph.ops[node], self.graph.args[node]
        if op == "const":
            value = args[0]
            return (struct.unpack("<d", value)[0] if isinstance(value, bytes) else value), None
        values, rows = self._inputs[args[0]]
        return float(values[args[1]]), None if rows is None else rows[args[1]]

    def values_of(self, nodes: Sequence[int]) -> Array:
        """The values of nodes."""
        self.compute(nodes)
        return np.array([self.values[n] for n in nodes], dtype=float)

    def rows_of(self, nodes: Sequence[int], seeds: int) -> Array:
        """The derivatives (len(nodes), seeds) of nodes."""
        self.compute(nodes)
        made = np.zeros((len(nodes), seeds))
        for i, node in enumerate(nodes):
            if self.rows[node] is not None:
                made[i] = self.rows[node]
        return made
