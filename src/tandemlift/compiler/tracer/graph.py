"""A graph of operations on numbers, built by symbols when a law runs on them.

A node is (operation, arguments, type). Equal nodes are one node, so nothing is computed twice. Types: `f` a double, or
a float in a graph in single precision; `b` a truth, `i` a 64-bit integer, `w` the 32 bits of a float. A large set of
numbers is one node with a count.

Leaf i of lane l of `lanes` interleaved values (`core.types`) is a[i * lanes + l].
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Container, Iterable
from contextvars import ContextVar
from typing import Any

from tandemlift.compiler.tracer.refusal import refused_here
from tandemlift.compiler.tracer.symbol import Symbol
from tandemlift.core.types import is_value, leaves
from tandemlift.core.vector import each, is_set

MOST_NODES = 1_000_000
LEAVES = ("const", "in")
LAW: ContextVar[Callable[..., Any] | None] = ContextVar("law", default=None)  # the one that runs on symbols now


class Graph:
    """Nodes by number, in the order of their creation: arguments come first.

    `laws`: which law made each first. `uniform`: for kinds of inputs, whether each node depends on no other. `real`:
    the type of its numbers in machine code, "double" or "float".
    """

    def __init__(self, rolls_from: int = 0, real: str = "double") -> None:
        self.real = real
        self.ops: list[str] = []
        self.args: list[tuple[Any, ...]] = []
        self.types: list[str] = []
        self.counts: list[int] = []
        self.laws: list[Callable[..., Any] | None] = []
        self.rolls_from = rolls_from
        self.uniform: dict[frozenset[str], list[bool]] = {}
        self._known: dict[Any, int] = {}

    def node(self, op: str, args: tuple[Any, ...], kind: str, count: int = -1) -> int:
        """The number of a node; a new node unless an equal one exists. `count`: by default that of its arguments."""
        if count < 0:
            count = max([self.counts[a] for a in args]) if self.rolls_from and op not in LEAVES else 0
        key = (op, args, kind, count)
        found = self._known.get(key)
        if found is None:
            found = self._known[key] = len(self.ops)
            if found >= MOST_NODES:
                raise refused_here(f"makes more than {MOST_NODES:,} operations: write it with fewer")
            self.ops.append(op)
            self.args.append(args)
            self.types.append(kind)
            self.counts.append(count)
            self.laws.append(LAW.get())
        return found

    def needed(self, roots: Iterable[int], known: Container[int] = ()) -> list[int]:
        """The unknown nodes that roots need, in order, without those that only known nodes need."""
        seen, stack = set[int](), list(roots)
        while stack:
            node = stack.pop()
            if node in seen or node in known:
                continue
            seen.add(node)
            if self.ops[node] not in LEAVES:
                stack += self.args[node]
        return sorted(seen)

    def dependent(self, kinds: Container[str]) -> list[bool]:
        """For each node, whether it depends on an input of these kinds."""
        found = list[bool]()
        for op, args in zip(self.ops, self.args, strict=True):
            found.append(args[0] in kinds if op == "in" else op != "const" and any(found[a] for a in args))
        return found

    def input(self, kind: str, index: int = 0, type: str = "f") -> Symbol:
        """An input: a number that is known only when the graph is evaluated."""
        return Symbol(self, self.node("in", (kind, index), type), type)

    def inputs(self, kind: str, like: Any, first: int = 0) -> Any:
        """A nested value laid out like `like`, whose numbers are the inputs of a kind from `first` on."""
        if is_set(like) and 0 < self.rolls_from <= len(like):
            return Symbol(self, self.node("in", (kind, first), "f", len(like)), "f")
        if not is_value(like):
            return self.input(kind, first)
        parts = []
        for part in like:
            parts.append(self.inputs(kind, part, first))
            first += leaves(part)
        return type(like)(*parts)

    def pack(self, values: Any) -> int:
        """The number of the node of a set of numbers and symbols."""
        nodes = tuple([self.number(v) for v in values])
        sources = [(self.args[n][0], int(self.ops[n][4:])) if self.ops[n][:4] == "get " else (-1, 0) for n in nodes]
        source, first = sources[0]
        step = sources[1][1] - first if len(nodes) > 1 else 1
        if source >= 0 and sources == [(source, first + i * step) for i in range(len(nodes))]:
            return self.take(source, first, step, len(nodes))
        if all(self.ops[n] == "const" for n in nodes):
            return self.node("const", tuple(self.args[n][0] for n in nodes), "f", len(nodes))
        return self.node("pack", nodes, "f", len(nodes))

    def take(self, source: int, first: int, step: int, count: int) -> int:
        """The number of the node of some values of a set: `count` of them, from `first` on, every `step`."""
        if (first, step, count) == (0, 1, self.counts[source]):
            return source
        if self.ops[source].startswith("take "):
            at, pace = map(int, self.ops[source].split()[1:])
            return self.take(self.args[source][0], at + first * pace, step * pace, count)
        return self.node(f"take {first} {step}", (source,), "f", count)

    def get(self, source: int, at: int) -> int:
        """The number of the node of one value of a set."""
        if self.ops[source] == "pack":
            return self.args[source][at]
        if self.ops[source].startswith("take "):
            first, step = map(int, self.ops[source].split()[1:])
            return self.get(self.args[source][0], first + at * step)
        return self.node(f"get {at}", (source,), "f", 0)

    def constant(self, value: Any) -> int:
        """The number of the node of a constant."""
        if isinstance(value, bool):
            return self.node("const", (value,), "b")
        if isinstance(value, int) and -(1 << 63) <= value < 1 << 63:
            return self.node("const", (value,), "i")
        return self.node("const", (struct.pack("<d", float(value)),), "f")

    def number(self, value: Any) -> int:
        """The number of the node of a value as a double."""
        if isinstance(value, tuple):
            return self.pack(value)
        if not isinstance(value, Symbol):
            return self.constant(float(value))
        if value.type == "f":
            return value.node
        return self.node("sitofp" if value.type == "i" else "uitofp", (value.node,), "f")

    def truth(self, symbol: Symbol) -> bool:
        """Refuse a branch: the graph must hold for all data."""
        raise refused_here(
            "branches on data: choose by where(condition, a, b), minimum, maximum, clip of tandemlift.core.algebra"
        )

    def plain(self, symbol: Symbol, *, rounded: bool = False) -> float:
        """Refuse to give a number, which is known only when the graph is evaluated."""
        raise refused_here("takes a plain number out of its data: use the functions of tandemlift.core.algebra")

    def power(self, base: object, exponent: object) -> Any:
        """Refuse a power: NumPy and machine code would round it differently."""
        raise refused_here("takes a power by **: write a product, or power(x, p) of tandemlift.core.algebra")


def written_out(value: Any) -> Any:
    """A nested value whose sets are tuples of symbols instead of single symbols."""
    if isinstance(value, Symbol):
        return each(value.rolled)(*value) if value.rolled else value
    return type(value)(*map(written_out, value)) if is_value(value) else value


def laid_out(value: Any, like: Any) -> Any:
    """A nested value of a step in which a number stands for each of a set whose values are equal, as `like` it."""
    if not isinstance(like, tuple) or (isinstance(value, Symbol) and value.rolled):
        return value
    return type(like)(*map(laid_out, value if isinstance(value, tuple) else [value] * len(like), like))


def symbols(graph: Graph, value: Any) -> list[Symbol]:
    """The numbers of a nested value, or of a tuple of such, as symbols; constants too."""
    if isinstance(value, tuple) or (isinstance(value, Symbol) and value.rolled):
        return [s for part in value for s in symbols(graph, part)]
    return [Symbol(graph, graph.number(value), "f")]
