"""A graph as LLVM text: scalars for one flight, vectors of `lanes` numbers for a block of flights.

A `Function` is written from top to bottom: nodes by `values`, memory by `load` and `store`, loops and branches as
contexts. Values that are equal in all lanes (time, constants) stay scalars. Nodes written inside a loop or a branch are
known only there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from tandemlift.compiler.tracer.graph import LEAVES, Graph
from tandemlift.compiler.tracer.rolled import GraphText, Place, Sets
from tandemlift.compiler.tracer.symbol import Symbol
from tandemlift.compiler.tracer.text import BASE, Module, constant

BINARY = frozenset(["fadd", "fsub", "fmul", "fdiv", "add", "sub", "mul", "and", "or", "xor", "shl", "ashr"])
INTRINSICS = {"fma": "fma", "sqrt": "sqrt", "fabs": "fabs", "floor": "floor"}
CYCLES = {"fma": 4, "fmul": 3, "fadd": 3, "fsub": 3, "fdiv": 13, "sqrt": 20, "select": 2}  # approximate latency
Read = Callable[[int], "str | Place"]


class Function(GraphText):
    """One function over the nodes of a graph.

    Args:
        module: the module that it belongs to.
        graph: the graph whose nodes it computes.
        lanes: numbers in a value, one for each flight.
        head: its name and parameters, as in `i64 @fly(ptr %c)`.
        uniform: kinds of inputs that are equal in all lanes.

    Attributes:
        read: for each kind of input, a function from its index to its text or place.
        kept: nodes computed elsewhere before, each with a function to its text or place.
        sets: large sets of numbers.
    """

    def __init__(self, module: Module, graph: Graph, lanes: int, head: str, uniform: Iterable[str] = ()) -> None:
        super().__init__(module, lanes, head)
        self.graph, self.sets = graph, Sets(self)
        self.read: dict[str, Read] = {}
        self.kept: dict[int, Callable[[], str | Place]] = {}
        self._uniform_kinds, self._uniform = frozenset(uniform), list[bool]()
        self._values: dict[int, str] = {}
        self._spread: dict[int, str] = {}

    @contextmanager
    def scope(self) -> Iterator[None]:
        """A context after which the values computed inside are forgotten."""
        lengths = [(known, len(known)) for known in self._known]
        read = dict(self.read)
        yield
        for known, length in lengths:
            while len(known) > length:
                known.popitem()
        self.read = read

    @contextmanager
    def afresh(self) -> Iterator[None]:
        """A context that forgets earlier values, and afterwards those computed inside, because memory has changed."""
        before = self._values, self._spread, self.sets.places
        self._values, self._spread, self.sets.places = {}, {}, {}
        yield
        self._values, self._spread, self.sets.places = before

    @property
    def _known(self) -> tuple[dict[int, Any], ...]:
        return self._values, self._spread, self.sets.places

    def is_uniform(self, node: int) -> bool:
        """Whether a node has the same value in all lanes."""
        known, g = self._uniform, self.graph
        for i in range(len(known), len(g.ops)):
            if g.counts[i]:
                known.append(False)
            elif g.ops[i] in LEAVES:
                known.append(g.ops[i] == "const" or g.args[i][0] in self._uniform_kinds)
            else:
                known.append(all(known[a] for a in g.args[i]))
        return known[node]

    def values(self, symbols: Iterable[Symbol]) -> list[str]:
        """The values of symbols in all lanes, as text."""
        nodes = [s.node for s in symbols]
        self.write(nodes)
        return [self._operand(node, spread=True) for node in nodes]

    def value(self, symbol: Symbol) -> str:
        """The value of a symbol in all lanes, as text."""
        return self.values([symbol])[0]

    def scalar(self, symbol: Symbol) -> str:
        """The scalar of a symbol that is equal in all lanes, as text."""
        self.write([symbol.node])
        return self._operand(symbol.node, spread=False)

    def operand(self, node: int) -> str:
        """A number already computed in this function, in all lanes."""
        return self._operand(node, spread=True)

    def known(self) -> set[int]:
        """The nodes already computed in this function."""
        return {*self._values, *self.sets.places}

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

    def _missing(self, roots: list[int]) -> list[int]:
        g, seen = self.graph, set[int]()
        stack = list(roots)
        while stack:
            node = stack.pop()
            if node in seen or node in self._values or node in self.sets.places:
                continue
            seen.add(node)
            if not self.is_leaf(node):
                stack += g.args[node]
        return sorted(seen) if self.lanes > 1 or g.rolls_from else self._by_urgency(sorted(seen))

    def _by_urgency(self, nodes: list[int]) -> list[int]:
        """Nodes in the order of the longest chain of operations that depends on them, longest first."""
        g, urgency = self.graph, dict.fromkeys(nodes, 0)
        for node in reversed(nodes):
            if g.ops[node] not in LEAVES and node not in self.kept:
                after = urgency[node] + CYCLES.get(g.ops[node], 1)
                for argument in g.args[node]:
                    if argument in urgency and urgency[argument] < after:
                        urgency[argument] = after
        return sorted(nodes, key=lambda node: (-urgency[node], node))

    def is_leaf(self, node: int) -> bool:
        """Whether a node is available without its arguments."""
        return self.graph.ops[node] in LEAVES or node in self.kept

    def write(self, roots: list[int]) -> None:
        """Compute nodes and all their arguments."""
        nodes = self._missing(roots)
        if any(self.graph.counts[node] for node in nodes):
            self.sets.write(nodes, roots)
        else:
            for node in nodes:
                self.write_number(node)

    def write_number(self, node: int) -> None:
        """Compute a number whose arguments are already computed."""
        g = self.graph
        op, args = g.ops[node], g.args[node]
        if op == "const" or node in self._values:  # the reader of an input may compute other nodes
            return
        if op == "in":
            self._values[node] = self._text_of(self.read[args[0]](args[1]))
        elif node in self.kept:
            self._values[node] = self._text_of(self.kept[node]())
        elif op.startswith("get "):
            at = self.sets.places[args[0]]
            self._values[node] = self.load(at.base, self.integer("add", at.first, int(op[4:]) * at.stride))
        else:
            uniform = self.lanes > 1 and self.is_uniform(node)
            operands = [self._operand(a, not uniform) for a in args]
            self._values[node] = self.op(self.instruction(node, lambda t: self._kind(t, uniform), operands))

    def _text_of(self, given: str | Place) -> str:
        return self.load(given.base, given.first) if isinstance(given, Place) else given

    def put(self, base: str, at: str | int, symbols: Sequence[Symbol], kind: str = "") -> None:
        """Write numbers to consecutive memory, the values of a set in a loop.

        Everything is computed before anything is written. Inputs of `kind` are in place already.
        """
        self.sets.put(base, at, symbols, kind)

    def instruction(self, node: int, kind_of: Callable[[str], str], x: list[str]) -> str:
        """The instruction that computes a node from operands; `kind_of`: LLVM's name for a type of the graph."""
        g = self.graph
        op, kind = g.ops[node], kind_of(g.types[node])
        if op in BINARY:
            return f"{op} {kind} {x[0]}, {x[1]}"
        if op in INTRINSICS:
            return self._intrinsic(f"llvm.{INTRINSICS[op]}", kind, kind, x)
        given = kind_of(g.types[g.args[node][0]])
        if op == "select":
            return f"select {given} {x[0]}, {kind} {x[1]}, {kind} {x[2]}"
        if op[:4] in ("fcmp", "icmp"):
            return f"{op} {given} {x[0]}, {x[1]}"
        if op == "fneg":
            return f"fneg {kind} {x[0]}"
        if op == "fptosi":  # NaN gives 0, a number out of range the nearest integer
            return self._intrinsic("llvm.fptosi.sat", kind, given, x)
        if op in ("sitofp", "uitofp"):
            return f"{op} {given} {x[0]} to {kind}"
        return f"bitcast {given} {x[0]} to {kind}"

    def _intrinsic(self, name: str, result: str, given: str, x: list[str]) -> str:
        full = "@" + name + "".join(f".{_suffix(k)}" for k in dict.fromkeys((result, given)))
        self.module.declared.add(f"declare {result} {full}({', '.join([given] * len(x))})")
        return f"call {result} {full}({', '.join(f'{given} {v}' for v in x)})"


def _suffix(kind: str) -> str:
    """The name of a type in an LLVM function's name."""
    if kind.startswith("<"):
        count, _, base = kind[1:-1].partition(" x ")
        return f"v{count}{_suffix(base)}"
    return "f64" if kind == "double" else kind
