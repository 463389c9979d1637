"""Values kept in scratch memory: those constant within a flight, and those that a later part of a step needs."""

from __future__ import annotations

from collections.abc import Callable

from tandemlift.compiler.tracer import LEAVES, Function, Graph, Place, Symbol, symbols
from tandemlift.simulation.loop_code.context import ScratchLayout
from tandemlift.simulation.loop_code.traced_step import Symbols


def steady(graph: Graph, roots: Symbols, state_size: int) -> list[int]:
    """The nodes that steps need and that are constant within a flight.

    Args:
        graph: of a step.
        roots: every value that a step computes.
        state_size: how many of the flight's leading numbers change from step to step.
    """
    constant, wanted = [False] * len(graph.ops), set[int]()
    for node in graph.needed([s.node for s in roots]):
        op, args = graph.ops[node], graph.args[node]
        if op == "in":
            constant[node] = args[0] == "dt" or (args[0] == "fly" and args[1] >= state_size)
        else:
            constant[node] = op == "const" or all(constant[a] for a in args)
        if not constant[node] and op not in LEAVES:
            wanted.update(args)
    return sorted(n for n in wanted if constant[n] and graph.ops[n] not in LEAVES and graph.types[n] == "f")


class ScratchValues:
    """Nodes kept in scratch memory, with their offsets."""

    def __init__(self, graph: Graph, scratch: ScratchLayout) -> None:
        self.graph, self.scratch = graph, scratch
        self.at: dict[int, int] = {}

    def store(self, f: Function, nodes: list[int]) -> None:
        """Write nodes to scratch memory."""
        g, first = self.graph, self.scratch.size
        for node in nodes:
            self.at[node] = self.scratch.take(f"node_{node}", g.counts[node] or 1)
        f.put("%work", first, [s for n in nodes for s in symbols(g, Symbol(g, n, "f"))])

    def bind(self, f: Function) -> None:
        """Make a function read the stored nodes instead of computing them."""
        for node, at in self.at.items():
            f.kept[node] = self._place(at)

    def _place(self, at: int) -> Callable[[], Place]:
        return lambda: Place("%work", at)

    def store_for_later(self, f: Function, later: Symbols) -> None:
        """Store the values known now that the later parts of the step need."""
        g, roots = self.graph, [s.node for s in later]
        known = {n for n in f.known() if g.types[n] == "f" and g.ops[n] not in LEAVES} | self.at.keys()
        wanted = {a for n in g.needed(roots, known) if g.ops[n] not in LEAVES for a in g.args[n]}
        self.store(f, sorted((wanted.union(roots) & known) - self.at.keys()))
