"""Compensated sums in graphs of floats: what is one, and how exact it is."""

import numpy as np

from tandemlift.compiler.single import compensated
from tandemlift.compiler.tracer import Graph
from tandemlift.compiler.tracer.symbol import Symbol, select

F = np.float32
OPERATIONS = {
    "fadd": lambda a, b: F(a + b),
    "fsub": lambda a, b: F(a - b),
    "fma": lambda a, b, c: F(np.float64(a) * np.float64(b) + np.float64(c)),
    "select": lambda condition, a, b: a if condition else b,
    "fcmp ogt": lambda a, b: a > b,
}


def inputs(*names):
    graph = Graph(real="float")
    return graph, [graph.input(name) for name in names]


def value(graph, node, given):
    op, args = graph.ops[node], graph.args[node]
    if op == "in":
        return F(given[args[0]])
    if op == "const":
        return F(np.frombuffer(args[0])[0])
    return OPERATIONS[op](*[value(graph, a, given) for a in args])


def summed(graph, root, old, rest, steps, **given):
    found = compensated(graph, root.node, old.node, rest.node)
    now = {"old": F(0.0), "rest": F(0.0), **given}
    for _ in range(steps):
        now["old"], now["rest"] = (value(graph, node, now) for node in found)
    return float(now["old"])


def test_100_000_additions_are_as_exact_as_a_float():
    graph, (old, rest, x) = inputs("old", "rest", "x")
    right, plain = 20_000 * float(F(0.1)), F(0.0)
    for _ in range(20_000):
        plain = F(plain + F(0.1))
    assert abs(float(plain) - right) > 1e-6 * right  # what a plain sum loses
    assert abs(summed(graph, old + x, old, rest, 20_000, x=0.1) - right) <= 6e-8 * right


def test_steps_too_small_for_a_float_are_not_lost():
    graph, (old, rest, x) = inputs("old", "rest", "x")
    assert F(F(8.0) + F(1e-7)) == F(8.0)
    found = compensated(graph, (old + x).node, old.node, rest.node)
    now = {"old": F(8.0), "rest": F(0.0), "x": F(1e-7)}
    for _ in range(10_000):
        now["old"], now["rest"] = (value(graph, node, now) for node in found)
    assert abs(float(now["old"]) - 8.001) < 1e-6


def test_a_chain_of_additions_is_one_sum():
    graph, (old, rest, x) = inputs("old", "rest", "x")
    chain = Symbol(graph, graph.node("fma", (x.node, x.node, (old + x).node), "f"), "f") - x
    right = 5_000 * float(F(0.3)) ** 2
    assert abs(summed(graph, chain, old, rest, 5_000, x=0.3) - right) <= 1e-6 * right


def test_where_a_sum_may_stay_or_begin_anew_what_is_left_over_stays_or_goes():
    graph, (old, rest, x) = inputs("old", "rest", "x")
    reset = compensated(graph, select(x > 0.0, old + x, 5.0).node, old.node, rest.node)
    stays = compensated(graph, select(x > 0.0, old + x, old).node, old.node, rest.node)
    now = {"old": F(1.0), "rest": F(1e-8), "x": F(-1.0)}
    assert [float(value(graph, node, now)) for node in reset] == [5.0, 0.0]
    assert [float(value(graph, node, now)) for node in stays] == [1.0, float(F(1e-8))]


def test_counts_filters_and_other_numbers_are_no_sums():
    graph, (old, rest, x) = inputs("old", "rest", "x")
    low_pass = Symbol(graph, graph.node("fma", (x.node, (x - old).node, old.node), "f"), "f")
    for other in (old + 1.0, low_pass, x + x, old * x, old + old, old):
        assert compensated(graph, other.node, old.node, rest.node) is None
