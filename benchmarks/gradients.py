"""Gradients through a flight by `tl.jax_step`: `python benchmarks/gradients.py`. It needs JAX.

Prints Markdown: a closed loop of 2 s at 1 kHz in `lax.scan`, forward, with the gradient by a push, and with that by all
parameters too. One thread; a time is the median over rounds of the processor time of a call, compiled before.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from statistics import median
from typing import Any

from machine import describe, heading, number, pin, save, table

os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
MISSIONS = {"paper": 6.0, "iris": 12.0}  # the time at which the loop begins [s]
STEPS = 2000
HEADER = ("mission", "forward, µs a step", "with gradient by push", "ratio", "and by parameters", "ratio")


def microseconds(call: Callable[[], Any], rounds: int) -> float:
    """Of the processor for a step."""
    import jax

    jax.block_until_ready(call())
    found = []
    for _ in range(rounds):
        began = time.process_time()
        jax.block_until_ready(call())
        found.append((time.process_time() - began) / STEPS * 1e6)
    return median(found)


def times_of(name: str, begin: float, rounds: int) -> tuple[float, float, float]:
    """Forward, with the gradient by the push, and with that by parameters too."""
    import jax

    import tandemlift as tl

    jax.config.update("jax_enable_x64", True)
    step, push = tl.jax_step(name, begin=begin), jax.numpy.array([0.5, 0.2, -0.1])

    def loss(parameters: Any, push: Any) -> Any:
        def one(state: Any, _: None) -> tuple[Any, None]:
            return step(state, parameters, push), None

        state, _ = jax.lax.scan(one, step.state, None, length=STEPS)
        return jax.numpy.sum(step.read(state - step.state, "position") ** 2)

    calls = [jax.jit(f) for f in (loss, jax.value_and_grad(loss, 1), jax.value_and_grad(loss, (0, 1)))]
    forward, by_push, by_all = (microseconds(lambda f=f: f(step.parameters, push), rounds) for f in calls)
    return forward, by_push, by_all


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--json", help="file for the numbers")
    given = parser.parse_args()
    pin(1)
    about = describe(("tandemlift", "jax"))
    print(heading(about))
    times = {name: times_of(name, begin, given.rounds) for name, begin in MISSIONS.items()}
    rows = [
        (f"`{name}`", number(a), number(b), number(b / a), number(c), number(c / a))
        for name, (a, b, c) in times.items()
    ]
    print(table(HEADER, rows))
    if given.json:
        save(given.json, {"machine": about, "us_a_step": times})


if __name__ == "__main__":
    main()
