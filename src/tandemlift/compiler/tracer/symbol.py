"""Symbols: numbers that are not known yet. Operations on them are written into a graph.

Operations on constants alone are folded, rounded as IEEE 754 says.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import Any, ClassVar, Protocol

from tandemlift.compiler.tracer.refusal import refused_here
from tandemlift.core.vector import is_set

NAMES = {"f": "a number", "b": "a truth", "i": "an integer"}


class Nodes(Protocol):
    """The interface of a `Graph` for the symbols of its nodes; each method returns the number of a node."""

    counts: list[int]
    real: str

    def node(self, op: str, args: tuple[Any, ...], kind: str, count: int = -1) -> int:
        """The node of an operation."""

    def pack(self, values: Any) -> int:
        """The node of a set of numbers and symbols."""

    def take(self, source: int, first: int, step: int, count: int) -> int:
        """The node of some values of a set."""

    def get(self, source: int, at: int) -> int:
        """The node of one value of a set."""

    def constant(self, value: object) -> int:
        """The node of a constant."""

    def number(self, value: object) -> int:
        """The node of a value as a double."""

    def truth(self, symbol: Any) -> bool:
        """Whether a symbol holds, where a branch depends on it."""

    def plain(self, symbol: Any, *, rounded: bool = False) -> float:
        """The value of a symbol where Python needs a plain number, or one to round to a whole number."""

    def power(self, base: object, exponent: object) -> Any:
        """A power, written as `**`, of which the base or the exponent is a symbol."""


def _operators(op: str, whole: str) -> Any:
    """An operator with a symbol on its left, and one with it on its right; `whole`: the operation of two integers."""
    return (
        lambda symbol, other: _arithmetic(op, whole, symbol, other),
        lambda symbol, other: _arithmetic(op, whole, other, symbol),
    )


def _comparison(predicate: str, whole: str) -> Any:
    return lambda symbol, other: _compared(predicate, whole, symbol, other)


def _of_bits(op: str) -> Any:
    return lambda symbol, other: _bitwise(op, symbol, other)


class Symbol:
    """A number that is not known yet, or a large set of such numbers, which machine code handles in loops."""

    __slots__ = ("graph", "node", "type")
    functions: ClassVar[
        ModuleType
    ]  # elementary functions of symbols, for `core.algebra`; set by `compiler.tracer.elementary`
    __array_ufunc__ = None  # a NumPy scalar on the left defers to our operators
    __hash__ = object.__hash__

    def __init__(self, graph: Nodes, node: int, type: str) -> None:
        self.graph, self.node, self.type = graph, node, type

    @property
    def rolled(self) -> int:
        """Size of the set; 0 for a single number."""
        return self.graph.counts[self.node]

    def packed(self, value: object) -> Any:
        """A set of values as one symbol; any other value unchanged."""
        return Symbol(self.graph, self.graph.pack(value), "f") if is_set(value) else value

    def __len__(self) -> int:
        if not self.rolled:
            raise refused_here("takes the length of a number")
        return self.rolled

    def __getitem__(self, which: int | slice) -> Symbol:
        count, graph = len(self), self.graph
        if isinstance(which, slice):
            first, _, step = which.indices(count)
            return Symbol(graph, graph.take(self.node, first, step, len(range(count)[which])), "f")
        return Symbol(graph, graph.get(self.node, range(count)[which]), "f")

    __add__, __radd__ = _operators("fadd", "add")
    __sub__, __rsub__ = _operators("fsub", "sub")
    __mul__, __rmul__ = _operators("fmul", "mul")
    __truediv__, __rtruediv__ = _operators("fdiv", "")
    __lt__, __le__ = _comparison("olt", "slt"), _comparison("ole", "sle")
    __gt__, __ge__ = _comparison("ogt", "sgt"), _comparison("oge", "sge")
    __eq__, __ne__ = _comparison("oeq", "eq"), _comparison("une", "ne")

    def __neg__(self) -> Symbol:
        return made(self.graph, "fneg", self)

    def __pos__(self) -> Symbol:
        return self

    def __abs__(self) -> Symbol:
        return made(self.graph, "fabs", self)

    __and__, __or__, __xor__ = _of_bits("and"), _of_bits("or"), _of_bits("xor")
    __rand__, __ror__, __rxor__ = __and__, __or__, __xor__
    __lshift__, __rshift__ = _of_bits("shl"), _of_bits("ashr")

    def __invert__(self) -> Symbol:
        return _bitwise("xor", self, self.type == "b" or -1)

    def __pow__(self, power: object) -> Any:
        return self.graph.power(self, power)

    def __rpow__(self, base: object) -> Any:
        return self.graph.power(base, self)

    def __bool__(self) -> bool:
        return self.graph.truth(self)

    def __float__(self) -> float:
        return self.graph.plain(self)

    def __int__(self) -> int:
        return int(self.graph.plain(self, rounded=True))

    __index__ = __trunc__ = __int__

    def __round__(self, digits: int | None = None) -> float:
        return round(self.graph.plain(self, rounded=True), digits)

    def __iter__(self) -> Iterator[Symbol]:
        if self.rolled:
            return (self[i] for i in range(self.rolled))
        raise refused_here("takes a number apart as if it were a vector")


def graph_of(*values: object) -> Nodes:
    """The graph of the symbols among some values."""
    return next(v.graph for v in values if isinstance(v, Symbol))


def _is_integer(value: object) -> bool:
    """Whether a value is an integer of integer arithmetic."""
    return value.type == "i" if isinstance(value, Symbol) else type(value) is int


def _node_of(graph: Nodes, value: object) -> int:
    """The node of a value in its own type."""
    if isinstance(value, tuple):
        return graph.pack(value)
    return value.node if isinstance(value, Symbol) else graph.constant(value)


def type_of(value: object) -> str:
    """The type of a value in a graph: `f`, `b` or `i`."""
    if isinstance(value, Symbol):
        return value.type
    return "b" if isinstance(value, bool) else "i" if isinstance(value, int) else "f"


def _is_operand(value: object, other: object) -> bool:
    """Whether a value can be an operand next to another: a number, or a set next to a symbol of equal size."""
    if isinstance(value, tuple):
        return is_set(value) and isinstance(other, Symbol) and other.rolled == len(value)
    if isinstance(value, (Symbol, float, int)):
        return True
    return hasattr(value, "__float__") and not getattr(value, "ndim", 0)


def _arithmetic(op: str, whole: str, a: object, b: object) -> Any:
    if not (_is_operand(a, b) and _is_operand(b, a)):
        return _with_array(op, whole, a, b)
    graph = graph_of(a, b)
    if whole and _is_integer(a) and _is_integer(b):
        return Symbol(graph, graph.node(whole, (_node_of(graph, a), _node_of(graph, b)), "i"), "i")
    if op in ("fmul", "fdiv") and not isinstance(b, Symbol) and b == 1.0:
        return a
    if op == "fmul" and not isinstance(a, Symbol) and a == 1.0:
        return b
    return made(graph, op, a, b)


def _with_array(op: str, whole: str, a: Any, b: Any) -> Any:
    """Arithmetic of a symbol and a NumPy array, element by element; other operands are refused."""
    array = a if getattr(a, "ndim", 0) else b
    if not getattr(array, "ndim", 0):
        return NotImplemented
    made = array.astype(object)
    for place, x in enumerate(array.flat):
        made.flat[place] = _arithmetic(op, whole, *((x, b) if array is a else (a, x)))
    return made


def made(graph: Nodes, op: str, *values: object) -> Symbol:
    """A new double from doubles."""
    return Symbol(graph, graph.node(op, tuple([graph.number(v) for v in values]), "f"), "f")


def _compared(predicate: str, whole: str, a: object, b: object) -> Any:
    if not _is_operand(b, a):
        return NotImplemented
    graph = graph_of(a, b)
    if type_of(a) == type_of(b) == "b" and whole in ("eq", "ne"):
        differs = _bitwise("xor", a, b)
        return differs if whole == "ne" else ~differs
    if _is_integer(a) and _is_integer(b):
        op, args = f"icmp {whole}", (_node_of(graph, a), _node_of(graph, b))
    else:
        op, args = f"fcmp {predicate}", (graph.number(a), graph.number(b))
    return Symbol(graph, graph.node(op, args, "b"), "b")


def _bitwise(op: str, a: object, b: object) -> Symbol:
    graph, kind = graph_of(a, b), type_of(a)
    if kind != type_of(b) or kind == "f":
        raise refused_here(f"joins {NAMES[kind]} and {NAMES[type_of(b)]} bit by bit: only truths, or integers")
    return Symbol(graph, graph.node(op, (_node_of(graph, a), _node_of(graph, b)), kind), kind)


def select(condition: object, a: object, b: object) -> Any:
    """a where the condition holds, else b."""
    if not isinstance(condition, Symbol):
        return a if condition else b
    graph = condition.graph
    test = condition if condition.type == "b" else condition != 0
    if a is b:
        return a
    kind = type_of(a) if type_of(a) == type_of(b) and isinstance(a, Symbol) | isinstance(b, Symbol) else "f"
    if kind == "f" and isinstance(a, bool) and isinstance(b, bool):
        kind = "b"
    nodes = [graph.number(v) if kind == "f" else _node_of(graph, v) for v in (a, b)]
    if nodes[0] == nodes[1]:
        return a
    return Symbol(graph, graph.node("select", (test.node, *nodes), kind), kind)


def unary(op: str, x: Symbol) -> Any:
    """A root, a floor or an absolute value."""
    return made(x.graph, op, x)


def converted(op: str, x: Symbol, kind: str) -> Any:
    """A value in another type: `bitcast` keeps the bits, `fptosi` truncates to an integer."""
    return Symbol(x.graph, x.graph.node(op, (x.node,), kind), kind)
