"""Gradients through a flight: `python benchmarks/gradients.py`. It needs JAX; PyTorch too for its columns.

Prints Markdown: a closed loop of 2 s at 1 kHz by `tl.jax_step` in `lax.scan`, forward, with the gradient by a push, and
with that by all parameters too; and a single call of a step of `paper` by NumPy, JAX and PyTorch. One thread; a time is
the median over rounds of the processor time of a call, compiled before.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable, Iterator
from statistics import median
from typing import Any

import numpy as np
from machine import describe, heading, number, pin, save, table, version

os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
MISSIONS = {"paper": 6.0, "iris": 12.0}  # the time at which the loop begins [s]
STEPS, CALLS, LANES = 2000, 200, (1, 256)
HEADER = ("mission", "forward, µs a step", "with gradient by push", "ratio", "and by parameters", "ratio")
CALL_HEADER = ("lanes", "", "µs a call", "with gradient by push")
PUSH = np.array([0.5, 0.2, -0.1])


def microseconds(call: Callable[[], Any], rounds: int, calls: int = 1) -> float:
    """Of the processor for a call."""
    import jax

    jax.block_until_ready(call())
    found = []
    for _ in range(rounds):
        began = time.process_time()
        for _ in range(calls):
            jax.block_until_ready(call())
        found.append((time.process_time() - began) / calls * 1e6)
    return median(found)


def times_of(name: str, begin: float, rounds: int) -> list[float]:
    """For a step of a flight: forward, with the gradient by the push, and with that by parameters too."""
    import jax

    import tandemlift as tl

    step, push = tl.jax_step(name, begin=begin), jax.numpy.array(PUSH)

    def loss(parameters: Any, push: Any) -> Any:
        def one(state: Any, _: None) -> tuple[Any, None]:
            return step(state, parameters, push), None

        state, _ = jax.lax.scan(one, step.state, None, length=STEPS)
        return jax.numpy.sum(step.read(state - step.state, "position") ** 2)

    calls = [jax.jit(f) for f in (loss, jax.value_and_grad(loss, 1), jax.value_and_grad(loss, (0, 1)))]
    return [microseconds(lambda f=f: f(step.parameters, push), rounds) / STEPS for f in calls]


def calls_of(lanes: int) -> Iterator[tuple[str, Callable[[], Any], Callable[[], Any]]]:
    """A name, a call of a step with as many lanes, and one with the gradient by the push."""
    import jax

    import tandemlift as tl

    step = tl.jax_step("paper", begin=MISSIONS["paper"])
    state, push = (np.repeat(x[None], lanes, axis=0) for x in (step.state, PUSH))
    own = step.compiled

    def with_cotangents() -> Any:
        states = own.advance(state, step.parameters, push[:, None], 1)
        return own.cotangent(state, step.parameters, push[:, None], states, states, by_parameters=False)

    yield "NumPy", lambda: own.advance(state, step.parameters, push[:, None], 1), with_cotangents

    forward = jax.vmap(step, (0, None, 0))
    given = [jax.numpy.asarray(x) for x in (state, step.parameters, push)]
    compiled = jax.jit(forward)
    gradient = jax.jit(jax.grad(lambda *x: forward(*x).sum(), 2))
    yield "JAX, `jit`", lambda: compiled(*given), lambda: gradient(*given)
    if version("torch"):
        import torch

        torch.set_num_threads(1)
        by_torch = tl.torch_step("paper", begin=MISSIONS["paper"])
        start, parameters, action = (torch.from_numpy(np.array(x)) for x in given)
        moved = action.clone().requires_grad_()
        yield (
            "PyTorch",
            lambda: by_torch(start, parameters, action),
            lambda: torch.autograd.grad(by_torch(start, parameters, moved).sum(), moved),
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--json", help="file for the numbers")
    given = parser.parse_args()
    import jax

    jax.config.update("jax_enable_x64", True)
    pin(1)
    about = describe(("tandemlift", "jax", "torch"))
    print(heading(about))
    times = {name: times_of(name, begin, given.rounds) for name, begin in MISSIONS.items()}
    rows = [
        (f"`{name}`", number(a), number(b), number(b / a), number(c), number(c / a))
        for name, (a, b, c) in times.items()
    ]
    print(table(HEADER, rows))
    single = {
        (str(lanes), name): [microseconds(f, given.rounds, CALLS) for f in calls]
        for lanes in LANES
        for name, *calls in calls_of(lanes)
    }
    print("\n" + table(CALL_HEADER, [(*of, *map(number, found)) for of, found in single.items()], texts=2))
    if given.json:
        by_call = {f"{lanes} lanes, {name}": found for (lanes, name), found in single.items()}
        save(given.json, {"machine": about, "us_a_step": times, "us_a_call": by_call})


if __name__ == "__main__":
    main()
