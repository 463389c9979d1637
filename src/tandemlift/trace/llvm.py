"""A graph as text of LLVM's language: scalars for one flight, vectors of `lanes` numbers for as many flights.

A `Function` is written from top to bottom: nodes by `values`, memory by `load` and `store`, loops and branches as
contexts. What depends on the same numbers in all lanes (time, constants) stays a scalar. Nodes written inside a loop or
a branch are known there alone.
"""

from __future__ import annotations

import operator
import struct
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

from tandemlift.trace.graph import LEAVES, Graph, Symbol
from tandemlift.trace.rolled import Place, over, stages

BASE = {"f": "double", "b": "i1", "i": "i64"}
BINARY = frozenset(["fadd", "fsub", "fmul", "fdiv", "add", "sub", "mul", "and", "or", "xor", "shl", "ashr"])
INTRINSICS = {"fma": "fma", "sqrt": "sqrt", "fabs": "fabs", "floor": "floor"}
CYCLES = {"fma": 4, "fmul": 3, "fadd": 3, "fsub": 3, "fdiv": 13, "sqrt": 20, "select": 2}  # about, until the result
WIDE = '"prefer-vector-width"="512" "min-legal-vector-width"="512"'
ATTRIBUTES = [f"attributes #0 = {{ nounwind {WIDE} }}", f"attributes #1 = {{ nounwind noinline {WIDE} }}"]
WHOLE = {"add": operator.add, "mul": operator.mul}
Read = Callable[[int], "str | Place"]


class Module:
    """Functions, and what they declare."""

    def __init__(self) -> None:
        self.functions: list[str] = []
        self.declared: set[str] = set()

    @property
    def text(self) -> str:
        """All of it."""
        return "\n".join([*sorted(self.declared), *self.functions, *ATTRIBUTES]) + "\n"


class Part(NamedTuple):
    """A number that is written to memory as number `first`, or a set of `size` from there on."""

    first: int
    node: int
    size: int


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
        kept: nodes that were computed before, elsewhere, and how each is had here.
        room: gives memory for a set of so many numbers.
    """

    def __init__(self, module: Module, graph: Graph, lanes: int, head: str, uniform: Iterable[str] = ()) -> None:
        self.module, self.graph, self.lanes, self.head = module, graph, lanes, head
        self.vector = "double" if lanes == 1 else f"<{lanes} x double>"
        self.zero = "0.0" if lanes == 1 else "zeroinitializer"
        self.lines: list[str] = ["entry:"]
        self._rooms: list[str] = []
        self.read: dict[str, Read] = {}
        self.kept: dict[int, Callable[[], str | Place]] = {}
        self._uniform_kinds, self._uniform = frozenset(uniform), list[bool]()
        self.room: Callable[[int], Place] = self._room
        self._values: dict[int, str] = {}
        self._places: dict[int, Place] = {}
        self._spread: dict[int, str] = {}
        self._count = 0

    def end(self, result: str = "void") -> None:
        """Close the function and put it into its module."""
        self.do(f"ret {result}")
        begin, *lines = self.lines
        self.module.functions.append("\n".join([f"define {self.head} {{", begin, *self._rooms, *lines, "}"]))

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
        values, spread, places, read = len(self._values), len(self._spread), len(self._places), dict(self.read)
        yield
        while len(self._places) > places:
            self._places.popitem()
        while len(self._values) > values:
            self._values.popitem()
        while len(self._spread) > spread:
            self._spread.popitem()
        self.read = read

    @contextmanager
    def afresh(self) -> Iterator[None]:
        """What is computed before is not known within, nor what is computed within behind: memory has changed."""
        before = self._values, self._spread, self._places
        self._values, self._spread, self._places = {}, {}, {}
        yield
        self._values, self._spread, self._places = before

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

    def _room(self, count: int) -> Place:
        """Memory of the function's own, for a set of numbers."""
        name = f"%room{len(self._rooms)}"
        self._rooms.append(f"  {name} = alloca {self.vector}, i64 {count}, align 64")
        return Place(name, 0)

    def whole(self, op: str, a: str | int, b: str | int) -> str:
        """Arithmetic of 64-bit integers."""
        if op == "add" and (a == 0 or b == 0):
            return str(b if a == 0 else a)
        if op in WHOLE and isinstance(a, int) and isinstance(b, int):
            return str(WHOLE[op](a, b))
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
            if g.counts[i]:
                known.append(False)
            elif g.ops[i] in LEAVES:
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

    def operand(self, node: int) -> str:
        """A number that has been computed here, in all lanes."""
        return self._operand(node, spread=True)

    def known(self) -> set[int]:
        """The nodes that have been computed here."""
        return {*self._values, *self._places}

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
            if node in seen or node in self._values or node in self._places:
                continue
            seen.add(node)
            if not self.is_leaf(node):
                stack += g.args[node]
        return sorted(seen) if self.lanes > 1 or g.rolls_from else self._by_urgency(sorted(seen))

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

    def is_leaf(self, node: int) -> bool:
        """Whether a node is had here without its arguments."""
        return self.graph.ops[node] in LEAVES or node in self.kept

    def _write(self, roots: list[int]) -> None:
        nodes = self._missing(roots)
        if any(self.graph.counts[node] for node in nodes):
            self._write_stages(nodes, roots)
        else:
            for node in nodes:
                self._write_number(node)

    def _write_number(self, node: int) -> None:
        g = self.graph
        op, args = g.ops[node], g.args[node]
        if op == "const" or node in self._values:  # an input may be had from other nodes
            return
        if op == "in":
            self._values[node] = self._had(self.read[args[0]](args[1]))
        elif node in self.kept:
            self._values[node] = self._had(self.kept[node]())
        elif op.startswith("get "):
            at = self.place(args[0])
            self._values[node] = self.load(at.base, self.whole("add", at.first, int(op[4:]) * at.stride))
        else:
            uniform = self.is_uniform(node)
            operands = [self._operand(a, not uniform) for a in args]
            self._values[node] = self.op(self._instruction(node, lambda t: self._kind(t, uniform), operands))

    def _had(self, given: str | Place) -> str:
        return self.load(given.base, given.first) if isinstance(given, Place) else given

    # sets of many numbers

    def place(self, node: int) -> Place:
        """Where the values of a set stand."""
        return self._places[node]

    def _write_stages(self, nodes: list[int], roots: list[int]) -> None:
        g, stage_of = self.graph, stages(self, nodes)
        awaited = set(roots)
        for node in nodes:
            for argument in () if self.is_leaf(node) else g.args[node]:
                together = stage_of.get(argument), g.counts[argument]
                if together != (stage_of[node], g.counts[node]):
                    awaited.add(argument)
        sets: dict[tuple[int, int], list[int]] = {}
        numbers: dict[int, list[int]] = {}
        for node in nodes:
            if g.counts[node]:
                sets.setdefault((stage_of[node], g.counts[node]), []).append(node)
            else:
                numbers.setdefault(stage_of[node], []).append(node)
        for stage in range(1 + max(stage_of.values())):
            for node in numbers.get(stage, ()):
                self._write_number(node)
            for count in sorted(count for s, count in sets if s == stage):
                self._write_sets(sets[stage, count], count, awaited)

    def _write_sets(self, nodes: list[int], count: int, awaited: set[int]) -> None:
        """Sets of one size and one stage: those that are in memory, and a loop for those that are computed."""
        g, computed = self.graph, []
        for node in nodes:
            if node not in self._places and not self._finds(node, count):
                computed.append(node)
        if not computed:
            return
        waits = {node: self.room(count) for node in computed if node in awaited}
        with over(self, count) as loop:
            for node in computed:
                operands = [loop.operand(a) for a in g.args[node]]
                loop.values[node] = self.op(self._instruction(node, loop.kind, operands))
                if node in waits:
                    loop.leave(node, waits[node])
        self._places |= waits

    def _finds(self, node: int, count: int) -> bool:
        """Whether a set is in memory, or is put there number by number."""
        g = self.graph
        op, args = g.ops[node], g.args[node]
        if op == "const":
            self._places[node] = self._constant_set(args)
        elif op == "in" or node in self.kept:
            given = self.kept[node]() if node in self.kept else self.read[args[0]](args[1])
            assert isinstance(given, Place), f"a set of inputs {args} that is not in memory"
            self._places[node] = given
        elif op.startswith("take "):
            first, step = map(int, op.split()[1:])
            source = self.place(args[0])
            at = self.whole("add", source.first, first * source.stride)
            self._places[node] = Place(source.base, at, source.stride * step)
        elif op == "pack":
            self._places[node] = to = self.room(count)
            for i, argument in enumerate(args):
                self.store(self.operand(argument), to.base, self.whole("add", to.first, i))
        else:
            return False
        return True

    def _constant_set(self, values: tuple[bytes, ...]) -> Place:
        to = self.room(len(values))
        for i, value in enumerate(values):
            text = constant(value)
            self.store(text if self.lanes == 1 else f"splat (double {text})", to.base, self.whole("add", to.first, i))
        return to

    def put(self, base: str, at: str | int, symbols: Sequence[Symbol], kind: str = "") -> None:
        """Write numbers to memory, one behind the other, all values of a set in a loop.

        Everything is computed before anything is written. What is an input of `kind` is where it belongs already.
        """
        parts = [part for part in self._parts(symbols) if not self._stays(part, kind)]
        values = self.values(Symbol(self.graph, part.node, "f") for part in parts if not part.size)
        sources = [part.node for part in parts if part.size]
        self._write(sources)
        moved = {node: self._aside(node, base) for node in sources}
        numbers = iter(values)
        for part in parts:
            place = self.whole("add", at, part.first)
            if part.size:
                self._copy(moved[part.node], self.graph.counts[part.node], Place(base, place))
            else:
                self.store(next(numbers), base, place)

    def _parts(self, symbols: Sequence[Symbol]) -> Iterator[Part]:
        g, i = self.graph, 0
        while i < len(symbols):
            node = symbols[i].node
            source = g.args[node][0] if g.ops[node] == "get 0" else -1
            count = g.counts[source] if source >= 0 else 0
            whole = [s.node for s in symbols[i : i + count]] == [g.get(source, j) for j in range(count)]
            yield Part(i, source, count) if count and whole else Part(i, node, 0)
            i += max(count if whole else 0, 1)

    def _stays(self, part: Part, kind: str) -> bool:
        g = self.graph
        return g.ops[part.node] == "in" and g.args[part.node] == (kind, part.first)

    def _aside(self, node: int, base: str) -> Place:
        """Where a set can be copied from while the memory at `base` is written."""
        at, count = self.place(node), self.graph.counts[node]
        if at.base != base:
            return at
        to = self.room(count)
        self._copy(at, count, to)
        return to

    def _copy(self, source: Place, count: int, to: Place) -> None:
        with over(self, count) as loop:
            self.do(f"store {loop.kind('f')} {loop.loaded(source)}, ptr {loop.address(to)}, align 8")

    def _instruction(self, node: int, kind_of: Callable[[str], str], x: list[str]) -> str:
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
