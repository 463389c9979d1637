"""Compensated sums in a graph of floats: what an addition rounds away is kept, and added in the next step.

W. Kahan, Commun. ACM 8, 1965; here for every number of a state that is its old value and something more.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.compiler.tracer.graph import Graph

ADDENDS = {"fadd": (0, 1), "fsub": (0,), "fma": (2,), "select": (1, 2)}  # operands that may be the sum so far


class CompensatedSum(NamedTuple):
    """Nodes of a new value, and of what its rounding left over."""

    value: int
    rest: int


def compensated(graph: Graph, root: int, old: int, rest: int) -> CompensatedSum | None:
    """A number that is its `old` value and something more, without the error of that sum; None if it is no sum.

    Counts of steps, which are exact, are no such sums, nor are low-pass filters, which forget.

    Args:
        graph: of all nodes.
        root: the node of the number.
        old: the node of its old value.
        rest: the node of what was left over before.
    """
    more = _increment(graph, root, old, rest)
    if more is not None and more != rest:
        value = graph.node("fadd", (old, more), "f")
        return CompensatedSum(value, graph.node("fsub", (more, graph.node("fsub", (value, old), "f")), "f"))
    if graph.ops[root] != "select":
        return None
    condition, *sides = graph.args[root]
    found = [compensated(graph, side, old, rest) for side in sides]
    if found == [None, None]:
        return None
    kept = (CompensatedSum(side, rest if side == old else graph.constant(0.0)) for side in sides)
    both = [own or other for own, other in zip(found, kept, strict=True)]
    return CompensatedSum(*[graph.node("select", (condition, *pair), "f") for pair in zip(*both, strict=True)])


def _increment(graph: Graph, node: int, old: int, rest: int) -> int | None:
    """The node with `rest` in place of the `old` value that it adds to; None if it is something else."""
    if node == old:
        return rest
    op, args = graph.ops[node], graph.args[node]
    places = ADDENDS.get(op, ())
    found = {i: _increment(graph, args[i], old, rest) for i in places}
    sums = {i: made for i, made in found.items() if made is not None}
    if not sums or (op == "select" and len(sums) < len(places)):
        return None
    others = [a for i, a in enumerate(args) if i not in sums]
    forgets = op != "select" and any(old in (a, *_operands(graph, a)) for a in others)
    if (
        (len(sums) > 1 and op != "select")
        or forgets
        or (op != "select" and all(graph.ops[a] == "const" for a in others))
    ):
        return None
    return graph.node(op, tuple(sums.get(i, a) for i, a in enumerate(args)), "f")


def _operands(graph: Graph, node: int) -> tuple[int, ...]:
    return () if graph.ops[node] in ("const", "in") else graph.args[node]
