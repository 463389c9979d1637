"""The derivative of a step of our graph against CasADi, which differentiates the same laws in plain Python."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from linearized import PlainStep, linearized, local_jacobian

MOVING = {"initial.euler": [0.05, -0.04, 0.1], "initial.position": [0.3, -0.2, 0.0], "initial.rates": [0.1, 0.2, -0.1]}
POINTS: dict[str, tuple[str, dict[str, Any], float]] = {
    "paper, pushed along x and tilted": ("paper", MOVING, 22.3),
    "hover, lifting off": ("hover", MOVING, 2.2),
    "iris, pushed": ("iris", {}, 13.6),
    "iris in wind": ("iris", {"wind.model": "air", "wind.velocity": [2.0, 1.0, 0.0]}, 13.6),
    "zigzag, led by a person": ("zigzag", {}, 8.4),
    "pid with a payload off its place": (
        "one-push",
        {"controller.name": "pid", "pushes.0.point": [0.1, 0.8, 0.0]},
        3.9,
    ),
}


@cache
def at_point(which):
    name, changes, at = POINTS[which]
    of = linearized(name, changes, at, steps=1)
    return of, PlainStep(of.recipe), local_jacobian(of)


@pytest.fixture(params=POINTS)
def point(request):
    return at_point(request.param)


def shared_rows(of, count):
    """The rows that plain Python computes in the same way: it solves no limits, and has contact in the air too."""
    names = [of.recipe.graph.names[i] for i in of.recipe.choice.kept]
    return [i for i in range(count) if i >= len(names) or not names[i].startswith(("memory.allocation", "grip"))]


def check_agreement(of, found, expected):
    """To 1e-9 of the largest entry of a row."""
    rows = shared_rows(of, len(found))
    size = 1e-3 + np.abs(expected).max(axis=1, keepdims=True)
    error = (np.abs(found - expected) / size)[rows]
    assert np.abs(expected).max() > 1.0
    assert error.max() < 1e-9, [(rows[i], j) for i, j in np.argwhere(error > 1e-9)[:5]]


def test_the_values_are_those_of_plain_python(point):
    of, step, _ = point
    r, d = of
    nodes = [*[r.graph.next[i] for i in r.choice.kept], *r.outputs]
    found, expected = d.steps[0].nodes.values_of(nodes), np.array(step([float(v) for v in step.x0]))
    rows = shared_rows(of, len(found))
    assert found[rows] == pytest.approx(expected[rows], rel=1e-9, abs=1e-9)


def test_the_jacobian_is_that_by_casadi(point, casadi):
    of, step, found = point
    x = casadi.SX.sym("x", len(step.x0))
    J = casadi.Function("J", [x], [casadi.jacobian(casadi.vertcat(*step(casadi.vertsplit(x))), x)])
    check_agreement(of, found, np.array(J(step.x0)))
