"""What is traced in place of a law: where operations are fused, what is one node, what numbers and symbols give."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from exact_functions import once
from hypothesis import given
from hypothesis import strategies as st
from odd_numbers import any_number, bits

from tandemlift.compiler.machine_code.functions import compiled, written
from tandemlift.compiler.machine_code.machine import BEST, QUICK
from tandemlift.compiler.tracer import Graph, elementary, traced
from tandemlift.compiler.tracer.fused import fused, once_rounded
from tandemlift.core.algebra import maximum, minimum, where
from tandemlift.core.law import Absent, Elementwise, choice, elementwise, law
from tandemlift.core.vector import Vec3, dot

FUSED = "llvm.fma"
ANY = st.floats(allow_nan=True, allow_infinity=True)

# Where products and sums are one operation


def sum_of_a_product(a, b, c):
    return a * b + c


def product_last(a, b, c):
    return c + a * b


def less_a_product(a, b, c):
    return c - a * b


def product_less(a, b, c):
    return a * b - c


def of_two_products(a, b, c):
    return a * b + b * c


def named(a, b, c):
    product = a * b
    return product + c


def in_a_function_within(a, b, c):
    def within(x):
        return a * x + c

    return within(b)


def in_a_lambda(a, b, c):
    return (lambda x: a * x + c)(b)


def with_defaults(a, b, c=None, *, scale=1.0):
    return a * b + (2.0 if c is None else c) * scale


def by_position(a, /, b, *others):
    return a * b + others[0]


def in_a_list(a, b, c):
    return sum([a * x + c for x in (b, b)], 0.0)


@law
def own(a, b, c):
    return a * b + c


def by_another_law(a, b, c):
    return own(a, b, c)


ALIKE = [sum_of_a_product, product_last, in_a_function_within, in_a_lambda, with_defaults, by_position, by_another_law]
WANTED = dict.fromkeys(ALIKE, once) | {
    less_a_product: lambda a, b, c: once(-a, b, c),
    product_less: lambda a, b, c: once(a, b, -c),
    of_two_products: lambda a, b, c: once(a, b, b * c),
    named: lambda a, b, c: a * b + c,
    in_a_list: lambda a, b, c: 2.0 * once(a, b, c),
}


def three(count=64):
    """Rows of three numbers whose product and sum cancel to the last digits."""
    chance = np.random.default_rng(3)
    a, b = chance.uniform(1.0, 2.0, (2, count))
    return np.stack([a, b, -a * b * (1.0 + chance.integers(-2, 3, count) * 2.0**-52)], axis=1)


@pytest.mark.parametrize("function", WANTED, ids=lambda f: f.__name__)
def test_a_product_and_a_sum_in_one_expression_are_rounded_once_in_machine_code_and_python(function):
    rows, law_of_it = three(), fused(function)
    wanted = [WANTED[function](*row) for row in rows.tolist()]
    assert compiled(law_of_it, 0.0, 0.0, 0.0)(rows)[:, 0].tolist() == wanted
    assert [law_of_it(*row) for row in rows.tolist()] == wanted
    makes_a_difference = any(function(*row) != one for row, one in zip(rows.tolist(), wanted, strict=True))
    assert (FUSED in written(law_of_it, 0.0, 0.0, 0.0)[0]) == makes_a_difference == (function is not named)


def test_dot_is_fused_from_the_second_product_on():
    rows = np.random.default_rng(1).standard_normal((50, 6))
    found = compiled(dot, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0))(rows)[:, 0]
    assert list(found) == [once(c, z, once(b, y, a * x)) for a, b, c, x, y, z in rows.tolist()]


def test_a_law_that_stands_inside_another_function_is_traced_unfused():
    offset, rows = 0.25, three()

    @law
    def inner(a, b, c):
        return a * b + c + offset

    found = compiled(inner, 0.0, 0.0, 0.0)(rows)[:, 0]
    assert np.array_equal(found, rows[:, 0] * rows[:, 1] + rows[:, 2] + offset)


def test_a_law_whose_source_cannot_be_read_is_traced_unfused(tmp_path):
    rows = three()
    for name, text in (("gone.py", None), ("no_python.py", "def f(a, b, c:\n"), ("bytes.py", "\0")):
        if text is not None:
            (tmp_path / name).write_text(text)
        scope = {"__name__": "nowhere"}
        exec(compile("def f(a, b, c):\n    return a * b + c\n", str(tmp_path / name), "exec"), scope)
        assert fused(scope["f"]) is scope["f"]
        found = compiled(law(scope["f"]), 0.0, 0.0, 0.0)(rows)[:, 0]
        assert np.array_equal(found, rows[:, 0] * rows[:, 1] + rows[:, 2])


@elementwise
def squared(x):
    return x * x + 1.0


@choice
def chosen(gains, x):
    """Of two."""


@chosen.register(float)
def _first(gains, x):
    return gains * x + 1.0


def test_elementwise_laws_and_choices_are_fused_as_well():
    graph = Graph()
    x, y = graph.input("x", 0), graph.input("x", 1)
    assert isinstance(traced(squared), Elementwise)
    assert graph.ops[traced(squared)(x).node] == "fma"
    assert [graph.ops[s.node] for s in traced(squared)(Vec3(x, y, x))] == ["fma"] * 3
    assert graph.ops[traced(chosen)(2.0, x).node] == "fma"


@choice(absent=("memory", 2.0, "x"))
def remembered(gains, memory, x):
    """(The new memory, a gain, what is seen of x)."""


@remembered.register(Vec3)
def _remembered(gains, memory, x):
    return memory + dot(gains, gains), gains.x, x * gains.y


@law(absent="x", instead={int: 0.0})
def passed(gains: Vec3, x):
    """What is left of x."""
    return x * gains.y


def test_a_choice_says_what_stands_for_an_absent_part():
    assert remembered(Absent(), 3.0, 5.0) == (3.0, 2.0, 5.0)
    assert remembered(Vec3(1.0, 2.0, 0.0), 3.0, 5.0) == (8.0, 1.0, 10.0)
    held = object()
    assert passed(Absent(), held) is held


def test_the_law_of_an_optional_part_is_a_choice_between_the_part_and_its_absence():
    assert (passed(Vec3(1.0, 2.0, 0.0), 5.0), passed(7, 5.0)) == (10.0, 0.0)
    with pytest.raises(TypeError, match=r"passed\(\) has no law for float; it knows Absent, Vec3, int"):
        passed(1.0, 5.0)
    with pytest.raises(TypeError, match=r"chosen\(\) has no law for Absent; it knows float"):
        chosen(Absent(), 1.0)


def test_an_absent_part_leaves_nothing_in_the_graph():
    graph = Graph()
    memory, x = graph.input("x", 0), graph.input("x", 1)
    before = len(graph.ops)
    answer = traced(remembered)(Absent(), memory, x)
    assert answer[0] is memory
    assert answer[1] == 2.0
    assert answer[2] is x
    assert traced(passed)(Absent(), x) is x
    assert len(graph.ops) == before


def test_a_choice_can_only_return_arguments_that_it_has():
    with pytest.raises(TypeError, match=r"blurred\(\) has no argument 'y'; it has gains, x"):

        @choice(absent=(0.0, "y"))
        def blurred(gains, x):
            """Of no arguments y."""


@given(ANY, ANY, ANY)
def test_numbers_are_rounded_once_as_symbols_are(a, b, c):
    assert bits(np.array([once_rounded(a, b, c)]))[0] == bits(np.array([once(a, b, c)]))[0]


def test_a_sum_of_constants_is_folded_as_it_is_computed():
    graph = Graph()
    x = graph.input("x")
    assert graph.ops[once_rounded(0.5, 3.0, x).node] == "fadd"  # the product of the two is exact
    assert graph.ops[once_rounded(0.1, 0.3, x).node] == "fma"


# One node


def test_equal_operations_are_one_node():
    graph = Graph()
    x, y = graph.input("x", 0), graph.input("x", 1)
    assert (x * y + x).node == (x * y + x).node
    assert (x < y).node == (x < y).node
    assert (x * y).node != (y * x).node
    before = len(graph.ops)
    assert (x + 1.5).node == (x + 1.5).node
    assert len(graph.ops) == before + 2
    assert elementary.sin(x).node == elementary.sin(x).node


def test_constants_that_differ_in_a_bit_or_a_type_are_different_nodes():
    graph = Graph()
    payload = float(np.array([0x7FF8000000000001]).view(float)[0])
    made = [graph.constant(value) for value in (0.0, -0.0, 0, False, 1.0, 1, True, math.nan, payload, 1.0 + 2.0**-52)]
    assert len(set(made)) == len(made)
    assert graph.constant(math.nan) == graph.constant(float("nan"))


def test_what_is_not_needed_is_not_written():
    def wasteful(x, y):
        _ = elementary.sin(x) / elementary.exp(y)
        return x + y

    text, _ = written(wasteful, 0.0, 0.0)
    assert "fdiv" not in text
    assert text.count("fadd") == 1


def test_a_choice_between_equal_values_is_no_choice():
    graph = Graph()
    x, y = graph.input("x", 0), graph.input("x", 1)
    assert where(x < y, x, x) is x
    assert where(x < y, 2.0, 2.0) == 2.0


# Numbers and symbols


ELEMENTARY = {"exp": 1, "tanh": 1, "log": 1, "sin": 1, "cos": 1, "atan2": 2, "sqrt": 1, "floor": 1, "absolute": 1}
SIZES = {"exp": 800.0, "tanh": 30.0, "sin": 1e5, "cos": 1e5}


@pytest.mark.parametrize("name", ELEMENTARY)
def test_an_elementary_function_of_a_number_is_that_of_a_symbol_to_the_last_bit(name):
    function, chance, size = getattr(elementary, name), random.Random(1), SIZES.get(name)
    rows = np.array([[any_number(chance) for _ in range(ELEMENTARY[name])] for _ in range(600)])
    if size is not None:
        half = len(rows) // 2
        rows[:half] = np.random.default_rng(2).uniform(-size, size, rows[:half].shape)
    if name == "log":
        rows = np.maximum(np.abs(np.nan_to_num(rows)), 2.3e-308)
    wanted = np.array([function(*map(float, row)) for row in rows])
    for lanes, level in ((1, QUICK), (8, BEST)):
        found = compiled(function, *[0.0] * rows.shape[1], lanes=lanes, level=level)(rows)[:, 0]
        assert np.array_equal(bits(found), bits(wanted))


def test_of_zeros_and_of_what_is_no_number_the_choice_is_that_of_plain_python():
    rows = [(a, b) for a in (0.0, -0.0, 1.0, math.inf, math.nan) for b in (0.0, -0.0, -1.0, -math.inf, math.nan)]
    for function, plain in ((minimum, lambda a, b: a if a < b else b), (maximum, lambda a, b: a if a > b else b)):
        wanted = bits(np.array([plain(a, b) for a, b in rows]))
        assert np.array_equal(bits(np.array([function(a, b) for a, b in rows])), wanted)
        for lanes in (1, 8):
            assert np.array_equal(bits(compiled(function, 0.0, 0.0, lanes=lanes)(np.array(rows))[:, 0]), wanted)


def cut(x):
    return elementary.to_integer(x)


def test_any_number_can_be_cut_to_an_integer():
    """NaN gives 0, what is too large the largest: nothing is undefined, and nothing crashes."""
    given = [math.nan, math.inf, -math.inf, 1e300, -1e300, 2.5, -2.5, 9.2e18, -9.2e18, 5e-324]
    top = float(2**63)
    for lanes, level in ((1, QUICK), (1, BEST), (8, QUICK), (8, BEST)):
        found = compiled(cut, 0.0, lanes=lanes, level=level)(np.array(given)[:, None])[:, 0]
        assert list(found) == [0.0, top, -top, top, -top, 2.0, -2.0, 9.2e18, -9.2e18, 0.0]


def test_rows_that_fill_no_block_are_those_of_whole_blocks():
    rows = np.random.default_rng(1).standard_normal((64, 3))
    block = compiled(fused(sum_of_a_product), 0.0, 0.0, 0.0, lanes=8)
    for count in (1, 7, 8, 9):
        assert np.array_equal(block(rows[:count]), block(rows)[:count])
