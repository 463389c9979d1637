"""A graph that knows the values of its nodes: machine code gives the same bits, for numbers of every kind."""

import random

import numpy as np
import pytest
from odd_numbers import any_number, bits

from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.compiler.tracer import symbols
from tandemlift.compiler.tracer.elementary import floor, to_integer
from tandemlift.compiler.tracer.fused import FUSES, rounded_twice
from tandemlift.compiler.tracer.valued_graph import ValuedGraph, evaluated
from tandemlift.core import algebra
from tandemlift.core.vector import Vec3
from tandemlift.simulation.loop.random_numbers import normals

ROWS = 200


def arithmetic(x, y, z):
    """Products and sums that would be fused, quotients by anything, roots and whole parts of anything."""
    return x * y + z, x / y, floor(x), algebra.sqrt(y), -z, abs(x), algebra.minimum(x, y) - algebra.maximum(y, z)


def choices(x, y, z):
    """Every comparison, and truths joined bit by bit."""
    truths = [x < y, x <= y, x > y, x >= y, x == y, x != y, (x < y) & (y < z), (x < y) | (y < z), (x < y) ^ (y < z)]
    return tuple(algebra.where(truth, x, z) for truth in (*truths, ~truths[0]))


def whole(x, y, z):
    """Integers of 64 bits, which wrap around; of numbers out of range, the nearest."""
    i, j, k = to_integer(x), to_integer(y * 1e12), to_integer(z)
    made = [i + j, i - j, i * j * j, (i << 3) ^ (j >> 5), i & j | k]
    truths = [i < j, i <= j, i > j, i >= j, i == j, i != j]
    return (*[m * 1.0 for m in made], *[algebra.where(truth, x, y) for truth in truths])


def elementary(x, y, z):
    """Polynomials, and the bits of numbers."""
    small = algebra.clip(z, -1e4, 1e4)
    return (
        *[f(small) for f in (algebra.sin, algebra.cos, algebra.tan, algebra.tanh, algebra.exp, algebra.expm1)],
        algebra.log(algebra.maximum(abs(x), 1e-300)),
        algebra.atan2(x, y),
        algebra.power(abs(x), 0.4),
    )


@pytest.mark.parametrize("function", [arithmetic, choices, whole, elementary])
def test_values_are_those_of_machine_code_to_the_last_bit(function):
    chance = random.Random(function.__name__)
    rows = [[any_number(chance) for _ in range(3)] for _ in range(ROWS)]
    before = FUSES.set(False)
    try:
        code = compiled(lambda x, y, z: Vec3(*[function(x, y, z)] * 3).x, 0.0, 0.0, 0.0)
        graph = ValuedGraph(rows[0])
        made = symbols(graph, function(*[graph.input("number", i) for i in range(3)]))
    finally:
        FUSES.reset(before)
    wanted = code(np.array(rows))
    found = [[evaluated(graph, row)[s.node] for s in made] for row in rows]
    assert np.array_equal(bits(np.array(found)), bits(wanted))
    assert np.array_equal(bits(np.array([graph.values[s.node] for s in made])), bits(wanted[0]))


def test_random_numbers_are_those_of_plain_python_to_rounding():
    graph = ValuedGraph([3.0, 1.0, 12345.0, 4294967295.0])
    made = rounded_twice(normals)(*[graph.input("number", i) for i in range(4)])
    assert np.allclose([graph.values[s.node] for s in made], normals(3, 1, 12345, 4294967295), rtol=1e-14)


def test_a_branch_is_kept_as_a_guard():
    graph = ValuedGraph([2.0, 3.0])
    x, y = (graph.input("number", i) for i in range(2))
    assert x < y
    assert not x > y
    assert min(x, y) is x
    assert bool(x)
    assert [(guard.holds, graph.inputs_of(guard.condition)) for guard in graph.guards.values()] == [
        (True, [0, 1]),
        (False, [0, 1]),
        (False, [0, 1]),  # min(x, y) asks whether y is below x
        (True, [0]),
    ]


def test_a_plain_number_is_kept_with_its_inputs_and_the_place_that_asked():
    graph = ValuedGraph([2.0, 3.0, 0.26])
    x, y, z = (graph.input("number", i) for i in range(3))
    assert round(z / 0.1) == 3
    assert float(x * x) == 4.0
    place = "by test_valued_graph.test_a_plain_number_is_kept_with_its_inputs_and_the_place_that_asked"
    assert graph.used.keys() == {0, 2}
    assert graph.used[0].startswith("is used as a plain number by ")
    assert graph.used[2].startswith("is rounded to a whole number by ")
    assert all(reason.endswith(place.removeprefix("by test_valued_graph")) for reason in graph.used.values())
    assert y is not x


def test_powers_and_arrays_serve_code_that_is_written_for_numbers():
    graph, before = ValuedGraph([2.0]), FUSES.set(False)
    x = graph.input("number", 0)
    made = [x**2, x**0.5, x**1.2, 3.0**x, *(x * np.array([1.0, 3.0])), *(np.array([1.0, 3.0]) - x)]
    FUSES.reset(before)
    wanted = [4.0, 2.0**0.5, 2.0**1.2, 9.0, 2.0, 6.0, -1.0, 1.0]
    assert np.allclose([graph.values[s.node] for s in made], wanted, rtol=1e-14)
    assert x**0 == 1.0
