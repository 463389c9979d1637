"""Tangents and cotangents of graphs against closed forms and central differences; branches that are not selected."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tandemlift.analysis.linearization.derivative import Derivative
from tandemlift.compiler.machine_code.differentiated import cotangents, inlined, tangents
from tandemlift.compiler.tracer import Graph, traced
from tandemlift.core.algebra import absolute, atan2, clip, cos, exp, log, maximum, sin, sqrt, tanh, where
from tandemlift.parts.sensors.noise_bias_drift import displayed

LAWS = {  # of two numbers
    "sin and cos": lambda x, y: sin(x) * cos(y) + x,
    "exp and log": lambda x, y: exp(x * 0.3) * log(y * y + 0.5),
    "tanh and root": lambda x, y: tanh(x) / sqrt(y * y + 0.2),
    "angle": lambda x, y: atan2(x, y),
    "sizes": lambda x, y: absolute(x) * maximum(x, y) - clip(y, -0.4, 0.4),
    "choice": lambda x, y: where(x > y, x * x * y, y / (x * x + 1.0)),
    "a number used often": lambda x, y: (x + y) * (x + y) - x * (x - y) * x,
}


def gradient(law, *numbers):
    """The derivative of a law by its numbers, from one cotangent."""
    graph = Graph()
    symbols = [graph.input("x", i) for i in range(len(numbers))]
    end = traced(law)(*symbols)
    found = cotangents(graph, [(end.node, graph.input("bar"))], [s.node for s in symbols], {})
    return values(graph, [found[s.node].node for s in symbols], x=numbers, bar=[1.0])


def values(graph, nodes, **inputs):
    d = Derivative(graph)
    for kind, given in inputs.items():
        d.bind(kind, given)
    return d.values_of(nodes)


def value(law, *numbers):
    graph = Graph()
    end = traced(law)(*[graph.input("x", i) for i in range(len(numbers))])
    return values(graph, [end.node], x=numbers)[0]


@pytest.mark.parametrize("name", LAWS)
def test_cotangents_are_central_differences(name):
    law, h = LAWS[name], 1e-6
    for x, y in np.random.default_rng(3).uniform(-1.5, 1.5, (20, 2)):
        differences = [
            (value(law, x + h, y) - value(law, x - h, y)) / (2 * h),
            (value(law, x, y + h) - value(law, x, y - h)) / (2 * h),
        ]
        assert gradient(law, x, y) == pytest.approx(differences, rel=1e-7, abs=1e-8)


@pytest.mark.parametrize("name", LAWS)
def test_tangents_are_the_cotangents_times_the_direction(name):
    rng = np.random.default_rng(5)
    for x, y, dx, dy in rng.uniform(-1.5, 1.5, (20, 4)):
        graph = Graph()
        symbols = [graph.input("x", i) for i in (0, 1)]
        end = traced(LAWS[name])(*symbols)
        found = tangents(graph, [end.node], {s.node: graph.input("d", i) for i, s in enumerate(symbols)}, {})
        (moved,) = values(graph, [found[end.node].node], x=[x, y], d=[dx, dy])
        assert moved == pytest.approx(gradient(LAWS[name], x, y) @ [dx, dy], rel=1e-12, abs=1e-14)


def test_a_branch_that_divides_by_zero_and_is_not_selected_adds_nothing():
    def direction(x, y):  # of a vector, 0 for none
        size = sqrt(x * x + y * y)
        return where(size > 0.0, x * (1.0 / size), 0.5 * x)

    assert gradient(direction, 0.0, 0.0).tolist() == [0.5, 0.0]
    assert gradient(direction, 3.0, 4.0) == pytest.approx([16.0 / 125.0, -12.0 / 125.0])


def test_a_root_has_the_derivative_zero_at_zero():
    assert gradient(lambda x: sqrt(x * x), 0.0).tolist() == [0.0]


def test_a_sensors_resolution_is_a_straight_line():
    assert gradient(lambda x: traced(displayed)(x, 10.0, 0.01, 100.0), 1.2345) == pytest.approx([1.0])


def test_an_input_that_stands_for_a_node_has_its_own_value_and_the_derivative_of_the_node():
    graph = Graph()
    x, solved = graph.input("x"), graph.input("solved")
    root, end = sqrt(x), solved * solved * x  # of which a search has found the root
    made = inlined(graph, [end.node], {}, {solved.node: root.node})
    copy, stands_for = made[end.node].graph, {made[solved.node].node: made[root.node].node}
    found = cotangents(copy, [(made[end.node].node, copy.input("bar"))], [made[x.node].node], stands_for)
    (slope,) = values(copy, [found[made[x.node].node].node], x=[4.0], solved=[2.0], bar=[1.0])
    assert slope == pytest.approx(8.0)  # of x²
    assert math.isclose(values(copy, [made[end.node].node], x=[4.0], solved=[2.0])[0], 16.0)
