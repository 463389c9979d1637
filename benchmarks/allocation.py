"""Speed of the solver of thrust limits: `python benchmarks/allocation.py [--json FILE] [--rounds N]`.

Vehicles of one to four IRIS quadrotors. Cold: wrenches that have nothing to do with each other, some rotors lost or
weak, from no working set. Warm: a wrench that moves smoothly, 1 ms a call, from the last call's working set. All are
out of the pseudo-inverse's reach. Every time is a median; nothing here asserts one.
"""

from __future__ import annotations

import argparse
import ctypes
import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np
from machine import describe, heading, number, pin, save, table

import tandemlift as tl
from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.compiler.machine_code.machine import BEST, Loaded
from tandemlift.compiler.machine_code.machine import compiled as machine_code
from tandemlift.compiler.tracer import Function, Module, double
from tandemlift.core.types import flat, leaves
from tandemlift.core.vector import Vec3, each
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import AllocationState, Mixer, weighted_rows, weights_of
from tandemlift.parts.rotors.thrust_limit_solver import BoundedProblem, Search, search_step, start_search
from tandemlift.simulation.preparation.limit_solver import TracedSolver, write_solver

PLACES = {
    1: [(0.0, 0.0)],
    2: [(0.0, 1.0), (0.0, -1.0)],
    3: [(0.9, 0.0), (-0.5, 0.8), (-0.5, -0.8)],
    4: [(0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8)],
}
PRIORITIES = (30.0, 900.0, 900.0, 1.0)
CALLS = 4000
SIZE = np.array([12.0, 6.0, 3.0, 2.0])  # N and N·m, of the wrench's motion about hover
ALL = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p)


def bounded(v: Vehicle, wanted: np.ndarray, unlimited: np.ndarray, limits: np.ndarray) -> BoundedProblem:
    """One problem."""
    rotors, weights = each(v.rotor_count), weights_of(v.effect, PRIORITIES)
    rows = Mixer(*[rotors(*map(float, row)) for row in weighted_rows(v.effect, weights)])
    thrust, *moment = map(float, wanted)
    w, *m = map(float, weights)
    values = [rotors(*map(float, x)) for x in (unlimited, limits)]
    return BoundedProblem(rows, Wrench(w, Vec3(*m)), Wrench(thrust, Vec3(*moment)), *values)


def in_a_row(like: BoundedProblem, warm: bool) -> Callable[[np.ndarray, np.ndarray], None]:
    """Machine code that solves problems one after another: of their changing numbers, and of memory for one of them."""
    module, solver, n = Module(), TracedSolver(like), len(like.limits)
    size = solver.problem_size
    fixed, search = size - 4 - 2 * n, size
    write_solver(module, solver, 1)
    f = Function(module, solver.graph, 1, "i64 @all(ptr noalias %problems, i64 %count, ptr noalias %s) #0")
    with f.repeat("%count") as k:
        problem = f.at("%problems", f.integer("mul", k, size - fixed))
        with f.repeat(size - fixed) as m:
            f.store(f.load(problem, m), "%s", f.integer("add", m, fixed))
        if not warm:
            with f.repeat(n) as i:
                f.store(f.zero, "%s", f.integer("add", i, search))
                f.store(f.load(problem, f.integer("add", i, 4)), "%s", f.integer("add", i, search + n))
        f.store(double(0.0), "%s", search + 2 * n + 2)
        f.do("call void @solve(ptr %s)")
    f.end("i64 0")
    code = Loaded(machine_code(module.text, BEST), ["all"])

    def run(problems: np.ndarray, memory: np.ndarray) -> None:
        ALL(code.addresses["all"])(problems.ctypes.data, len(problems), memory.ctypes.data)

    return run


def steps_of(like: BoundedProblem, problems: np.ndarray, warm: bool) -> np.ndarray:
    """The number of search steps of each problem."""
    n = len(like.limits)
    working = AllocationState(like.limits, like.limits)
    begin, step = (
        compiled(start_search, like.limits, working),
        compiled(search_step, like, Search(working, 0.0, 0.0, 0.0)),
    )
    fixed, taken, held = flat(like)[: -4 - 2 * n], np.zeros(len(problems)), np.zeros(2 * n)
    for k, problem in enumerate(problems):
        start = held if warm else np.concatenate([np.zeros(n), problem[4 : 4 + n]])
        x = begin(np.array([[*problem[-n:], *start]]))
        while not x[0, -1] and taken[k] < 8 * n:
            x, taken[k] = step(np.concatenate([[[*fixed, *problem]], x], axis=1)), taken[k] + 1
        held = x[0, : 2 * n]
    return taken


def vehicle(count: int) -> Vehicle:
    paper = tl.load_mission("paper").vehicle
    iris = paper.quadrotors[0]
    return Vehicle(paper.payload, [iris.model_copy(update={"position": (x, y, 0.075)}) for x, y in PLACES[count]])


def smooth(v: Vehicle, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches of a smooth motion and the limits, 1 ms apart."""
    t = np.arange(20 * CALLS)[:, None] * 1e-3
    waves = [rng.standard_normal(4) * np.sin(6.28 * f * t + rng.uniform(0.0, 6.28, 4)) for f in (0.3, 0.7, 1.1, 2.3, 5)]
    wanted = np.array([v.weight, 0.0, 0.0, 0.0]) + SIZE * sum(waves)
    return wanted, np.full((len(wanted), v.rotor_count), v.quadrotors[0].thrust_limit)


def unrelated(v: Vehicle, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches up to far out of reach, and limits, a tenth of them 0 and some lowered."""
    n = 20 * CALLS
    wanted = rng.standard_normal((n, 4)) * SIZE * rng.choice([0.5, 1.0, 4.0], (n, 1)) + [v.weight, 0.0, 0.0, 0.0]
    share = np.where(rng.random((n, 1)) < 0.2, rng.uniform(0.0, 1.0, (n, v.rotor_count)), 1.0)
    return wanted, v.quadrotors[0].thrust_limit * share * (rng.random((n, v.rotor_count)) > 0.1)


def measured(v: Vehicle, warm: bool, rounds: int) -> dict[str, float]:
    """Time of a call [ns], and the steps that it takes."""
    wanted, limits = (smooth if warm else unrelated)(v, np.random.default_rng(v.count))
    unlimited = wanted @ v.allocation().T
    beyond = np.flatnonzero(np.any((unlimited < 0.0) | (unlimited > limits), axis=1))[:CALLS]
    like = bounded(v, wanted[0], unlimited[0], limits[0])
    problems = np.ascontiguousarray(np.hstack([wanted, unlimited, limits])[beyond])
    run, memory = in_a_row(like, warm), np.zeros(leaves(like) + 2 * v.rotor_count + 3)
    memory[: leaves(like)] = flat(like)
    run(problems, memory)
    taken = []
    for _ in range(rounds):
        began = time.perf_counter()
        run(problems, memory)
        taken.append((time.perf_counter() - began) / len(beyond) * 1e9)
    steps = steps_of(like, problems, warm)
    return {"ns": median(taken), "mean_steps": float(steps.mean()), "most_steps": float(steps.max())}


def report(about: dict[str, Any], speeds: dict[str, dict[str, float]]) -> str:
    rows = [[name, *(number(s[key]) for key in ("ns", "mean_steps", "most_steps"))] for name, s in speeds.items()]
    return f"{heading(about)}\n\n{table(['quadrotors', 'ns a call', 'steps, mean', 'steps, most'], rows)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    parser.add_argument("--rounds", type=int, default=15, help="rounds that a median is taken over")
    options = parser.parse_args()
    about = describe(("tandemlift", "llvmlite", "numpy"))
    pin(1)
    starts = {"cold": False, "warm": True}
    speeds = {
        f"{count}, {name}": measured(vehicle(count), warm, options.rounds)
        for count in PLACES
        for name, warm in starts.items()
    }
    print(report(about, speeds))
    save(options.json, {"machine": about, "allocation": speeds})


if __name__ == "__main__":
    main()
