"""How fast thrusts within limits are found: `python benchmarks/allocation.py [--json FILE] [--rounds N]`.

Vehicles of one to four IRIS quadrotors. Cold: wrenches that have nothing to do with each other, some rotors lost or
weak, from no working set. Warm: a wrench that moves smoothly, 1 ms a call, from the last call's working set. All are
out of the pseudo-inverse's reach. Every time is a median; nothing here asserts one.
"""

from __future__ import annotations

import argparse
import time
from statistics import median
from typing import Any

import numba
import numpy as np
from machine import describe, heading, number, pin, save, table
from numba.extending import register_jitable

import tandemlift as tl
from tandemlift.laws.limits import PARTS, limited, weighted_rows, weights_of
from tandemlift.vehicle import Vehicle

PLACES = {
    1: [(0.0, 0.0)],
    2: [(0.0, 1.0), (0.0, -1.0)],
    3: [(0.9, 0.0), (-0.5, 0.8), (-0.5, -0.8)],
    4: [(0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8)],
}
PRIORITIES, GAMMA = (30.0, 900.0, 900.0, 1.0), 1e-3
CALLS = 4000
SIZE = np.array([12.0, 6.0, 3.0, 2.0])  # N and N·m, of the wrench's motion about hover

for _part in PARTS:
    register_jitable(forceinline=True, error_model="numpy")(_part)
solve = numba.njit(error_model="numpy")(limited)


@numba.njit(error_model="numpy")
def solve_all(rows, weights, wanted, unlimited, limits, warm, steps):
    n = rows.shape[1]
    active, f, scratch = np.zeros(n), np.zeros(n), np.zeros(n)
    for k in range(len(wanted)):
        if not warm:
            active[:] = 0.0
            f[:] = unlimited[k]
        steps[k] = solve(rows, weights, wanted[k], unlimited[k], limits[k], GAMMA, active, f, scratch, 8 * n)


def vehicle(count: int) -> Vehicle:
    paper = tl.load_mission("paper").vehicle
    iris = paper.quadrotors[0]
    return Vehicle(paper.payload, [iris.model_copy(update={"position": (x, y, 0.075)}) for x, y in PLACES[count]])


def smooth(v: Vehicle, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches of a smooth motion and the limits, 1 ms apart."""
    t = np.arange(20 * CALLS)[:, None] * 1e-3
    waves = [rng.standard_normal(4) * np.sin(6.28 * f * t + rng.uniform(0.0, 6.28, 4)) for f in (0.3, 0.7, 1.1, 2.3, 5)]
    wanted = np.array([v.weight, 0.0, 0.0, 0.0]) + SIZE * sum(waves)
    return wanted, np.full((len(wanted), v.rotor_count), v.quadrotors[0].max_thrust)


def unrelated(v: Vehicle, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches up to far out of reach, and limits, a tenth of them 0 and some lowered."""
    n = 20 * CALLS
    wanted = rng.standard_normal((n, 4)) * SIZE * rng.choice([0.5, 1.0, 4.0], (n, 1)) + [v.weight, 0.0, 0.0, 0.0]
    share = np.where(rng.random((n, 1)) < 0.2, rng.uniform(0.0, 1.0, (n, v.rotor_count)), 1.0)
    return wanted, v.quadrotors[0].max_thrust * share * (rng.random((n, v.rotor_count)) > 0.1)


def measured(v: Vehicle, warm: bool, rounds: int) -> dict[str, float]:
    """Time of a call [ns], and the steps that it takes."""
    wanted, limits = (smooth if warm else unrelated)(v, np.random.default_rng(v.count))
    unlimited = wanted @ v.allocation().T
    beyond = np.flatnonzero(np.any((unlimited < 0.0) | (unlimited > limits), axis=1))[:CALLS]
    weights, steps = weights_of(v.effect, PRIORITIES), np.zeros(len(beyond))
    problem = weighted_rows(v.effect, weights), weights, wanted[beyond], unlimited[beyond], limits[beyond], warm, steps
    solve_all(*problem)
    taken = []
    for _ in range(rounds):
        began = time.perf_counter()
        solve_all(*problem)
        taken.append((time.perf_counter() - began) / len(beyond) * 1e9)
    return {"ns": median(taken), "mean_steps": float(steps.mean()), "most_steps": float(steps.max())}


def report(about: dict[str, Any], speeds: dict[str, dict[str, float]]) -> str:
    rows = [[name, *(number(s[key]) for key in ("ns", "mean_steps", "most_steps"))] for name, s in speeds.items()]
    return f"{heading(about)}\n\n{table(['quadrotors', 'ns a call', 'steps, mean', 'steps, most'], rows)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    parser.add_argument("--rounds", type=int, default=15, help="rounds that a median is taken over")
    options = parser.parse_args()
    about = describe(("tandemlift", "numba", "numpy"))
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
