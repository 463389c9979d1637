"""A graph as LLVM text: scalars for one flight, vectors of `lanes` numbers for a block of flights.

A `Function` is written from top to bottom: nodes by `values`, memory by `load` and `store`, loops and branches as
contexts. Values that are equal in all lanes (time, constants) stay scalars. Nodes written inside a loop or a branch are
known only there.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from tandemlift.compiler.tracer.graph import LEAVES, Graph
from tandemlift.compiler.tracer.order import NumbersInMemory, best_order, urgency
from tandemlift.compiler.tracer.rolled import Sets
from tandemlift.compiler.tracer.symbol import Symbol
from tandemlift.compiler.tracer.text import Module, Place, Text, constant

BINARY = frozenset(["fadd", "fsub", "fmul", "fdiv", "add", "sub", "mul", "and", "or", "xor", "shl", "ashr"])
INTRINSICS = ("fma", "sqrt", "fabs", "floor")
NOWHERE = Place("", 0)
Read = Callable[[int], "str | Place"]


class Function(Text):
    """One function over the nodes of a graph.

    Args:
        module: the module that it belongs to.
        graph: the graph whose nodes it computes.
        lanes: numbers in a value, one for each flight.
        head: its name and parameters, as in `i64 @fly(ptr %c)`.
        uniform: kinds of inputs that are equal in all lanes, or single ones as (kind, index), whose number stands in
            the first place of its vector in memory.

    Attributes:
        same: inputs that are computed in this function, each with the node that computes it.
        sets: large sets of numbers.
        orders: whether nodes are written in an order of few waiting values, and memory is read where it is used.
        seldom: whether what is written now runs seldom, and needs no other order than that of creation.
    """

    def __init__(self, module: Module, graph: Graph, lanes: int, head: str, uniform: Iterable[Any] = ()) -> None:
        super().__init__(module, graph, lanes, head)
        self.sets, self.orders = Sets(self), lanes > 1 and not graph.rolls_from
        self.same, self.seldom = dict[int, int](), False
        self._uniform_kinds = frozenset(uniform)
        self._uniform = graph.uniform.setdefault(self._uniform_kinds, [])
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
                known.append(g.ops[i] == "const" or not self._uniform_kinds.isdisjoint((g.args[i][0], g.args[i])))
            else:
                known.append(all(known[a] for a in g.args[i]))
        return known[node]

    def values(self, symbols: Iterable[Symbol]) -> list[str]:
        """The values of symbols in all lanes, as text."""
        nodes = [s.node for s in symbols]
        self.write(nodes)
        return [self.operand(node) for node in nodes]

    def value(self, symbol: Symbol) -> str:
        """The value of a symbol in all lanes, as text."""
        return self.values([symbol])[0]

    def scalar(self, symbol: Symbol) -> str:
        """The scalar of a symbol that is equal in all lanes, as text."""
        self.write([symbol.node])
        return self.operand(symbol.node, spread=False)

    def known(self) -> set[int]:
        """The nodes already computed in this function."""
        return {*self._values, *self.sets.places}

    def _kind(self, type: str, uniform: bool) -> str:
        return self.base[type] if uniform or self.lanes == 1 else f"<{self.lanes} x {self.base[type]}>"

    def operand(self, node: int, *, spread: bool = True) -> str:
        """A number already computed in this function, in all lanes, or as a scalar that is equal in all."""
        g, node = self.graph, self.same.get(node, node)
        if g.ops[node] == "const":
            text = constant(g.args[node][0], self.real)
            return f"splat ({self.base[g.types[node]]} {text})" if spread and self.lanes > 1 else text
        alike, base = self.lanes > 1 and self.is_uniform(node), self.base[g.types[node]]
        if node not in self._values:  # read where it is used, each time anew
            text = self._text_of(self._given(node), base if alike else self.vector)
            return self.spread(text, base) if alike and spread else text
        if not (alike and spread):
            return self._values[node]
        if node not in self._spread:
            self._spread[node] = self.spread(self._values[node], base)
        return self._spread[node]

    def _given(self, node: int) -> str | Place:
        if node in self.kept:
            return self.kept[node]()
        kind, index = self.graph.args[node]
        return self.read[kind](index)

    def _missing(self, roots: Iterable[int]) -> list[int]:
        seen, stack = set[int](), list(roots)
        while stack:
            node = stack.pop()
            node = self.same.get(node, node)
            if node in seen or node in self._values or node in self.sets.places:
                continue
            seen.add(node)
            if not self.is_leaf(node):
                stack += self.graph.args[node]
        return sorted(seen)

    def _operands(self, nodes: list[int]) -> dict[int, Sequence[int]]:
        """Each of some nodes with those among them that it needs; leaves need none."""
        among, args, same = set(nodes), self.graph.args, self.same
        return {
            n: [] if self.is_leaf(n) else [a for a in dict.fromkeys(same.get(a, a) for a in args[n]) if a in among]
            for n in nodes
        }

    def is_leaf(self, node: int) -> bool:
        """Whether a node is available without its arguments."""
        return self.graph.ops[node] in LEAVES or node in self.kept

    def write(self, roots: list[int]) -> None:
        """Compute nodes and all their arguments."""
        nodes = self._missing(roots)
        if any(self.graph.counts[node] for node in nodes):
            self.sets.write(nodes, roots)
        elif self.orders:
            self._write_ordered(nodes, NumbersInMemory([], "", roots))
        else:
            if self.lanes == 1 and not self.graph.rolls_from:
                after = urgency(self.graph, self._operands(nodes))
                nodes.sort(key=lambda node: (-after[node], node))
            for node in nodes:
                self.write_number(node)

    def _write_ordered(self, nodes: list[int], to: NumbersInMemory, base: Place = NOWHERE) -> None:
        """Write nodes in an order of few waiting values, and numbers to memory as soon as that is possible."""
        work = [node for node in nodes if not self.is_leaf(node)]
        for node in set(nodes).difference(work):
            if self.graph.args[node][0] in self._uniform_kinds:
                self.write_number(node)
        operands = dict.fromkeys(work, ()) if self.seldom else self._operands(work)
        order, stores = best_order(self.graph, operands, to, self.same, seldom=self.seldom)
        for place, node in enumerate([-1, *order], -1):
            if node >= 0:
                self.write_number(node)
            for i, value in [(i, self.operand(to.numbers[i])) for i in stores.get(place, ())]:
                self.store(value, base.base, self.offset(base, i))

    def hold(self, nodes: Iterable[int]) -> None:
        """Read inputs now, whatever is written to memory later."""
        self._values |= {node: self.operand(node, spread=False) for node in nodes}

    def update(
        self,
        base: str,
        at: str | int,
        symbols: Sequence[Symbol],
        kind: str = "",
        more: Sequence[Symbol] = (),
        done: set[int] | None = None,
        later: Sequence[Symbol] = (),
        unknown: Container[str] = (),
        stride: str | int = 1,
    ) -> None:
        """Write numbers to memory, one every `stride` places, where the inputs of `kind` stand, and none of the others.

        In a block, each is written as soon as nothing reads the old one any more. `more` are computed too. `done` holds
        the places of numbers written before, and gets theirs. While kinds of input are `unknown`, only those numbers
        are written that need none of them, and replace nothing that `later` will read.
        """
        if not self.orders:
            if more:
                self.values([*symbols, *more])
            self.put(base, at, symbols, kind, stride)
            return
        g, done, late = self.graph, set() if done is None else done, set[int]()
        numbers, also = ([self.same.get(s.node, s.node) for s in given] for given in (symbols, more))
        if unknown:
            depends = g.dependent(unknown)
            late = {i for i, n in enumerate(numbers) if depends[n]}
        nodes = self._missing([*[n for i, n in enumerate(numbers) if i not in late | done], *also])
        if unknown:
            known = {n for n in nodes if not self.is_leaf(n)} | self.known() | self.kept.keys()
            read = [g.args[n] for n in g.needed([s.node for s in later], known) if g.ops[n] == "in"]
            late |= {i for of, i in read if of == kind}
        self._write_ordered(nodes, NumbersInMemory(numbers, kind, also, late | done), Place(base, at, stride))
        done |= set(range(len(numbers))) - late

    def write_number(self, node: int) -> None:
        """Compute a number whose arguments are already computed."""
        g = self.graph
        op, args = g.ops[node], g.args[node]
        if op == "const" or node in self._values:  # the reader of an input may compute other nodes
            return
        if self.is_leaf(node):
            self._values[node] = self.operand(node, spread=False)
        elif op.startswith("get "):
            at = self.sets.places[args[0]]
            self._values[node] = self.load(at.base, self.integer("add", at.first, int(op[4:]) * at.stride))
        else:
            uniform = self.lanes > 1 and self.is_uniform(node)
            operands = [self.operand(a, spread=not uniform) for a in args]
            self._values[node] = self.op(self.instruction(node, lambda t: self._kind(t, uniform), operands))

    def _text_of(self, given: str | Place, kind: str) -> str:
        if not isinstance(given, Place):
            return given
        return self.load(
            given.base, given.first if kind == self.vector else self.integer("mul", given.first, self.lanes), kind
        )

    def put(self, base: str, at: str | int, symbols: Sequence[Symbol], kind: str = "", stride: str | int = 1) -> None:
        """Write numbers to memory, one every `stride` places, the values of a set in a loop.

        Everything is computed before anything is written. Inputs of `kind` are in place already.
        """
        self.sets.put(Place(base, at, stride), symbols, kind)

    def instruction(self, node: int, kind_of: Callable[[str], str], x: list[str]) -> str:
        """The instruction that computes a node from operands; `kind_of`: LLVM's name for a type of the graph."""
        g = self.graph
        op, kind = g.ops[node], kind_of(g.types[node])
        if op in BINARY:
            return f"{op} {kind} {x[0]}, {x[1]}"
        if op in INTRINSICS:
            return self._intrinsic(f"llvm.{op}", kind, kind, x)
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
    return {"double": "f64", "float": "f32"}.get(kind, kind)
