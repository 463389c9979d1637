"""Flights that step together from Python: `python benchmarks/blocks.py`.

Prints Markdown: calls of `tl.Block.step` with actions, of ten steps each, in double and in single precision, and whole
steps of the Gymnasium environment with random actions; optimised code, one thread. A time is the median over rounds of
the processor time of a call.
"""

from __future__ import annotations

import argparse
import os
import time
import warnings
from collections.abc import Callable
from statistics import median

import numpy as np
from machine import describe, heading, number, save, table

import tandemlift as tl

MISSIONS, LANES, STEPS = ("paper", "iris"), (1, 64, 1024), 10
TASK, INTERVAL = "Transport", 0.01  # s: ten steps as well
SPENT = 0.3  # s of a round
HEADER = ("", "lanes", "µs a call", "M actions/s", "M steps/s")


def best(block: tl.Block) -> None:
    """Wait for optimised code."""
    code = block._memory.code
    code.optimise()
    while not code.is_best:
        time.sleep(0.05)


def microseconds(call: Callable[[], object], again: Callable[[], object], rounds: int) -> float:
    """Of the processor for a call; `again` begins the flights anew, before they are over."""
    call()
    began = time.process_time()
    call()
    calls = max(3, min(500, int(SPENT / max(time.process_time() - began, 1e-6))))
    found = []
    for _ in range(rounds):
        again()
        began = time.process_time()
        for _ in range(calls):
            call()
        found.append((time.process_time() - began) / calls * 1e6)
    return median(found)


def of_block(name: str, lanes: int, rounds: int, precision: str = "double") -> float:
    block = tl.Block(name, lanes, threads=1, precision=precision)
    best(block)
    actions = np.full(block.actions.shape, 0.1)
    return microseconds(lambda: block.step(actions, steps=STEPS), block.reset, rounds)


def of_environment(lanes: int, rounds: int) -> float:
    from tandemlift.analysis.learning.gymnasium_environments import FlightVectorEnv

    envs = FlightVectorEnv(TASK, lanes, interval=INTERVAL, threads=1)
    best(envs.block)
    envs.reset(seed=0)
    actions = np.random.default_rng(0).uniform(-0.3, 0.3, envs.action_space.shape).astype(np.float32)
    return microseconds(lambda: envs.step(actions), lambda: envs.reset(seed=0), rounds)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5, help="that a median is taken over")
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    about, rows, results = describe(("tandemlift", "numpy", "llvmlite", "gymnasium")), [], {}
    for lanes in LANES:
        found = {f"`Block` of `{name}`": of_block(name, lanes, options.rounds) for name in MISSIONS}
        found |= {f"{name}, single": of_block(name[12:-1], lanes, options.rounds, "single") for name in [*found]}
        found[f"`tandemlift/{TASK}-v0`"] = of_environment(lanes, options.rounds)
        for what, taken in found.items():
            results[f"{what}, {lanes}"] = taken
            rows.append([what, str(lanes), number(taken), number(lanes / taken), number(STEPS * lanes / taken)])
    print(heading(about), table(HEADER, rows), sep="\n\n")
    print(f"\nMedians of {options.rounds}; load at the end {os.getloadavg()[0]:.2f}.")
    save(options.json, {"machine": about, "rows": results})


if __name__ == "__main__":
    main()
