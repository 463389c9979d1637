"""The variables of a function of C: values that the law names, that are used twice, or that would be too long."""

from __future__ import annotations

from collections import Counter
from typing import Any, NamedTuple

from tandemlift.codegen.c.source import Unit
from tandemlift.codegen.c.types import Signature
from tandemlift.compiler.tracer import LEAVES, Graph
from tandemlift.compiler.tracer.structured import is_nested, nodes_of

MAX_OPERATIONS = 12  # operations in one expression


class Group(NamedTuple):
    """A nested value that the law calls by a name; `nodes`: of its numbers; `at`: the last of them."""

    name: str
    value: Any
    nodes: tuple[int, ...]
    at: int


class Variables:
    """The variables of a function.

    Args:
        unit: the file of C.
        graph: the graph that the function computes.
        roots: all nodes that will be needed.
        names: the local names of the law, and their values.

    Attributes:
        named: numbers that get a variable of their own.
        local: the law's name of a number.
        parts: the law's name of a result of a call, by the nodes of its numbers.
        groups: nested values that become structs.
    """

    def __init__(self, unit: Unit, graph: Graph, roots: list[int], names: dict[str, Any]) -> None:
        self.unit, self.graph = unit, graph
        self._needed = graph.needed(roots)
        self._first_use, self._uses = dict[int, int](), Counter(roots)
        self._count_uses()
        self.local: dict[int, str] = {}
        self.parts: dict[tuple[int, ...], str] = {}
        self.groups: list[Group] = []
        self._find_names(names)
        self._weights: dict[int, int] = {}
        self._owner = self._owners()
        self.named = self._find_named()

    def signature(self, call: int) -> Signature:
        """The signature of a called law."""
        return self.unit.signature(int(self.graph.ops[call][5:]))

    def is_operation(self, node: int) -> bool:
        """Whether a node is neither a leaf, nor a call, nor a result of one."""
        op = self.graph.ops[node]
        return op not in LEAVES and not op.startswith(("out ", "call "))

    def _count_uses(self) -> None:
        g = self.graph
        for node in self._needed:
            if g.ops[node] in LEAVES or g.ops[node].startswith("out "):
                continue
            for argument in g.args[node]:
                self._uses[argument] += 1
                self._first_use.setdefault(argument, node)

    def _find_names(self, names: dict[str, Any]) -> None:
        needed, known = set(self._needed), set[tuple[int, ...]]()
        for name, value in names.items():
            nodes = tuple(nodes_of(self.graph, value))
            if not nodes or not needed.issuperset(nodes):
                continue
            if not is_nested(value):
                self.local.setdefault(nodes[0], name)
            elif not hasattr(value, "_fields") or nodes in known:
                continue
            elif self._is_result(nodes):
                self.parts.setdefault(nodes, name)
            elif any(self.is_operation(n) for n in nodes):
                known.add(nodes)
                self.groups.append(Group(name, value, nodes, max(nodes)))
        self.groups.sort(key=lambda group: group.at)

    def _is_result(self, nodes: tuple[int, ...]) -> bool:
        """Whether numbers are consecutive results of one call."""
        g = self.graph
        if not all(g.ops[n].startswith("out ") for n in nodes) or len({g.args[n] for n in nodes}) > 1:
            return False
        first = int(g.ops[nodes[0]][4:])
        return [int(g.ops[n][4:]) for n in nodes] == list(range(first, first + len(nodes)))

    def _owners(self) -> dict[int, Group]:
        """The group that defines each operation: the first, unless one of its own numbers needs it before."""
        owner: dict[int, Group] = {}
        for group in self.groups:
            for node in group.nodes:
                if node not in owner and self.is_operation(node) and self._first_use.get(node, group.at + 1) > group.at:
                    owner[node] = group
        return owner

    def _find_named(self) -> set[int]:
        g, named = self.graph, set[int]()
        for node in self._needed:
            op, weight = g.ops[node], 0
            if op in LEAVES:
                continue
            if op.startswith("call "):
                weight = MAX_OPERATIONS // 2
            for argument in g.args[node]:
                weight += self._weights.get(argument, 0) + (not op.startswith("out "))
            heavy = weight > MAX_OPERATIONS or (self._uses[node] > 1 and not self._is_cheap(node))
            if (self.is_operation(node) or self._is_scalar_result(node)) and (heavy or node in self.local):
                named.add(node)
                weight = 0
            stands_alone = op.startswith("call ") and not self.signature(node).returns_number
            self._weights[node] = 0 if node in self._owner or stands_alone else weight
        return named - self._owner.keys()

    def _is_cheap(self, node: int) -> bool:
        g = self.graph
        return g.ops[node] == "fneg" and g.ops[g.args[node][0]] in LEAVES

    def _is_scalar_result(self, node: int) -> bool:
        op = self.graph.ops[node]
        return op.startswith("out ") and self.signature(self.graph.args[node][0]).returns_number
