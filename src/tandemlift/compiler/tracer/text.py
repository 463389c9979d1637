"""LLVM text: modules, and functions written from top to bottom, with loops and branches as contexts."""

from __future__ import annotations

import math
import operator
import platform
import struct
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any, NamedTuple

from tandemlift.compiler.tracer.graph import Graph
from tandemlift.compiler.tracer.symbol import Symbol

BASE = {"b": "i1", "i": "i64", "w": "i32"}  # LLVM's name for each type of the graph; for `f` see `Graph.real`
WIDE = '"prefer-vector-width"="512" "min-legal-vector-width"="512"'
CACHED_LINES = 8_000  # lines, from which on the instruction cache limits a function, which is then optimised for size
ATTRIBUTES = [
    f"attributes #0 = {{ nounwind {WIDE} }}",
    f"attributes #1 = {{ nounwind noinline alignstack=64 {WIDE} }}",
    f"attributes #2 = {{ nounwind noinline optsize minsize alignstack=64 {WIDE} }}",
    "attributes #3 = { nounwind noinline noimplicitfloat }",  # without vectors of neighbours
]
# of a double and of a float: the distance from 1 to the next, and what rounds to whole numbers as it is added
ROUNDING = {2.0**-52: 2.0**-23, 1.5 * 2.0**52: 1.5 * 2.0**23}
SMALLEST_FLOAT, LARGEST_FLOAT = 2.0**-126, (2.0 - 2.0**-23) * 2.0**127  # normal floats
IS_X86, FLUSH = platform.machine().lower() in ("x86_64", "amd64"), 0x8040  # MXCSR: results and operands too small are 0
INTEGER_OPS = {"add": operator.add, "mul": operator.mul}


class Module:
    """Functions, and their declarations."""

    def __init__(self) -> None:
        self.functions: list[str] = []
        self.declared: set[str] = set()

    @property
    def text(self) -> str:
        """The text of the module."""
        return "\n".join([*sorted(self.declared), *self.functions, *ATTRIBUTES]) + "\n"


class Place(NamedTuple):
    """Values in memory: base address, offset of the first value, and stride, both in numbers of all lanes."""

    base: str
    first: str | int
    stride: str | int = 1


class ScratchLayout:
    """Layout of the scratch memory, in numbers of one flight.

    Attributes:
        spans: first number and size of each span, by name.
        size: of all spans together.
    """

    def __init__(self) -> None:
        self.spans: dict[str, tuple[int, int]] = {}
        self.size = 0

    def take(self, name: str, size: int) -> int:
        """Add a span of `size` numbers; its first number."""
        begin, self.size = self.size, self.size + size
        self.spans[name] = begin, size
        return begin


class Text(ABC):
    """The text of one function over the nodes of a graph; `llvm.Function` writes the nodes.

    Args:
        module: the module that it belongs to.
        graph: the graph.
        lanes: numbers in a value, one for each flight.
        head: its name and parameters, as in `i64 @fly(ptr %c)`.

    Attributes:
        read: for each kind of input, a function from its index to its text or place.
        kept: nodes computed elsewhere before, each with a function to its text or place.
    """

    def __init__(self, module: Module, graph: Graph, lanes: int, head: str) -> None:
        self.module, self.graph, self.lanes, self.head = module, graph, lanes, head
        self.read: dict[str, Callable[[int], str | Place]] = {}
        self.kept: dict[int, Callable[[], str | Place]] = {}
        self.real, self.base = graph.real, {"f": graph.real, **BASE}
        self.vector = self.real if lanes == 1 else f"<{lanes} x {self.real}>"
        self.zero = "0.0" if lanes == 1 else "zeroinitializer"
        self.lines: list[str] = ["entry:"]
        self._rooms: list[str] = []
        self._count = 0

    def end(self, result: str = "void") -> None:
        """Close the function and put it into its module."""
        self.do(f"ret {result}")
        begin, *lines = self.lines
        head = self.head if len(lines) < CACHED_LINES else self.head.replace(" #1", " #2")
        self.module.functions.append("\n".join([f"define {head} {{", begin, *self._rooms, *lines, "}"]))

    @abstractmethod
    def scope(self) -> AbstractContextManager[None]:
        """A context after which the values computed inside are forgotten."""

    @abstractmethod
    def values(self, symbols: Iterable[Symbol]) -> list[str]:
        """The values of symbols in all lanes, as text."""

    @abstractmethod
    def operand(self, node: int) -> str:
        """A number already computed in this function, in all lanes."""

    @abstractmethod
    def is_leaf(self, node: int) -> bool:
        """Whether a node is available without its arguments."""

    @abstractmethod
    def write(self, roots: list[int]) -> None:
        """Compute nodes and all their arguments."""

    @abstractmethod
    def write_number(self, node: int) -> None:
        """Compute a number whose arguments are already computed."""

    @abstractmethod
    def instruction(self, node: int, kind_of: Callable[[str], str], x: list[str]) -> str:
        """The instruction that computes a node from operands; `kind_of`: LLVM's name for a type of the graph."""

    def do(self, text: str) -> None:
        """Write an instruction without a result."""
        self.lines.append("  " + text)

    def op(self, text: str) -> str:
        """Write an instruction; the name of its result."""
        self._count += 1
        self.lines.append(f"  %v{self._count} = {text}")
        return f"%v{self._count}"

    def label(self, name: str) -> str:
        """Begin a block; the block before it branches to it."""
        self.do(f"br label %{name}")
        self.lines.append(f"{name}:")
        return name

    def fresh(self, name: str) -> str:
        """A unique name for a block."""
        self._count += 1
        return f"{name}{self._count}"

    # control

    @contextmanager
    def repeat(self, count: str | int, first: str | int = 0) -> Iterator[str]:
        """A loop from `first` to `count` − 1; its body passes values on only through memory."""
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
        """A branch; its body passes values on only through memory."""
        yes, done = self.fresh("yes"), self.fresh("done")
        self.do(f"br i1 {condition}, label %{yes}, label %{done}")
        self.lines.append(f"{yes}:")
        with self.scope():
            yield
        self.label(done)

    @contextmanager
    def without_tiny_numbers(self) -> Iterator[None]:
        """Take floats below the smallest normal one as 0 on x86, which is many times slower with them."""
        if self.real == "double" or not IS_X86:
            yield
            return
        self.module.declared |= {f"declare void @llvm.x86.sse.{name}mxcsr(ptr)" for name in ("ld", "st")}
        self._rooms += [f"  %{name} = alloca i32, align 4" for name in ("modes", "before")]
        self.do("call void @llvm.x86.sse.stmxcsr(ptr %before)")
        modes = self.op(f"or i32 {self.op('load i32, ptr %before, align 4')}, {FLUSH}")
        self.do(f"store i32 {modes}, ptr %modes, align 4")
        self.do("call void @llvm.x86.sse.ldmxcsr(ptr %modes)")
        yield
        self.do("call void @llvm.x86.sse.ldmxcsr(ptr %before)")

    def any(self, truth: str) -> str:
        """Whether a truth holds in any lane."""
        if self.lanes == 1:
            return truth
        name = f"@llvm.vector.reduce.or.v{self.lanes}i1"
        self.module.declared.add(f"declare i1 {name}(<{self.lanes} x i1>)")
        return self.op(f"call i1 {name}(<{self.lanes} x i1> {truth})")

    # memory

    def at(self, base: str, index: str | int, kind: str = "") -> str:
        """The address of a value in memory."""
        return self.op(f"getelementptr inbounds nuw {kind or self.vector}, ptr {base}, i64 {index}")

    def load(self, base: str, index: str | int = 0, kind: str = "") -> str:
        """A value of all lanes from memory, or of another kind (`self.real`, `i64`, `ptr`)."""
        return self.op(f"load {kind or self.vector}, ptr {self.at(base, index, kind)}, align 8")

    def store(self, value: str, base: str, index: str | int = 0, kind: str = "") -> None:
        """Write a value of all lanes, or of another kind."""
        self.do(f"store {kind or self.vector} {value}, ptr {self.at(base, index, kind)}, align 8")

    def offset(self, to: Place, i: int) -> str:
        """The offset of value `i` of a place."""
        return self.integer("add", to.first, i if to.stride == 1 else self.integer("mul", i, to.stride))

    def integer(self, op: str, a: str | int, b: str | int) -> str:
        """Arithmetic of 64-bit integers."""
        if op == "add" and (a == 0 or b == 0):
            return str(b if a == 0 else a)
        if op in INTEGER_OPS and isinstance(a, int) and isinstance(b, int):
            return str(INTEGER_OPS[op](a, b))
        return self.op(f"{op} i64 {a}, {b}")

    def call(self, result: str, name: str, *arguments: str, types: Iterable[str]) -> str:
        """Call one of LLVM's own functions; the name of its result."""
        self.module.declared.add(f"declare {result} {name}({', '.join(types)})")
        given = ", ".join(f"{t} {a}" for t, a in zip(types, arguments, strict=True))
        return self.op(f"call {result} {name}({given})")

    def own_memory(self, count: int) -> str:
        """Memory on the stack of the function, for `count` numbers of all lanes."""
        name = f"%room{len(self._rooms)}"
        self._rooms.append(f"  {name} = alloca {self.vector}, i64 {count}, align 64")
        return name

    def spread(self, value: str, base: str = "") -> str:
        """A scalar in all lanes."""
        if self.lanes == 1:
            return value
        base = base or self.real
        kind = f"<{self.lanes} x {base}>"
        first = self.op(f"insertelement {kind} poison, {base} {value}, i64 0")
        return self.op(f"shufflevector {kind} {first}, {kind} poison, <{self.lanes} x i32> zeroinitializer")


def constant(value: Any, real: str = "double") -> str:
    """A constant of a graph whose numbers are doubles or floats (`real`) as text."""
    if isinstance(value, bytes):
        if real == "float":  # which LLVM, too, writes as a double
            value = struct.pack("<d", nearest_float(struct.unpack("<d", value)[0]))
        return f"0x{struct.unpack('<Q', value)[0]:016X}"
    return str(value).lower()


def double(value: float, real: str = "double") -> str:
    """A number as text, to the last bit."""
    return constant(struct.pack("<d", value), real)


def nearest_float(x: float) -> float:
    """The float that stands for a number in single precision.

    A number too small for a normal float becomes the smallest, as it guards a division, and one that is too large the
    largest; what belongs to the rounding of doubles becomes what belongs to that of floats.
    """
    if x == 0.0 or not math.isfinite(x):
        return x
    size = ROUNDING.get(abs(x)) or min(max(abs(x), SMALLEST_FLOAT), LARGEST_FLOAT)
    return float(struct.unpack("<f", struct.pack("<f", math.copysign(size, x)))[0])
