"""Derivatives of a graph as further nodes of it: tangents forward, cotangents in reverse.

An input may stand for another node: it has a value of its own, such as the result of a search, and that node's
derivative.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from graphlib import TopologicalSorter
from typing import Any

from tandemlift.compiler.tracer.differentiation import PARTIALS, smooth_arguments
from tandemlift.compiler.tracer.graph import LEAVES, Graph
from tandemlift.compiler.tracer.symbol import Symbol, made, select

StandsFor = Mapping[int, int]
"""Inputs, each with the node whose derivative it has."""


def inlined(graph: Graph, roots: Iterable[int], by: Mapping[int, int], for_: StandsFor) -> dict[int, Symbol]:
    """The nodes that roots need, in a graph of their own, where some inputs are replaced `by` nodes that form them.

    There, arguments come before their readers, and nodes before the inputs that stand for them.
    """
    needs, stack = dict[int, list[int]](), list(roots)
    while stack:
        node = stack.pop()
        if node not in needs:
            formed = [source[node] for source in (by, for_) if node in source]
            needs[node] = formed if graph.ops[node] in LEAVES else list(graph.args[node])
            stack += needs[node]
    copy, copied = Graph(), dict[int, Symbol]()
    for node in TopologicalSorter(needs).static_order():
        if node in by:
            copied[node] = copied[by[node]]
            continue
        op, args, kind = graph.ops[node], graph.args[node], graph.types[node]
        number = copy.node(op, args if op in LEAVES else tuple([copied[a].node for a in args]), kind)
        copy.laws[number], copied[node] = graph.laws[node], Symbol(copy, number, kind)
    return copied


def tangents(graph: Graph, roots: Iterable[int], given: Mapping[int, Symbol], for_: StandsFor) -> dict[int, Symbol]:
    """The tangents of nodes from those `given` of inputs; a node without one is missing."""
    found = dict[int, Any](given)
    for node in graph.needed([*roots, *for_.values()]):
        args, smooth = graph.args[node], [a for a in smooth_arguments(graph, node) if a in found]
        if node in for_ and for_[node] in found:
            found[node] = found[for_[node]]
        elif smooth and graph.ops[node] == "select":
            found[node] = select(_symbol(graph, args[0]), *[found.get(a, 0.0) for a in args[1:]])
        elif smooth:
            total: Any = None
            for a, factor in zip(args, _factors(graph, node), strict=False):
                total = _scaled(found[a], factor, total) if a in found else total
            found[node] = total
    return found


def cotangents(
    graph: Graph, given: Iterable[tuple[int, Symbol]], wanted: Collection[int], for_: StandsFor
) -> dict[int, Symbol]:
    """The cotangents of `wanted` inputs, and of nodes on the way, from those `given` of nodes.

    A branch that is not selected may divide by 0. Its cotangent is 0, and stays so.
    """
    found, ends = dict[int, Any](), list(given)
    for node, bar in ends:
        found[node] = _scaled(bar, 1.0, found.get(node))
    nodes = graph.needed([*found, *for_.values()])
    moving, unsafe, free = set(wanted), set[int](), set(found)
    for node in nodes:
        op, args = graph.ops[node], smooth_arguments(graph, node)
        if for_.get(node) in moving or any(a in moving for a in args):
            moving.add(node)
        divides = op == "sqrt" or (op == "fdiv" and graph.ops[args[1]] != "const")
        if divides or (op != "select" and any(a in unsafe for a in args)):
            unsafe.add(node)
    for node in reversed(nodes):
        if node not in found or node not in moving:
            continue
        bar, args = found[node], graph.args[node]
        if node in for_:
            shares: list[tuple[int, Any]] = [(for_[node], 1.0)]
        elif graph.ops[node] == "select":
            condition = _symbol(graph, args[0])
            for a, share in ((args[1], select(condition, bar, 0.0)), (args[2], select(condition, 0.0, bar))):
                if a in moving:
                    found[a] = _scaled(share, 1.0, found.get(a))
            continue
        else:
            shares = list(zip(args, _factors(graph, node), strict=False))
        may_fail = node not in free and node in unsafe
        for a, factor in shares:
            if a in moving:
                own = select(bar == 0.0, 0.0, bar * factor) if may_fail and isinstance(factor, Symbol) else None
                found[a] = _scaled(bar, factor, found.get(a)) if own is None else _scaled(own, 1.0, found.get(a))
                if node in free:
                    free.add(a)
    return found


def _symbol(graph: Graph, node: int) -> Symbol:
    return Symbol(graph, node, graph.types[node])


def _factors(graph: Graph, node: int) -> tuple[Any, ...]:
    """The derivatives of a node by its operands; that of a root is 0 at 0."""
    if not smooth_arguments(graph, node):
        return ()
    operands, result = [_symbol(graph, a) for a in graph.args[node]], _symbol(graph, node)
    factors = PARTIALS[graph.ops[node]](operands, result)
    return (select(result == 0.0, 0.0, factors[0]),) if graph.ops[node] == "sqrt" else factors


def _scaled(value: Symbol, factor: Any, plus: Any = None) -> Any:
    """value · factor + plus, which may be nothing."""
    if isinstance(factor, Symbol):
        return value * factor if plus is None else made(value.graph, "fma", value, factor, plus)
    if plus is None:
        return value if factor > 0.0 else -value
    return plus + value if factor > 0.0 else plus - value
