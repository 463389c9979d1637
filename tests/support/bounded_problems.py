"""Shared by tests of allocation within limits: vehicles, wrenches, the solver, and two other ways to the optimum."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from law_values import BEAM, quadrotor
from scipy.optimize import lsq_linear

from tandemlift.compiler.machine_code.machine import BEST, QUICK, Loaded
from tandemlift.compiler.machine_code.machine import compiled as object_code
from tandemlift.compiler.tracer import Function, Module, Place
from tandemlift.core.caching import LastUsed
from tandemlift.core.types import flat
from tandemlift.core.vector import each, vec3
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import AllocationState, Mixer, weighted_rows, weights_of
from tandemlift.parts.rotors.normal_equations import GAMMA
from tandemlift.parts.rotors.thrust_limit_solver import BoundedProblem
from tandemlift.simulation.preparation.limit_solver import TracedSolver, write_solver

PRIORITIES = (30.0, 900.0, 900.0, 1.0)
LIMIT = 7.066  # N, of IRIS
PLACES = {
    1: [(0.0, 0.0)],
    2: [(0.0, 1.0), (0.0, -1.0)],
    3: [(0.9, 0.0), (-0.5, 0.8), (-0.5, -0.8)],
    4: [(0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8)],
}
EVERY = pytest.mark.parametrize(("count", "layout"), [(1, "x"), (2, "+"), (2, "x"), (4, "+")])


class Craft(NamedTuple):
    """A vehicle, its matrix B, the pseudo-inverse solution for a wrench, and the weighted problem."""

    vehicle: Vehicle
    B: np.ndarray
    inverse: np.ndarray
    weights: np.ndarray
    rows: np.ndarray


class Problem(NamedTuple):
    """A desired wrench, the pseudo-inverse solution for it, and the limits."""

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


def wrench_of(values: Any) -> Wrench:
    return Wrench(float(values[0]), vec3(values[1:]))


def set_of(values: Any) -> Any:
    """One number for each rotor."""
    return each(len(values))(*map(float, values))


def asked(c: Craft, p: Problem) -> BoundedProblem:
    """The terms of the cost, as values."""
    rows = Mixer(*map(set_of, c.rows))
    return BoundedProblem(rows, wrench_of(c.weights), wrench_of(p.wanted), set_of(p.unlimited), set_of(p.limits))


class Code:
    """The solver for a number of rotors in machine code: `solve`, as in flight, for lanes of problems, and `search`.

    `search` takes at most a given number of steps and returns the number taken; otherwise it is the same. Sets of
    `rolls_from` rotors or more are loops, none if it is 0.
    """

    def __init__(self, bounded: BoundedProblem, lanes: int, rolls_from: int) -> None:
        self.lanes, solver, module = lanes, TracedSolver(bounded, rolls_from), Module()
        self.begin, self.end = solver.problem_size, solver.problem_size + 2 * solver.rotors + 3
        write_solver(module, solver, lanes)
        module.functions[-1] = module.functions[-1].replace("internal void", "void")
        if lanes == 1:
            self._write_search(module, solver)
        level = BEST if solver.rotors <= 16 else QUICK
        names = ["solve", "search"] if lanes == 1 else ["solve"]
        self.code = Loaded(object_code(module.text, level), names)
        self.solve = ctypes.CFUNCTYPE(None, ctypes.c_void_p)(self.code.addresses["solve"])
        if lanes == 1:
            counted = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64)
            self.search = counted(self.code.addresses["search"])

    def _write_search(self, module: Module, solver: TracedSolver) -> None:
        f = Function(module, solver.graph, 1, "i64 @search(ptr noalias %s, i64 %most) #0")
        f.read = {"problem": lambda i: Place("%s", i), "search": lambda i: Place("%s", self.begin + i)}
        for values in (solver.begun, solver.after):
            if values is solver.after:
                f.label("first")
                f.label("search")
                f.lines.append("  %step = phi i64 [ 1, %first ], [ %next, %goes_on ]")
            with f.scope():
                f.put("%s", self.begin, values, "search")
        ended = f.op(f"fcmp one double {f.load('%s', self.end - 1)}, 0.0")
        last = f.op("icmp sge i64 %step, %most")
        f.do(f"br i1 {f.op(f'or i1 {ended}, {last}')}, label %done, label %goes_on")
        f.lines += ["goes_on:", "  %next = add i64 %step, 1", "  br label %search", "done:"]
        f.end("i64 %step")

    def numbers(self, bounded: BoundedProblem, held: AllocationState) -> np.ndarray:
        """A problem, the start of its search, and memory for its flags."""
        return np.array([*flat(bounded), *flat(held), 0.0, 0.0, 0.0])


CODES = LastUsed[Code](32)


def code_of(bounded: BoundedProblem, lanes: int = 1, rolls_from: int = 0) -> Code:
    key = len(bounded.limits), lanes, rolls_from
    return CODES.of(key, lambda: Code(bounded, lanes, rolls_from))


def compiled(p: BoundedProblem, held: AllocationState, most: int) -> tuple[AllocationState, int]:
    """`limited` in machine code."""
    code, n = code_of(p), len(p.limits)
    numbers = code.numbers(p, held)
    steps = code.search(numbers.ctypes.data, most)
    active, thrusts = numbers[code.begin : code.begin + n], numbers[code.begin + n : code.begin + 2 * n]
    return AllocationState(set_of(active), set_of(thrusts)), steps


def solve(c: Craft, p: Problem, start: Answer | None = None, run: Any = compiled, most: int | None = None) -> Answer:
    n = len(p.limits)
    f, active = (np.zeros(n), np.zeros(n)) if start is None else (start.f, start.active)
    found, steps = run(asked(c, p), AllocationState(set_of(active), set_of(f)), most or 8 * n)
    f, active = np.array(found.thrusts), np.array(found.active)
    assert np.all(f >= 0.0)
    assert np.all(f <= np.maximum(p.limits, 0.0))
    return Answer(f, active, steps)


def cost(c: Craft, p: Problem, f: np.ndarray) -> float:
    return float(np.sum((c.rows @ f - c.weights * p.wanted) ** 2) + GAMMA * np.sum((f - p.unlimited) ** 2))


def outside(p: Problem) -> bool:
    return bool(np.any((p.unlimited < 0.0) | (p.unlimited > p.limits)))


def bounded_least_squares(c: Craft, p: Problem) -> np.ndarray:
    """The optimum by SciPy for the rotors that have a limit."""
    live, root = p.limits > 0.0, np.sqrt(GAMMA)
    A = np.vstack([c.rows[:, live], root * np.eye(live.sum())])
    b = np.hstack([c.weights * p.wanted, root * p.unlimited[live]])
    f = np.zeros(len(live))
    f[live] = lsq_linear(A, b, (0.0, p.limits[live]), method="bvls", tol=1e-15, max_iter=500).x
    return f
