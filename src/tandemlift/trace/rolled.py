"""Sets of many numbers in machine code: arrays in memory, and one loop over what is done to all of their values.

A function writes its nodes in stages. All numbers of a stage come first, then a loop for the sets of each size, in
which every value of a set goes through the same instructions. What a later stage needs of them waits in memory. The
bits are those of the same laws written out value by value.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from tandemlift.trace.llvm import Function

WIDEST = 8  # values of a set that one instruction serves in a flight alone


class Place(NamedTuple):
    """Values in memory: where the first stands, counted in numbers of all lanes, and how far on each next one."""

    base: str
    first: str | int
    stride: int = 1


def stages(f: Function, nodes: Iterable[int]) -> dict[int, int]:
    """The stage of every node: a number that is made of a set comes a stage after it."""
    g, found = f.graph, dict[int, int]()
    for node in nodes:
        stage = 0
        for argument in () if f.is_leaf(node) else g.args[node]:
            elsewhere = g.counts[argument] != g.counts[node] or g.ops[node].startswith("take ")
            later = g.counts[argument] > 0 and elsewhere
            stage = max(stage, found.get(argument, 0) + later)
        found[node] = stage
    return found


def width_of(f: Function, count: int) -> int:
    """How many values of a set one instruction serves: lanes are served by vectors already."""
    if f.lanes > 1:
        return 1
    return next(w for w in (WIDEST, 4, 2, 1) if count % w == 0)


class Loop:
    """The loop over the values of sets of one size, at `i`, `width` of them at a time."""

    def __init__(self, f: Function, count: int, i: str) -> None:
        self.f, self.count, self.i, self.width = f, count, i, width_of(f, count)
        self.values: dict[int, str] = {}

    def kind(self, type: str) -> str:
        """The type of a value in this loop."""
        base = {"f": "double", "b": "i1", "i": "i64"}[type]
        lanes = self.f.lanes * self.width
        return base if lanes == 1 else f"<{lanes} x {base}>"

    def operand(self, node: int) -> str:
        """A number, or the values of a set that this turn of the loop is about."""
        f, g = self.f, self.f.graph
        if g.counts[node]:
            if node not in self.values:
                self.values[node] = self.truth(node, self.loaded(f.place(node)))
            return self.values[node]
        value = f.operand(node)
        return value if self.width == 1 or value.startswith("splat") else self.repeated(node, value)

    def repeated(self, node: int, value: str) -> str:
        """A number beside all values of this turn."""
        f = self.f
        base = {"f": "double", "b": "i1", "i": "i64"}[f.graph.types[node]]
        if f.graph.ops[node] == "const":
            return f"splat ({base} {value})"
        kind = f"<{self.width} x {base}>"
        first = f.op(f"insertelement {kind} poison, {base} {value}, i64 0")
        return f.op(f"shufflevector {kind} {first}, {kind} poison, <{self.width} x i32> zeroinitializer")

    def loaded(self, at: Place) -> str:
        """The values of this turn from memory."""
        f = self.f
        if self.width == 1 or at.stride == 1:
            return f.op(f"load {self.kind('f')}, ptr {self.address(at)}, align 8")
        value = "poison"
        for j in range(self.width):
            one = f.load(at.base, f.whole("add", at.first, f.whole("mul", f.whole("add", self.i, j), at.stride)))
            value = f.op(f"insertelement {self.kind('f')} {value}, double {one}, i64 {j}")
        return value

    def address(self, at: Place) -> str:
        """Where the first value of this turn stands."""
        f = self.f
        return f.at(at.base, f.whole("add", at.first, f.whole("mul", self.i, at.stride)))

    def truth(self, node: int, value: str) -> str:
        """A truth that waits as 1 or 0."""
        if self.f.graph.types[node] == "f":
            return value
        return self.f.op(f"fcmp one {self.kind('f')} {value}, {self.constant(0.0)}")

    def constant(self, value: float) -> str:
        """A constant for all values of this turn."""
        from tandemlift.trace.llvm import double

        text = double(value)
        return text if self.kind("f") == "double" else f"splat (double {text})"

    def leave(self, node: int, to: Place) -> None:
        """Let the values of this turn wait in memory."""
        f, value = self.f, self.values[node]
        if f.graph.types[node] == "b":
            one, none = (f"{self.kind('f')} {self.constant(x)}" for x in (1.0, 0.0))
            value = f.op(f"select {self.kind('b')} {value}, {one}, {none}")
        f.do(f"store {self.kind('f')} {value}, ptr {self.address(to)}, align 8")


@contextmanager
def over(f: Function, count: int) -> Iterator[Loop]:
    """A loop over the values of sets of one size."""
    width = width_of(f, count)
    with f.repeat(count // width) as turn:
        yield Loop(f, count, turn if width == 1 else f.whole("mul", turn, width))
