"""What the tests of allocation within limits share: vehicles, wrenches, the solver, two other ways to the optimum."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from numba.extending import register_jitable
from scipy.optimize import lsq_linear

from tandemlift.laws.limits import PARTS, limited, weighted_rows, weights_of
from tandemlift.vehicle import Vehicle

from .helpers import BEAM, quadrotor

PRIORITIES, GAMMA = (30.0, 900.0, 900.0, 1.0), 1e-3
LIMIT = 7.066  # N, of IRIS
PLACES = {
    1: [(0.0, 0.0)],
    2: [(0.0, 1.0), (0.0, -1.0)],
    3: [(0.9, 0.0), (-0.5, 0.8), (-0.5, -0.8)],
    4: [(0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8)],
}
VEHICLES = [(count, layout) for count in PLACES for layout in ("+", "x")]
EVERY = pytest.mark.parametrize(("count", "layout"), VEHICLES)

for _part in PARTS:
    register_jitable(forceinline=True, error_model="numpy")(_part)  # as the kernels do: a process may fly afterwards
compiled = numba.njit(error_model="numpy")(limited)


class Craft(NamedTuple):
    """A vehicle, its effect B, what the pseudo-inverse asks for a wrench, and the weighted problem."""

    vehicle: Vehicle
    B: np.ndarray
    inverse: np.ndarray
    weights: np.ndarray
    rows: np.ndarray


class Problem(NamedTuple):
    """A wanted wrench, what the pseudo-inverse asks for it, and the limits."""

    wanted: np.ndarray
    unlimited: np.ndarray
    limits: np.ndarray


class Answer(NamedTuple):
    """Thrusts, working set, number of steps."""

    f: np.ndarray
    active: np.ndarray
    steps: int


def craft_of(v: Vehicle) -> Craft:
    weights = weights_of(v.effect, PRIORITIES)
    return Craft(v, v.effect, v.allocation(), weights, weighted_rows(v.effect, weights))


@cache
def craft(count: int, layout: str) -> Craft:
    return craft_of(Vehicle(BEAM, [quadrotor((x, y, 0.075), layout=layout) for x, y in PLACES[count]]))


def problem(c: Craft, wanted: Any, lost: Any = ()) -> Problem:
    limits = np.full(c.B.shape[1], LIMIT)
    limits[list(lost)] = 0.0
    return Problem(np.array(wanted, float), c.inverse @ wanted, limits)


def problems(c: Craft, number: int, seed: int = 0) -> Iterator[Problem]:
    """Wrenches from hover to far out of reach; often one or two rotors lost, sometimes all weakened."""
    rng, n = np.random.default_rng(seed), c.B.shape[1]
    for _ in range(number):
        far = rng.choice([0.3, 1.0, 4.0])
        wanted = [c.vehicle.weight * rng.uniform(0.0, 2.0), *(rng.standard_normal(3) * [8.0, 3.0, 1.5] * far)]
        p = problem(c, wanted, rng.choice(n, rng.choice([0, 0, 0, 1, 2]), replace=False))
        yield p if rng.random() < 0.8 else p._replace(limits=p.limits * rng.uniform(0.0, 1.0, n))


def solve(c: Craft, p: Problem, start: Answer | None = None, run: Any = compiled, most: int | None = None) -> Answer:
    n = len(p.limits)
    f, active = (np.zeros(n), np.zeros(n)) if start is None else (start.f.copy(), start.active.copy())
    steps = run(c.rows, c.weights, p.wanted, p.unlimited, p.limits, GAMMA, active, f, np.zeros(n), most or 8 * n)
    assert np.all(f >= 0.0)
    assert np.all(f <= np.maximum(p.limits, 0.0))
    return Answer(f, active, steps)


def cost(c: Craft, p: Problem, f: np.ndarray) -> float:
    return float(np.sum((c.rows @ f - c.weights * p.wanted) ** 2) + GAMMA * np.sum((f - p.unlimited) ** 2))


def outside(p: Problem) -> bool:
    return bool(np.any((p.unlimited < 0.0) | (p.unlimited > p.limits)))


def exact_solution(A: list[list[Fraction]], b: list[Fraction]) -> list[Fraction]:
    """A⁻¹ b by elimination, A positive definite."""
    rows = [[*row, x] for row, x in zip(A, b, strict=True)]
    for k in range(len(rows)):
        pivot = [x / rows[k][k] for x in rows[k]]
        rows = [pivot if i == k else [x - r[k] * y for x, y in zip(r, pivot, strict=True)] for i, r in enumerate(rows)]
    return [row[-1] for row in rows]


def fractions(values: Any) -> list[Fraction]:
    return [Fraction(float(x)) for x in values]


def exact_optimum(c: Craft, p: Problem, active: np.ndarray) -> np.ndarray:
    """The optimum by exact arithmetic, proven by the conditions of Karush, Kuhn and Tucker; `active`: where to look.

    The cost is strictly convex, so thrusts within limits that are f₀ + Cᵀλ clipped to them, with γλ = W(τ − B f), are
    the only optimum.
    """
    w, tau, f0, top, gamma = *map(fractions, (c.weights, p.wanted, p.unlimited, p.limits)), Fraction(GAMMA)
    columns = [[wj * bj for wj, bj in zip(w, fractions(column), strict=True)] for column in c.B.T]
    held = [a != 0 for a in active]
    base = [(t if a > 0 else Fraction(0)) if h else x for a, h, t, x in zip(active, held, top, f0, strict=True)]
    left = [w[j] * tau[j] - sum(col[j] * b for col, b in zip(columns, base, strict=True)) for j in range(4)]
    free = [col for col, h in zip(columns, held, strict=True) if not h]
    A = [[sum(col[j] * col[k] for col in free) + gamma * (j == k) for k in range(4)] for j in range(4)]
    multipliers = exact_solution(A, left)
    asked = [x + sum(a * m for a, m in zip(col, multipliers, strict=True)) for x, col in zip(f0, columns, strict=True)]
    f = [b if h else x for b, h, x in zip(base, held, asked, strict=True)]
    slack = Fraction(1, 10**8)  # N: a rotor so close to changing sides may be on either
    for x, a, ask, t in zip(f, active, asked, top, strict=True):
        assert -slack <= x <= t + slack
        assert t == 0 or a == 0 or (ask <= slack if a < 0 else ask >= t - slack)
    return np.array([float(x) for x in f])


def bounded_least_squares(c: Craft, p: Problem) -> np.ndarray:
    """The optimum by SciPy, of the rotors that have any limit."""
    live, root = p.limits > 0.0, np.sqrt(GAMMA)
    A = np.vstack([c.rows[:, live], root * np.eye(live.sum())])
    b = np.hstack([c.weights * p.wanted, root * p.unlimited[live]])
    f = np.zeros(len(live))
    f[live] = lsq_linear(A, b, (0.0, p.limits[live]), method="bvls", tol=1e-15, max_iter=500).x
    return f
