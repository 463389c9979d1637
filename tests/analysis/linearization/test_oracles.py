"""The derivative of a step of our graph against CasADi and JAX, which differentiate the same laws in plain Python."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from for_all import for_all
from linearized import PlainStep, linearized, local_jacobian

from tandemlift.analysis.linearization.derivative import Derivative, once_rounded
from tandemlift.compiler.tracer import Graph, traced
from tandemlift.core.algebra import absolute, atan2, clip, cos, exp, log, power, sin, sqrt, tanh, where
from tandemlift.parts.sensors.noise_bias_drift import displayed

MOVING = {"initial.euler": [0.05, -0.04, 0.1], "initial.position": [0.3, -0.2, 0.0], "initial.rates": [0.1, 0.2, -0.1]}
POINTS: dict[str, tuple[str, dict[str, Any], float]] = {
    "paper, pushed along x and tilted": ("paper", MOVING, 22.3),
    "iris in wind": ("iris", {"wind.model": "air", "wind.velocity": [2.0, 1.0, 0.0]}, 13.6),
    "zigzag, led by a person": ("zigzag", {}, 8.4),
    "pid with a payload off its place": (
        "one-push",
        {"controller.name": "pid", "pushes.0.point": [0.1, 0.8, 0.0]},
        3.9,
    ),
}


def shared_rows(of, count):
    """The rows that plain Python computes in the same way: it solves no limits, and has contact in the air too."""
    names = [of.recipe.graph.names[i] for i in of.recipe.choice.kept]
    return [i for i in range(count) if i >= len(names) or not names[i].startswith(("memory.allocation", "grip"))]


@pytest.mark.thorough
@pytest.mark.parametrize("which", POINTS)
def test_the_jacobian_is_that_by_casadi(which, casadi):
    """To 1e-9 of the largest entry of a row."""
    name, changes, at = POINTS[which]
    of = linearized(name, changes, at, steps=1)
    step, found = PlainStep(of.recipe), local_jacobian(of)
    x = casadi.SX.sym("x", len(step.x0))
    J = casadi.Function("J", [x], [casadi.jacobian(casadi.vertcat(*step(casadi.vertsplit(x))), x)])
    expected = np.array(J(step.x0))
    rows = shared_rows(of, len(found))
    size = 1e-3 + np.abs(expected).max(axis=1, keepdims=True)
    error = (np.abs(found - expected) / size)[rows]
    assert np.abs(expected).max() > 1.0
    assert error.max() < 1e-9, [(rows[i], j) for i, j in np.argwhere(error > 1e-9)[:5]]


@pytest.mark.thorough
def test_the_jacobian_along_a_random_direction_is_that_by_jax(jax):
    """Of all columns at once: JAX evaluates operation by operation, for XLA compiles a whole step for minutes."""
    name, changes, at = POINTS["paper, pushed along x and tilted"]
    of = linearized(name, changes, at, steps=1)
    step, found = PlainStep(of.recipe), local_jacobian(of)
    direction = np.random.default_rng(2).standard_normal(len(step.x0))
    _, moved = jax.jvp(lambda x: jax.numpy.stack(step(list(x))), (step.x0,), (direction,))
    rows, size = shared_rows(of, len(found)), 1e-3 + np.abs(found).max(axis=1)
    assert (np.abs(moved - found @ direction) / size)[rows].max() < 1e-9


ELEMENTARY = {
    "sin": (sin, math.cos),
    "cos": (cos, lambda x: -math.sin(x)),
    "exp": (exp, math.exp),
    "tanh": (tanh, lambda x: 1.0 / math.cosh(x) ** 2),
    "absolute": (absolute, lambda x: math.copysign(1.0, x)),
    "log": (lambda x: log(x * x + 0.1), lambda x: 2.0 * x / (x * x + 0.1)),
    "sqrt": (lambda x: sqrt(x * x + 0.1), lambda x: x / math.sqrt(x * x + 0.1)),
    "atan2": (lambda x: atan2(x, 0.3), lambda x: 0.3 / (x * x + 0.09)),
    "atan2 behind": (lambda x: atan2(x, -0.3), lambda x: -0.3 / (x * x + 0.09)),
    "power": (lambda x: power(x * x + 1.0, 1.7), lambda x: 3.4 * x * (x * x + 1.0) ** 0.7),
    "clip": (lambda x: clip(x, -1.0, 2.0), lambda x: 1.0 if -1.0 < x < 2.0 else 0.0),
    "where": (lambda x: where(x > 1.0, x * x, 3.0 * x), lambda x: 2.0 * x if x > 1.0 else 3.0),
}
PLACES = [-7.3, -2.2, -0.4, -1e-3, 1e-9, 0.3, 0.77, 1.9, 5.5, 20.1]


def derivative_of(function, x):
    """Of a function of one number, by our graph."""
    graph = Graph()
    made = traced(function)(graph.input("x"))
    d = Derivative(graph)
    d.bind("x", [x], [np.array([1.0])])
    return d.rows_of([made.node], 1)[0, 0]


@for_all(list(itertools.product(ELEMENTARY, PLACES)))
def test_each_operation_has_the_derivative_of_calculus(case):
    name, x = case
    function, expected = ELEMENTARY[name]
    assert derivative_of(function, x) == pytest.approx(expected(x), rel=1e-11, abs=1e-13)


def test_a_root_of_a_sum_of_squares_at_zero_has_the_derivative_zero():
    assert derivative_of(lambda x: sqrt(x * x), 0.0) == 0.0
    assert derivative_of(sqrt, 0.0) == math.inf


def test_a_sensors_resolution_is_a_straight_line_within_its_range():
    for x, expected in ((1.2345, 1.0), (12.3, 0.0)):
        graph = Graph()
        shown = traced(displayed)(graph.input("x"), 10.0, 0.01, 100.0)
        d = Derivative(graph)
        d.bind("x", [x], [np.array([1.0])])
        assert d.rows_of([shown.node], 1)[0, 0] == pytest.approx(expected)


def test_products_and_sums_are_rounded_once():
    from fractions import Fraction

    rng = np.random.default_rng(4)
    for a, b, c in rng.standard_normal((2000, 3)) * 10.0 ** rng.integers(-8, 8, (2000, 3)):
        c = c if c > 0.5 else -a * b * (1.0 + c * 1e-15)  # half of them cancel
        exact = Fraction(a) * Fraction(b) + Fraction(c)
        assert once_rounded(a, b, c) == float(exact)
