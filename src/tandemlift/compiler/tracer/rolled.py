"""Large sets of numbers in machine code: arrays in memory, and loops over their values.

A function writes its nodes in stages. First come all numbers of a stage, then for each size of set one loop, in which
every value passes through the same instructions. Memory keeps what a later stage needs. The bits are the same as
without loops.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

from tandemlift.compiler.tracer.symbol import Symbol
from tandemlift.compiler.tracer.text import Place, Text, constant, double

SET_WIDTH = 8  # values of a set per instruction in a flight alone


def stages(f: Text, nodes: Iterable[int]) -> dict[int, int]:
    """The stage of each node: a number computed from a set comes one stage after it."""
    g, found = f.graph, dict[int, int]()
    for node in nodes:
        stage = 0
        for argument in () if f.is_leaf(node) else g.args[node]:
            elsewhere = g.counts[argument] != g.counts[node] or g.ops[node].startswith("take ")
            later = g.counts[argument] > 0 and elsewhere
            stage = max(stage, found.get(argument, 0) + later)
        found[node] = stage
    return found


def width_of(f: Text, count: int) -> int:
    """Values of a set per instruction; 1 in a block, whose lanes fill the vectors already."""
    if f.lanes > 1:
        return 1
    return next(w for w in (SET_WIDTH, 4, 2, 1) if count % w == 0)


class Loop:
    """The loop over the values of sets of one size; an iteration handles `width` values from `i` on."""

    def __init__(self, sets: Sets, count: int, i: str) -> None:
        self.f, self.sets, self.i, self.width = sets.f, sets, i, width_of(sets.f, count)
        self.values: dict[int, str] = {}

    def kind(self, type: str) -> str:
        """The type of a value in this loop."""
        base = self.f.base[type]
        lanes = self.f.lanes * self.width
        return base if lanes == 1 else f"<{lanes} x {base}>"

    def operand(self, node: int) -> str:
        """A number, or the values of a set that this iteration handles."""
        f, g = self.f, self.f.graph
        if g.counts[node]:
            if node not in self.values:
                self.values[node] = self.truth(node, self.loaded(self.sets.places[node]))
            return self.values[node]
        value = f.operand(node)
        return value if self.width == 1 or value.startswith("splat") else self.repeated(node, value)

    def repeated(self, node: int, value: str) -> str:
        """A number, repeated for all values of this iteration."""
        f = self.f
        base = f.base[f.graph.types[node]]
        if f.graph.ops[node] == "const":
            return f"splat ({base} {value})"
        kind = f"<{self.width} x {base}>"
        first = f.op(f"insertelement {kind} poison, {base} {value}, i64 0")
        return f.op(f"shufflevector {kind} {first}, {kind} poison, <{self.width} x i32> zeroinitializer")

    def loaded(self, at: Place) -> str:
        """Load the values of this iteration."""
        f = self.f
        if self.width == 1 or at.stride == 1:
            return f.op(f"load {self.kind('f')}, ptr {self.address(at)}, align 8")
        value = "poison"
        for j in range(self.width):
            one = f.load(at.base, f.integer("add", at.first, f.integer("mul", f.integer("add", self.i, j), at.stride)))
            value = f.op(f"insertelement {self.kind('f')} {value}, {f.real} {one}, i64 {j}")
        return value

    def address(self, at: Place) -> str:
        """Address of the first value of this iteration."""
        return self.f.at(at.base, self.f.integer("add", at.first, self.f.integer("mul", self.i, at.stride)))

    def truth(self, node: int, value: str) -> str:
        """A truth from its stored form, 1.0 or 0.0; numbers as they are."""
        if self.f.graph.types[node] == "f":
            return value
        return self.f.op(f"fcmp one {self.kind('f')} {value}, {self.constant(0.0)}")

    def constant(self, value: float) -> str:
        """A constant for all values of this iteration."""
        text = double(value, self.f.real)
        return text if self.kind("f") == self.f.real else f"splat ({self.f.real} {text})"

    def store(self, node: int, to: Place) -> None:
        """Store the values of this iteration."""
        f, value = self.f, self.values[node]
        if f.graph.types[node] == "b":
            one, none = (f"{self.kind('f')} {self.constant(x)}" for x in (1.0, 0.0))
            value = f.op(f"select {self.kind('b')} {value}, {one}, {none}")
        f.do(f"store {self.kind('f')} {value}, ptr {self.address(to)}, align 8")


@contextmanager
def loop_over(sets: Sets, count: int) -> Iterator[Loop]:
    """A loop over the values of sets of one size."""
    f, width = sets.f, width_of(sets.f, count)
    with f.repeat(count // width) as i:
        yield Loop(sets, count, i if width == 1 else f.integer("mul", i, width))


class WrittenPart(NamedTuple):
    """A number, or a set of `size` numbers, to be written from number `first` on."""

    first: int
    node: int
    size: int


class Sets:
    """The large sets of a function.

    Attributes:
        places: places of the sets already computed.
        room: allocates memory for a set of a number of values.
    """

    def __init__(self, f: Text) -> None:
        self.f, self.places = f, dict[int, Place]()
        self.room: Callable[[int], Place] = lambda count: Place(f.own_memory(count), 0)

    def write(self, nodes: list[int], roots: list[int]) -> None:
        """Compute nodes and sets, stage by stage."""
        f, g = self.f, self.f.graph
        stage_of = stages(f, nodes)
        awaited = set(roots)
        for node in nodes:
            for argument in () if f.is_leaf(node) else g.args[node]:
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
                f.write_number(node)
            for count in sorted(count for s, count in sets if s == stage):
                self._write_sets(sets[stage, count], count, awaited)

    def _write_sets(self, nodes: list[int], count: int, awaited: set[int]) -> None:
        """Write sets of one size and stage: find those in memory, and compute the others in a loop."""
        f, g, computed = self.f, self.f.graph, []
        for node in nodes:
            if node not in self.places and not self._place_without_loop(node, count):
                computed.append(node)
        if not computed:
            return
        waits = {node: self.room(count) for node in computed if node in awaited}
        with loop_over(self, count) as loop:
            for node in computed:
                operands = [loop.operand(a) for a in g.args[node]]
                loop.values[node] = f.op(f.instruction(node, loop.kind, operands))
                if node in waits:
                    loop.store(node, waits[node])
        self.places |= waits

    def _place_without_loop(self, node: int, count: int) -> bool:
        """Place a set that needs no loop: in memory already, or written number by number. Whether that was possible."""
        f, g = self.f, self.f.graph
        op, args = g.ops[node], g.args[node]
        if op == "const":
            self.places[node] = self._constant_set(args)
        elif op == "in" or node in f.kept:
            given = f.kept[node]() if node in f.kept else f.read[args[0]](args[1])
            assert isinstance(given, Place), f"a set of inputs {args} that is not in memory"
            self.places[node] = given
        elif op.startswith("take "):
            first, step = map(int, op.split()[1:])
            source = self.places[args[0]]
            at = f.integer("add", source.first, first * source.stride)
            self.places[node] = Place(source.base, at, source.stride * step)
        elif op == "pack":
            self.places[node] = to = self.room(count)
            for i, argument in enumerate(args):
                f.store(f.operand(argument), to.base, f.integer("add", to.first, i))
        else:
            return False
        return True

    def _constant_set(self, values: tuple[bytes, ...]) -> Place:
        f, to = self.f, self.room(len(values))
        for i, value in enumerate(values):
            text = constant(value, f.real)
            f.store(text if f.lanes == 1 else f"splat ({f.real} {text})", to.base, f.integer("add", to.first, i))
        return to

    def put(self, to: Place, symbols: Sequence[Symbol], kind: str = "") -> None:
        """See `llvm.Function.put`."""
        f = self.f
        parts = [part for part in self._parts(symbols) if not self._stays(part, kind)]
        numbers = iter(f.values(Symbol(f.graph, part.node, "f") for part in parts if not part.size))
        sources = [part.node for part in parts if part.size]
        f.write(sources)
        moved = {node: self._copy_source(node, to.base) for node in sources}
        for part in parts:
            place = Place(to.base, f.offset(to, part.first), to.stride)
            if part.size:
                self._copy(moved[part.node], f.graph.counts[part.node], place)
            else:
                f.store(next(numbers), *place[:2])

    def _parts(self, symbols: Sequence[Symbol]) -> Iterator[WrittenPart]:
        g, i = self.f.graph, 0
        while i < len(symbols):
            node = symbols[i].node
            source = g.args[node][0] if g.ops[node] == "get 0" else -1
            count = g.counts[source] if source >= 0 else 0
            whole = [s.node for s in symbols[i : i + count]] == [g.get(source, j) for j in range(count)]
            yield WrittenPart(i, source, count) if count and whole else WrittenPart(i, node, 0)
            i += max(count if whole else 0, 1)

    def _stays(self, part: WrittenPart, kind: str) -> bool:
        g = self.f.graph
        return g.ops[part.node] == "in" and g.args[part.node] == (kind, part.first)

    def _copy_source(self, node: int, base: str) -> Place:
        """A place from which a set can be copied while the memory at `base` is written."""
        at, count = self.places[node], self.f.graph.counts[node]
        if at.base != base:
            return at
        to = self.room(count)
        self._copy(at, count, to)
        return to

    def _copy(self, source: Place, count: int, to: Place) -> None:
        f = self.f
        with loop_over(self, count) as loop:
            f.do(f"store {loop.kind('f')} {loop.loaded(source)}, ptr {loop.address(to)}, align 8")
