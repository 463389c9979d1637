"""A graph of scalar operations, and the symbols that build it when a law is run on them.

A node is (operation, arguments, type). Equal nodes are one node, so that what occurs twice is computed once. What
depends on constants alone is a number: additions, products, roots and fused operations are folded as IEEE 754 rounds
them. Types: `f` a double, `b` a truth, `i` a 64-bit integer.
"""

from __future__ import annotations

import math
import operator
import struct
import sys
from collections.abc import Container, Iterable
from fractions import Fraction
from pathlib import Path
from types import CodeType
from typing import Any

from tandemlift.errors import InputError
from tandemlift.trace.layout import is_value, leaves
from tandemlift.vector import each, is_set

MOST_NODES = 1_000_000
HERE = str(Path(__file__).parent)
OURS = str(Path(__file__).parent.parent)
LEAVES = ("const", "in")
NAMES = {"f": "a number", "b": "a truth", "i": "an integer"}


class TraceError(InputError):
    """A law cannot be traced: it asks a symbol for what only a number has."""


class Graph:
    """Nodes by number, in the order in which they were made: arguments come before what is made of them."""

    def __init__(self, rolls_from: int = 0) -> None:
        self.ops: list[str] = []
        self.args: list[tuple[Any, ...]] = []
        self.types: list[str] = []
        self.counts: list[int] = []
        self.rolls_from = rolls_from
        self._known: dict[Any, int] = {}

    def node(self, op: str, args: tuple[Any, ...], kind: str, count: int = -1) -> int:
        """The number of a node; a new one if there is none like it. `count`: that of its arguments, if not given."""
        if count < 0:
            count = max([self.counts[a] for a in args]) if self.rolls_from and op not in LEAVES else 0
        key = (op, args, kind, count)
        found = self._known.get(key)
        if found is None:
            found = self._known[key] = len(self.ops)
            if found >= MOST_NODES:
                raise _refused(f"makes more than {MOST_NODES:,} operations: write it for fewer")
            self.ops.append(op)
            self.args.append(args)
            self.types.append(kind)
            self.counts.append(count)
        return found

    def needed(self, roots: Iterable[int], known: Container[int] = ()) -> list[int]:
        """The nodes that roots need, in their order, and that are not known; what those alone need is left out."""
        seen, stack = set[int](), list(roots)
        while stack:
            node = stack.pop()
            if node in seen or node in known:
                continue
            seen.add(node)
            if self.ops[node] not in LEAVES:
                stack += self.args[node]
        return sorted(seen)

    def input(self, kind: str, index: int = 0, type: str = "f") -> Symbol:
        """A number that is given when the graph is evaluated."""
        return Symbol(self, self.node("in", (kind, index), type), type)

    def inputs(self, kind: str, like: Any, first: int = 0) -> Any:
        """A nested value laid out like `like` whose numbers are given, as inputs `first` and on of a kind."""
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


class Symbol:
    """A number that is not known yet, or a set of numbers where these are so many that loops serve them."""

    __slots__ = ("graph", "node", "type")
    __array_ufunc__ = None  # a NumPy scalar on the left defers to our operators
    __hash__ = object.__hash__

    def __init__(self, graph: Graph, node: int, type: str) -> None:
        self.graph, self.node, self.type = graph, node, type

    @property
    def rolled(self) -> int:
        """How many numbers it holds; 0 for one that is no set."""
        return self.graph.counts[self.node]

    def packed(self, value: Any) -> Any:
        """A set of values as one symbol, others as they are."""
        return Symbol(self.graph, self.graph.pack(value), "f") if is_set(value) else value

    def __len__(self) -> int:
        if not self.rolled:
            raise _refused("takes the length of a number")
        return self.rolled

    def __getitem__(self, which: Any) -> Any:
        count, graph = len(self), self.graph
        if isinstance(which, slice):
            first, _, step = which.indices(count)
            return Symbol(graph, graph.take(self.node, first, step, len(range(count)[which])), "f")
        return Symbol(graph, graph.get(self.node, range(count)[which]), "f")

    def __add__(self, other: Any) -> Any:
        return _arithmetic("fadd", "add", self, other)

    def __radd__(self, other: Any) -> Any:
        return _arithmetic("fadd", "add", other, self)

    def __sub__(self, other: Any) -> Any:
        return _arithmetic("fsub", "sub", self, other)

    def __rsub__(self, other: Any) -> Any:
        return _arithmetic("fsub", "sub", other, self)

    def __mul__(self, other: Any) -> Any:
        return _arithmetic("fmul", "mul", self, other)

    def __rmul__(self, other: Any) -> Any:
        return _arithmetic("fmul", "mul", other, self)

    def __truediv__(self, other: Any) -> Any:
        return _arithmetic("fdiv", "", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _arithmetic("fdiv", "", other, self)

    def __neg__(self) -> Any:
        return _made(self.graph, "fneg", self)

    def __pos__(self) -> Any:
        return self

    def __abs__(self) -> Any:
        return _made(self.graph, "fabs", self)

    def __lt__(self, other: Any) -> Any:
        return _compared("olt", "slt", self, other)

    def __le__(self, other: Any) -> Any:
        return _compared("ole", "sle", self, other)

    def __gt__(self, other: Any) -> Any:
        return _compared("ogt", "sgt", self, other)

    def __ge__(self, other: Any) -> Any:
        return _compared("oge", "sge", self, other)

    def __eq__(self, other: Any) -> Any:
        return _compared("oeq", "eq", self, other)

    def __ne__(self, other: Any) -> Any:
        return _compared("une", "ne", self, other)

    def __and__(self, other: Any) -> Any:
        return _bitwise("and", self, other)

    def __or__(self, other: Any) -> Any:
        return _bitwise("or", self, other)

    def __xor__(self, other: Any) -> Any:
        return _bitwise("xor", self, other)

    __rand__, __ror__, __rxor__ = __and__, __or__, __xor__

    def __invert__(self) -> Any:
        return _bitwise("xor", self, self.type == "b" or -1)

    def __lshift__(self, count: int) -> Any:
        return _bitwise("shl", self, count)

    def __rshift__(self, count: int) -> Any:
        return _bitwise("ashr", self, count)

    def __pow__(self, power: Any) -> Any:
        raise _refused("takes a power by **: write a product, or power(x, p) of tandemlift.ops")

    __rpow__ = __pow__

    def __bool__(self) -> bool:
        raise _refused("branches on data: choose by where(condition, a, b), minimum, maximum, clip of tandemlift.ops")

    def __float__(self) -> float:
        raise _refused("takes a plain number out of its data: use the functions of tandemlift.ops")

    __int__ = __index__ = __float__

    def __iter__(self) -> Any:
        if self.rolled:
            return (self[i] for i in range(self.rolled))
        raise _refused("takes a number apart as if it were a vector")


def written_out(value: Any) -> Any:
    """A nested value with its sets value by value, none as one symbol."""
    if isinstance(value, Symbol):
        return each(value.rolled)(*value) if value.rolled else value
    return type(value)(*map(written_out, value)) if is_value(value) else value


def symbols(graph: Graph, value: Any) -> list[Symbol]:
    """The numbers of a nested value, or of a tuple of such, as symbols, those that are known as well."""
    if isinstance(value, tuple) or (isinstance(value, Symbol) and value.rolled):
        return [s for part in value for s in symbols(graph, part)]
    return [Symbol(graph, graph.number(value), "f")]


def is_ours(code: CodeType) -> bool:
    """Whether a function is one of this package."""
    return code.co_filename.startswith(OURS)


def refused(what: str, code: CodeType, line: int) -> TraceError:
    """That a law cannot be traced: its file, line and name, why, and what is allowed."""
    way = "" if is_ours(code) else "; or register the controller with compiled=False"
    return TraceError(f"{code.co_filename}, line {line}: {code.co_name}() {what}{way}")


def _refused(what: str) -> TraceError:
    """That the innermost law that is being traced cannot be: of a user's own, the function that has it."""
    frame = sys._getframe(1)
    while frame.f_back and frame.f_code.co_filename.startswith(HERE):
        frame = frame.f_back
    innermost = frame
    while frame.f_back and is_ours(frame.f_code) and not frame.f_back.f_code.co_filename.startswith(HERE):
        frame = frame.f_back
    frame = frame if frame.f_back else innermost
    return refused(what, frame.f_code, frame.f_lineno)


def _graph_of(*values: Any) -> Graph:
    return next(v.graph for v in values if isinstance(v, Symbol))


def _is_whole(value: Any) -> bool:
    """Whether a value is an integer of integer arithmetic."""
    return value.type == "i" if isinstance(value, Symbol) else type(value) is int


def _node_of(graph: Graph, value: Any) -> int:
    """The node of a value in its own type."""
    if isinstance(value, tuple):
        return graph.pack(value)
    return value.node if isinstance(value, Symbol) else graph.constant(value)


def _type_of(value: Any) -> str:
    if isinstance(value, Symbol):
        return value.type
    return "b" if isinstance(value, bool) else "i" if isinstance(value, int) else "f"


def _is_operand(value: Any, other: Any) -> bool:
    """Whether a value can stand beside another: a number, or a set beside one that is a symbol."""
    if isinstance(value, tuple):
        return is_set(value) and isinstance(other, Symbol) and other.rolled == len(value)
    return isinstance(value, (Symbol, float, int)) or hasattr(value, "__float__")


def _arithmetic(op: str, whole: str, a: Any, b: Any) -> Any:
    if not (_is_operand(a, b) and _is_operand(b, a)):
        return NotImplemented
    graph = _graph_of(a, b)
    if whole and _is_whole(a) and _is_whole(b):
        return Symbol(graph, graph.node(whole, (_node_of(graph, a), _node_of(graph, b)), "i"), "i")
    if op in ("fmul", "fdiv") and not isinstance(b, Symbol) and b == 1.0:
        return a
    if op == "fmul" and not isinstance(a, Symbol) and a == 1.0:
        return b
    return _made(graph, op, a, b)


def _made(graph: Graph, op: str, *values: Any) -> Symbol:
    """A new double from doubles."""
    return Symbol(graph, graph.node(op, tuple([graph.number(v) for v in values]), "f"), "f")


def _compared(predicate: str, whole: str, a: Any, b: Any) -> Any:
    if not _is_operand(b, a):
        return NotImplemented
    graph = _graph_of(a, b)
    if _type_of(a) == _type_of(b) == "b" and whole in ("eq", "ne"):
        differs = _bitwise("xor", a, b)
        return differs if whole == "ne" else ~differs
    if _is_whole(a) and _is_whole(b):
        op, args = f"icmp {whole}", (_node_of(graph, a), _node_of(graph, b))
    else:
        op, args = f"fcmp {predicate}", (graph.number(a), graph.number(b))
    return Symbol(graph, graph.node(op, args, "b"), "b")


def _bitwise(op: str, a: Any, b: Any) -> Any:
    graph, kind = _graph_of(a, b), _type_of(a)
    if kind != _type_of(b) or kind == "f":
        raise _refused(f"joins {NAMES[kind]} and {NAMES[_type_of(b)]} bit by bit: only truths, or integers")
    return Symbol(graph, graph.node(op, (_node_of(graph, a), _node_of(graph, b)), kind), kind)


def select(condition: Any, a: Any, b: Any) -> Any:
    """a where the condition holds, else b."""
    if not isinstance(condition, Symbol):
        return a if condition else b
    graph = condition.graph
    test = condition if condition.type == "b" else condition != 0
    if a is b:
        return a
    kind = _type_of(a) if _type_of(a) == _type_of(b) and isinstance(a, Symbol) | isinstance(b, Symbol) else "f"
    if kind == "f" and isinstance(a, bool) and isinstance(b, bool):
        kind = "b"
    nodes = [graph.number(v) if kind == "f" else _node_of(graph, v) for v in (a, b)]
    if nodes[0] == nodes[1]:
        return a
    return Symbol(graph, graph.node("select", (test.node, *nodes), kind), kind)


def unary(op: str, x: Any) -> Any:
    """A root, a floor or an absolute value."""
    return _made(x.graph, op, x)


def converted(op: str, x: Any, kind: str) -> Any:
    """A value in another type: `bitcast` as it stands, `fptosi` cut to a whole number."""
    return Symbol(x.graph, x.graph.node(op, (x.node,), kind), kind)


def once_rounded(a: Any, b: Any, c: Any) -> Any:
    """a b + c of numbers or symbols, rounded once."""
    if any(isinstance(v, Symbol) for v in (a, b, c)):
        graph = _graph_of(a, b, c)
        if not any(isinstance(v, (Symbol, tuple)) for v in (a, b)) and _is_exact(a, b):
            return _made(graph, "fadd", a * b, c)
        return _made(graph, "fma", a, b, c)
    if all(isinstance(v, int) for v in (a, b, c)):
        return a * b + c
    if not (math.isfinite(a) and math.isfinite(b) and math.isfinite(c)):
        return c if math.isfinite(a) and math.isfinite(b) else a * b + c
    exact = Fraction(a) * Fraction(b) + Fraction(c)
    try:
        return float(exact) if exact else a * b + c
    except OverflowError:
        return math.inf if exact > 0 else -math.inf


def _is_exact(a: Any, b: Any) -> bool:
    """Whether a product of two numbers needs no rounding."""
    return math.isfinite(a * b) and Fraction(a) * Fraction(b) == Fraction(a * b)


def fma(a: Any, b: Any, c: Any) -> Any:
    """What a · b + c in the source of a law becomes: rounded once for numbers, field by field for linear values."""
    rolled = any(isinstance(v, Symbol) and v.rolled for v in (a, b, c))
    if not any(isinstance(v, tuple) and not (rolled and is_set(v)) for v in (a, b, c)):
        return once_rounded(a, b, c) if all(_type_of(v) != "b" for v in (a, b, c)) else operator.add(a * b, c)
    kind = type(c)
    fits = all(not isinstance(v, tuple) or type(v) is kind for v in (a, b))
    product = not isinstance(a, tuple) or not isinstance(b, tuple) or getattr(kind, "componentwise", False)
    if not (getattr(kind, "linear", False) and fits and product):
        return a * b + c
    columns = [v if isinstance(v, tuple) else (v,) * len(c) for v in (a, b)]
    return kind(*map(fma, *columns, c))
