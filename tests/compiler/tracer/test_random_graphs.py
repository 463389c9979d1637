"""Random graphs of operations in machine code against NumPy's, each rounded once, to the last bit."""

from __future__ import annotations

import ctypes
import operator
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from exact_functions import once
from odd_numbers import any_number, bits

from tandemlift.compiler.machine_code.machine import BEST, QUICK, Loaded, compiled
from tandemlift.compiler.tracer import Function, Graph, Module, Place, Symbol
from tandemlift.compiler.tracer.elementary import floor
from tandemlift.compiler.tracer.fused import fma
from tandemlift.core.algebra import absolute, maximum, minimum, sqrt, where
from tandemlift.core.vector import each
from tandemlift.simulation.preparation.memory import aligned

LANES, INPUTS, SHARED, OPERATIONS, ROWS, SEEDS = 8, 5, 2, 60, 24, 12
TRACED: dict[str, Callable[..., Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "fma": fma,
    "sqrt": sqrt,
    "floor": floor,
    "abs": absolute,
    "negative": operator.neg,
    "minimum": minimum,
    "maximum": maximum,
    "where": where,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "&": operator.and_,
    "|": operator.or_,
    "^": operator.xor,
    "~": lambda a: ~a if isinstance(a, Symbol) else not a,
}
EXACT = TRACED | {  # by NumPy, each rounded once
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "fma": lambda a, b, c: np.float64(once(float(a), float(b), float(c))),
    "sqrt": np.sqrt,
    "floor": np.floor,
    "abs": np.abs,
    "minimum": lambda a, b: a if a < b else b,
    "maximum": lambda a, b: a if a > b else b,
    "where": lambda condition, a, b: a if condition else b,
}
NUMBERS = {"+": 2, "-": 2, "*": 2, "/": 2, "fma": 3, "sqrt": 1, "floor": 1, "abs": 1, "negative": 1}
CHOICES = {"minimum": 2, "maximum": 2}
COMPARED = ["<", "<=", ">", ">=", "==", "!="]
TRUTHS = {"&": 2, "|": 2, "^": 2, "~": 1}


class Program:
    """Random operations, one after the other, of what came before: (operation, places of its arguments).

    Places 0 … INPUTS − 1 are inputs, of which the first SHARED are the same in all lanes, then come two constants.
    """

    def __init__(self, seed: int) -> None:
        chance = random.Random(seed)
        self.constants = [chance.choice([0.5, 3.0, -1.25, 1e-3, 1.0]), chance.uniform(-2.0, 2.0)]
        numbers, truths, self.steps = (
            list(range(INPUTS + len(self.constants))),
            list[int](),
            list[tuple[str, list[int]]](),
        )
        place = len(numbers)
        for _ in range(OPERATIONS):
            kind = chance.choice(["number"] * 6 + ["choice", "compared"] + ["where", "truth"] * bool(truths))
            if kind == "number":
                name = chance.choice(list(NUMBERS))
                places = [chance.choice(numbers[-12:] + numbers[:INPUTS]) for _ in range(NUMBERS[name])]
            elif kind == "truth":
                name = chance.choice(list(TRUTHS))
                places = [chance.choice(truths) for _ in range(TRUTHS[name])]
            else:
                name = {"choice": chance.choice(list(CHOICES)), "compared": chance.choice(COMPARED)}.get(kind, kind)
                places = [chance.choice(truths) for _ in range(kind == "where")] + [
                    chance.choice(numbers) for _ in range(2)
                ]
            self.steps.append((name, places))
            (truths if kind in ("truth", "compared") else numbers).append(place)
            place += 1

    def run(self, inputs: list[Any], operations: dict[str, Callable[..., Any]]) -> list[Any]:
        """What all operations give."""
        values = [*inputs, *self.constants]
        for name, places in self.steps:
            values.append(operations[name](*[values[p] for p in places]))
        return values[INPUTS + len(self.constants) :]


def machine_code(program: Program, lanes: int, level: Any) -> Callable[[np.ndarray], np.ndarray]:
    """Machine code of a program: (blocks, inputs, lanes) to (blocks, operations, lanes)."""
    graph, module = Graph(), Module()
    inputs = [graph.input("shared" if i < SHARED else "own", i) for i in range(INPUTS)]
    found = [where(x, 1.0, 0.0) if x.type == "b" else x for x in map(symbol(graph), program.run(inputs, TRACED))]
    f = Function(module, graph, lanes, "i64 @rows(ptr %x, ptr %y, i64 %count) #0", ("shared",))
    with f.repeat("%count") as row:
        x, y = f.at("%x", f.integer("mul", row, INPUTS)), f.at("%y", f.integer("mul", row, OPERATIONS))
        f.read = {"shared": lambda i: f.load(x, i * lanes, "double"), "own": lambda i: f.load(x, i)}
        for m, value in enumerate(f.values(found)):
            f.store(value, y, m)
    f.end("i64 0")
    code = Loaded(compiled(module.text, level), ["rows"])
    call = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)(code.addresses["rows"])

    def rows(table: np.ndarray) -> np.ndarray:
        given, out = np.ascontiguousarray(table), np.zeros((len(table), OPERATIONS, lanes))
        call(given.ctypes.data, out.ctypes.data, len(table))
        _ = code  # lives as long as what calls it
        return out

    return rows


def in_loops(program: Program, count: int, lanes: int, level: Any) -> tuple[list[int], Callable[..., np.ndarray]]:
    """Which operations give sets, and machine code that gives them: (inputs, count, lanes) to (sets, count, lanes).

    The shared inputs are numbers, which stand beside the sets.
    """
    graph, module, like = Graph(rolls_from=1), Module(), each(count)(*[0.0] * count)
    inputs = [graph.inputs("own", 0.0 if i < SHARED else like, i * count) for i in range(INPUTS)]
    all_of_it = program.run(inputs, TRACED)
    sets = [m for m, x in enumerate(all_of_it) if isinstance(x, Symbol) and x.rolled]
    found = [where(x, 1.0, 0.0) if x.type == "b" else x for x in (all_of_it[m] for m in sets)]
    f = Function(module, graph, lanes, "i64 @all(ptr %x, ptr %y) #0")
    f.read = {"own": lambda i: Place("%x", i)}
    f.put("%y", 0, [Symbol(graph, graph.get(x.node, j), "f") for x in found for j in range(count)])
    f.end("i64 0")
    code = Loaded(compiled(module.text, level), ["all"])
    call = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p)(code.addresses["all"])

    def run(table: np.ndarray) -> np.ndarray:
        given, out = aligned(table.size), aligned(len(found) * count * lanes)
        given[:] = table.ravel()
        call(given.ctypes.data, out.ctypes.data)
        _ = code  # lives as long as what calls it
        return out.reshape(len(found), count, lanes)

    return sets, run


def symbol(graph: Graph) -> Callable[[Any], Symbol]:
    """A value as a symbol: what depends on constants alone is a number."""
    return lambda x: (
        x if isinstance(x, Symbol) else Symbol(graph, graph.constant(x), "b" if isinstance(x, bool) else "f")
    )


def exactly(program: Program, row: Any) -> list[Any]:
    """What all operations give by IEEE 754."""
    with np.errstate(all="ignore"):
        return program.run(list(row), EXACT)


@pytest.mark.parametrize("seed", range(SEEDS))
def test_a_random_graph_gives_exact_results_rounded_once(seed):
    chance, program = random.Random(seed), Program(seed)
    table = np.array(
        [[[any_number(chance) for _ in range(LANES)] for _ in range(INPUTS)] for _ in range(ROWS // LANES)]
    )
    table[:, :SHARED] = table[:, :SHARED, :1]
    alone = table.swapaxes(1, 2).reshape(ROWS, INPUTS)
    wanted = np.array([[float(x) for x in exactly(program, row)] for row in alone])
    for level in (QUICK, BEST):
        single = machine_code(program, 1, level)(alone[:, :, None])[:, :, 0]
        block = machine_code(program, LANES, level)(table).swapaxes(1, 2).reshape(ROWS, OPERATIONS)
        assert np.array_equal(bits(single), bits(wanted))
        assert np.array_equal(bits(block), bits(wanted))


def test_random_graphs_have_everything_in_them():
    """Also results that are zero, subnormal, infinite and no number at all."""
    programs = [Program(seed) for seed in range(SEEDS)]
    assert {name for p in programs for name, _ in p.steps} == set(TRACED)
    chance = random.Random(1)
    rows = [exactly(p, [any_number(chance) for _ in range(INPUTS)]) for p in programs for _ in range(20)]
    numbers = np.array([x for row in rows for x in row if not isinstance(x, bool | np.bool)])
    tiny = np.abs(numbers) < np.finfo(float).tiny
    assert min(np.sum(numbers == 0.0), np.sum(np.isnan(numbers)), np.sum(np.isinf(numbers))) > 100
    assert np.sum(tiny & (numbers != 0.0)) > 10
    assert np.mean(np.isfinite(numbers)) > 0.4


@pytest.mark.parametrize(("seed", "count"), list(enumerate([3, 4, 8, 20] * 2)))
def test_a_random_graph_of_sets_in_loops_gives_the_same_bits(seed, count):
    chance, program = random.Random(seed), Program(seed)
    table = np.array([any_number(chance) for _ in range(INPUTS * count * LANES)]).reshape(INPUTS, count, LANES)
    table[:SHARED] = table[:SHARED, :1]
    wanted = np.array([[exactly(program, table[:, j, lane]) for lane in range(LANES)] for j in range(count)]).transpose(
        2, 0, 1
    )
    for level in (QUICK, BEST):
        for lanes, chosen in ((LANES, list(range(LANES))), (1, [5])):
            sets, code = in_loops(program, count, lanes, level)
            assert len(sets) > OPERATIONS / 2
            assert np.array_equal(bits(code(table[:, :, chosen])), bits(wanted[sets][:, :, chosen]))
