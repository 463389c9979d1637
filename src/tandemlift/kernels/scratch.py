"""What was computed before waits in scratch memory: what does not change within a flight, and from part to part."""

from __future__ import annotations

from collections.abc import Callable

from tandemlift.kernels.context import ScratchLayout
from tandemlift.kernels.traced_step import Symbols
from tandemlift.trace import LEAVES, Function, Graph, Place, Symbol, symbols


def steady(graph: Graph, roots: Symbols, moving: int) -> list[int]:
    """The nodes that steps need and that depend on what does not change within a flight.

    Args:
        graph: of a step.
        roots: all that a step gives.
        moving: how many numbers of the flight change.
    """
    found, wanted = [False] * len(graph.ops), set[int]()
    for node in graph.needed([s.node for s in roots]):
        op, args = graph.ops[node], graph.args[node]
        if op == "in":
            found[node] = args[0] == "dt" or (args[0] == "fly" and args[1] >= moving)
        else:
            found[node] = op == "const" or all(found[a] for a in args)
        if not found[node] and op not in LEAVES:
            wanted.update(args)
    return sorted(n for n in wanted if found[n] and graph.ops[n] not in LEAVES and graph.types[n] == "f")


class ScratchValues:
    """Nodes that wait in scratch memory, and where."""

    def __init__(self, graph: Graph, rooms: ScratchLayout) -> None:
        self.graph, self.rooms = graph, rooms
        self.at: dict[int, int] = {}

    def leave(self, f: Function, nodes: list[int]) -> None:
        """Let nodes wait from here on."""
        g, first = self.graph, self.rooms.size
        for node in nodes:
            self.at[node] = self.rooms.take(f"node_{node}", g.counts[node] or 1)
        f.put("%work", first, [s for n in nodes for s in symbols(g, Symbol(g, n, "f"))])

    def find(self, f: Function) -> None:
        """Let a function find what waits."""
        for node, at in self.at.items():
            f.kept[node] = self._place(at)

    def _place(self, at: int) -> Callable[[], Place]:
        return lambda: Place("%work", at)

    def hand_on(self, f: Function, later: Symbols) -> None:
        """Let what later parts of a step need of what is known now wait for them."""
        g, roots = self.graph, [s.node for s in later]
        known = {n for n in f.known() if g.types[n] == "f" and g.ops[n] not in LEAVES} | self.at.keys()
        wanted = {a for n in g.needed(roots, known) if g.ops[n] not in LEAVES for a in g.args[n]}
        self.leave(f, sorted((wanted.union(roots) & known) - self.at.keys()))
