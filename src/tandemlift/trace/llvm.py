"""A graph as text of LLVM's language: scalars for one flight, vectors of `lanes` numbers for as many flights.

A `Function` is written from top to bottom: nodes by `values`, memory by `load` and `store`, loops and branches as
contexts. What depends on the same numbers in all lanes (time, constants) stays a scalar. Nodes written inside a loop or
a branch are known there alone.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from tandemlift.trace.graph import LEAVES, Graph, Symbol

BASE = {"f": "double", "b": "i1", "i": "i64"}
BINARY = frozenset(["fadd", "fsub", "fmul", "fdiv", "add", "sub", "mul", "and", "or", "xor", "shl", "ashr"])
INTRINSICS = {"fma": "fma", "sqrt": "sqrt", "fabs": "fabs", "floor": "floor"}
CYCLES = {"fma": 4, "fmul": 3, "fadd": 3, "fsub": 3, "fdiv": 13, "sqrt": 20, "select": 2}  # about, until the result
WIDE = '"prefer-vector-width"="512" "min-legal-vector-width"="512"'
ATTRIBUTES = [f"attributes #0 = {{ nounwind {WIDE} }}", f"attributes #1 = {{ nounwind noinline {WIDE} }}"]
Read = Callable[[int], str]


class Module:
    """Functions, and what they declare."""

    def __init__(self) -> None:
        self.functions: list[str] = []
        self.declared: set[str] = set()

    @property
    def text(self) -> str:
        """All of it."""
        return "\n".join([*sorted(self.declared), *self.functions, *ATTRIBUTES]) + "\n"


class Function:
    """One function over the nodes of a graph.

    Args:
        module: where it goes.
        graph: whose nodes it computes.
        lanes: how many numbers a value holds, one for each flight.
        head: its name and parameters, as in `i64 @fly(ptr %c)`.
        uniform: kinds of inputs that are the same in all lanes.

    Attributes:
        read: for each kind of input, how an input of that kind is had here.
        kept: nodes that wait in memory, and where: computed before, elsewhere.
    """

    def __init__(self, module: Module, graph: Graph, lanes: int, head: str, uniform: Iterable[str] = ()) -> None:
        self.module, self.graph, self.lanes, self.head = module, graph, lanes, head
        self.vector = "double" if lanes == 1 else f"<{lanes} x double>"
        self.zero = "0.0" if lanes == 1 else "zeroinitializer"
        self.lines: list[str] = ["entry:"]
        self.read: dict[str, Read] = {}
        self.kept: dict[int, Callable[[], str]] = {}
        self._uniform_kinds, self._uniform = frozenset(uniform), list[bool]()
        self._values: dict[int, str] = {}
        self._spread: dict[int, str] = {}
        self._count = 0

    def end(self, result: str = "void") -> None:
        """Close the function and put it into its module."""
        self.do(f"ret {result}")
        self.module.functions.append("\n".join([f"define {self.head} {{", *self.lines, "}"]))

    # text

    def do(self, text: str) -> None:
        """An instruction without a result."""
        self.lines.append("  " + text)

    def op(self, text: str) -> str:
        """An instruction's result."""
        self._count += 1
        self.lines.append(f"  %v{self._count} = {text}")
        return f"%v{self._count}"

    def label(self, name: str) -> str:
        """Begin a block, which what stands before runs into."""
        self.do(f"br label %{name}")
        self.lines.append(f"{name}:")
        return name

    def fresh(self, name: str) -> str:
        """A name for a block that is used nowhere else."""
        self._count += 1
        return f"{name}{self._count}"

    # control

    @contextmanager
    def scope(self) -> Iterator[None]:
        """What is computed within is not known behind."""
        values, spread, read = len(self._values), len(self._spread), dict(self.read)
        yield
        while len(self._values) > values:
            self._values.popitem()
        while len(self._spread) > spread:
            self._spread.popitem()
        self.read = read

    @contextmanager
    def afresh(self) -> Iterator[None]:
        """What is computed before is not known within, nor what is computed within behind: memory has changed."""
        values, spread = self._values, self._spread
        self._values, self._spread = {}, {}
        yield
        self._values, self._spread = values, spread

    @contextmanager
    def repeat(self, count: str | int, first: str | int = 0) -> Iterator[str]:
        """A loop from `first` to `count` − 1, whose body hands on nothing but what it writes to memory."""
        head, body, done = self.fresh("head"), self.fresh("body"), self.fresh("done")
        i = f"%i{self._count}"
        before = self.label(self.fresh("before"))
        self.label(head)
        self.do(f"{i} = phi i64 [ {first}, %{before} ], [ {i}n, %{body}e ]")
        goes_on = self.op(f"icmp slt i64 {i}, {count}")
        self.do(f"br i1 {goes_on}, label %{body}, label %{done}")
        self.lines.append(f"{body}:")
        with self.scope():
            yield i
        self.label(f"{body}e")
        self.do(f"{i}n = add i64 {i}, 1")
        self.do(f"br label %{head}")
        self.lines.append(f"{done}:")

    @contextmanager
    def when(self, condition: str) -> Iterator[None]:
        """A branch that hands on nothing but what it writes to memory."""
        yes, done = self.fresh("yes"), self.fresh("done")
        self.do(f"br i1 {condition}, label %{yes}, label %{done}")
        self.lines.append(f"{yes}:")
        with self.scope():
            yield
        self.label(done)

    def any(self, truth: str) -> str:
        """Whether something holds in any lane."""
        if self.lanes == 1:
            return truth
        name = f"@llvm.vector.reduce.or.v{self.lanes}i1"
        self.module.declared.add(f"declare i1 {name}(<{self.lanes} x i1>)")
        return self.op(f"call i1 {name}(<{self.lanes} x i1> {truth})")

    # memory

    def at(self, base: str, index: str | int, kind: str = "") -> str:
        """The place of a value in memory."""
        return self.op(f"getelementptr {kind or self.vector}, ptr {base}, i64 {index}")

    def load(self, base: str, index: str | int = 0, kind: str = "") -> str:
        """A value of all lanes from memory, or of another kind (`double`, `i64`, `ptr`)."""
        return self.op(f"load {kind or self.vector}, ptr {self.at(base, index, kind)}, align 8")

    def store(self, value: str, base: str, index: str | int = 0, kind: str = "") -> None:
        """Write a value of all lanes, or of another kind."""
        self.do(f"store {kind or self.vector} {value}, ptr {self.at(base, index, kind)}, align 8")

    def whole(self, op: str, a: str | int, b: str | int) -> str:
        """Arithmetic of 64-bit integers."""
        return self.op(f"{op} i64 {a}, {b}")

    def call(self, result: str, name: str, *arguments: str, types: Iterable[str]) -> str:
        """A call of one of LLVM's own functions."""
        self.module.declared.add(f"declare {result} {name}({', '.join(types)})")
        given = ", ".join(f"{t} {a}" for t, a in zip(types, arguments, strict=True))
        return self.op(f"call {result} {name}({given})")

    # nodes

    def is_uniform(self, node: int) -> bool:
        """Whether a node has the same value in all lanes."""
        known, g = self._uniform, self.graph
        for i in range(len(known), len(g.ops)):
            if g.ops[i] in LEAVES:
                known.append(g.ops[i] == "const" or g.args[i][0] in self._uniform_kinds)
            else:
                known.append(all(known[a] for a in g.args[i]))
        return known[node]

    def values(self, symbols: Iterable[Symbol]) -> list[str]:
        """What symbols are, in all lanes."""
        nodes = [s.node for s in symbols]
        self._write(nodes)
        return [self._operand(node, spread=True) for node in nodes]

    def value(self, symbol: Symbol) -> str:
        """What a symbol is, in all lanes."""
        return self.values([symbol])[0]

    def scalar(self, symbol: Symbol) -> str:
        """What a symbol is that has the same value in all lanes."""
        self._write([symbol.node])
        return self._operand(symbol.node, spread=False)

    def known(self) -> set[int]:
        """The nodes that have been computed here."""
        return set(self._values)

    def _kind(self, type: str, uniform: bool) -> str:
        return BASE[type] if uniform or self.lanes == 1 else f"<{self.lanes} x {BASE[type]}>"

    def _operand(self, node: int, spread: bool) -> str:
        g = self.graph
        if g.ops[node] == "const":
            text = constant(g.args[node][0])
            return f"splat ({BASE[g.types[node]]} {text})" if spread and self.lanes > 1 else text
        if spread and self.lanes > 1 and self.is_uniform(node):
            if node not in self._spread:
                self._spread[node] = self.spread(self._values[node], BASE[g.types[node]])
            return self._spread[node]
        return self._values[node]

    def spread(self, value: str, base: str = "double") -> str:
        """A scalar in all lanes."""
        if self.lanes == 1:
            return value
        kind = f"<{self.lanes} x {base}>"
        first = self.op(f"insertelement {kind} poison, {base} {value}, i64 0")
        return self.op(f"shufflevector {kind} {first}, {kind} poison, <{self.lanes} x i32> zeroinitializer")

    def _missing(self, roots: list[int]) -> list[int]:
        g, seen = self.graph, set[int]()
        stack = list(roots)
        while stack:
            node = stack.pop()
            if node in seen or node in self._values:
                continue
            seen.add(node)
            if g.ops[node] not in LEAVES and node not in self.kept:
                stack += g.args[node]
        return sorted(seen) if self.lanes > 1 else self._by_urgency(sorted(seen))

    def _by_urgency(self, nodes: list[int]) -> list[int]:
        """Nodes in an order in which those come first whose consequences take longest."""
        g, urgency = self.graph, dict.fromkeys(nodes, 0)
        for node in reversed(nodes):
            if g.ops[node] not in LEAVES and node not in self.kept:
                after = urgency[node] + CYCLES.get(g.ops[node], 1)
                for argument in g.args[node]:
                    if argument in urgency and urgency[argument] < after:
                        urgency[argument] = after
        return sorted(nodes, key=lambda node: (-urgency[node], node))

    def _write(self, roots: list[int]) -> None:
        g = self.graph
        for node in self._missing(roots):
            op, args = g.ops[node], g.args[node]
            if op == "const" or node in self._values:  # an input may be had from other nodes
                continue
            if op == "in":
                self._values[node] = self.read[args[0]](args[1])
            elif node in self.kept:
                self._values[node] = self.kept[node]()
            else:
                uniform = self.is_uniform(node)
                operands = [self._operand(a, not uniform) for a in args]
                self._values[node] = self.op(self._instruction(node, uniform, operands))

    def _instruction(self, node: int, uniform: bool, x: list[str]) -> str:
        g = self.graph
        op, kind = g.ops[node], self._kind(g.types[node], uniform)
        if op in BINARY:
            return f"{op} {kind} {x[0]}, {x[1]}"
        if op in INTRINSICS:
            return self._intrinsic(f"llvm.{INTRINSICS[op]}", kind, kind, x)
        given = self._kind(g.types[g.args[node][0]], uniform)
        if op == "select":
            return f"select {given} {x[0]}, {kind} {x[1]}, {kind} {x[2]}"
        if op[:4] in ("fcmp", "icmp"):
            return f"{op} {given} {x[0]}, {x[1]}"
        if op == "fneg":
            return f"fneg {kind} {x[0]}"
        if op == "fptosi":  # a number that is none gives 0, one that is too large the largest
            return self._intrinsic("llvm.fptosi.sat", kind, given, x)
        if op in ("sitofp", "uitofp"):
            return f"{op} {given} {x[0]} to {kind}"
        return f"bitcast {given} {x[0]} to {kind}"

    def _intrinsic(self, name: str, result: str, given: str, x: list[str]) -> str:
        full = "@" + name + "".join(f".{_suffix(k)}" for k in dict.fromkeys((result, given)))
        self.module.declared.add(f"declare {result} {full}({', '.join([given] * len(x))})")
        return f"call {result} {full}({', '.join(f'{given} {v}' for v in x)})"


def _suffix(kind: str) -> str:
    """What LLVM calls a type in the name of a function."""
    if kind.startswith("<"):
        count, _, base = kind[1:-1].partition(" x ")
        return f"v{count}{_suffix(base)}"
    return "f64" if kind == "double" else kind


def constant(value: Any) -> str:
    """A constant of the graph as text."""
    if isinstance(value, bytes):
        return f"0x{struct.unpack('<Q', value)[0]:016X}"
    return str(value).lower()


def double(value: float) -> str:
    """A number as text, to the last bit."""
    return constant(struct.pack("<d", value))
