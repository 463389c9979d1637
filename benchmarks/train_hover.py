"""A policy that hovers, trained from nothing by gradients through the flight: `python benchmarks/train_hover.py`.

The policy is a network of 12 inputs, 32 hidden units and a wrench, every 10 ms. It begins with random weights. Adam
trains it on flights of 2 s in mission `hover`, from random starts, with the gradients of `tl.jax_step`. Then it flies
from other starts for 10 s. Needs JAX. One thread; wall time.
"""

from __future__ import annotations

import argparse
import os
import time
from typing import Any

os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1")

import jax
import numpy as np
from jax import numpy as jnp
from machine import describe, heading, number, table

import tandemlift as tl

HIDDEN, LANES, SECONDS, ROUNDS, RATE = 32, 16, 2.0, 350, 0.01
SPREAD = np.repeat([0.3, 0.3, 0.15, 0.3], 3)  # m, m/s, rad, rad/s: standard deviations of a start
WIDER = 1.3  # starts of the training, over those of the test
WEIGHTS = np.repeat([1.0, 0.1, 0.1, 0.02], 3)  # of squared errors

jax.config.update("jax_enable_x64", True)
STEP = tl.jax_step("hover", actions="thrusts", steps=10, begin=6.0)
VEHICLE = tl.Vehicle.from_settings(tl.load_mission("hover").vehicle)
SPLIT = jnp.array(VEHICLE.allocation())
HOVER = jnp.array([VEHICLE.weight, 0.0, 0.0, 0.0])
REACH = jnp.array([0.5 * VEHICLE.weight, 10.0, 0.5, 0.3])  # N, N m: of an output of 1
GOAL = STEP.read(STEP.state, "position")


def errors(state: Any) -> Any:
    """Position [m], velocity [m/s], attitude [rad] and rates [rad/s] (12), as errors from level rest at the goal."""
    attitude = STEP.read(state, "attitude")
    turn = 2.0 * jnp.sign(attitude[0]) * attitude[1:]
    return jnp.concatenate(
        [STEP.read(state, "position") - GOAL, STEP.read(state, "velocity"), turn, STEP.read(state, "rates")]
    )


def thrusts(policy: Any, state: Any) -> Any:
    """The thrusts of all rotors [N] by the network."""
    hidden = jnp.tanh(policy["hidden"] @ (errors(state) / SPREAD))
    return SPLIT @ (HOVER + REACH * jnp.tanh(policy["output"] @ hidden))


def started(noise: Any) -> Any:
    """The state at the start, with errors `noise` (12)."""
    turn = 0.5 * noise[6:9]
    attitude = jnp.concatenate([jnp.ones(1), turn]) / jnp.sqrt(1.0 + turn @ turn)
    parts = {"position": GOAL + noise[:3], "velocity": noise[3:6], "attitude": attitude, "rates": noise[9:]}
    state = jnp.asarray(STEP.state)
    for name, value in parts.items():
        state = state.at[STEP.places[name]].set(value)
    return state


def flown(policy: Any, noise: Any, seconds: float) -> Any:
    """The errors (time, 12) of a flight from a start."""

    def advance(state: Any, _: Any) -> Any:
        state = STEP(state, None, thrusts(policy, state))
        return state, errors(state)

    return jax.lax.scan(advance, started(noise), None, length=round(100 * seconds))[1]


@jax.jit
@jax.value_and_grad
def loss(policy: Any, noise: Any) -> Any:
    """The mean weighted square of the errors of all flights (lanes, 12)."""
    return jnp.mean(jax.vmap(lambda start: flown(policy, start, SECONDS) ** 2 @ WEIGHTS)(noise))


def adam(policy: Any, slope: Any, memory: tuple[Any, Any], count: int) -> tuple[Any, tuple[Any, Any]]:
    """(The policy, the memory) after a step of Adam (Kingma and Ba, 2015), by a gradient of at most 1."""
    size = jnp.sqrt(sum(jnp.sum(g * g) for g in jax.tree.leaves(slope)))
    slope = jax.tree.map(lambda g: g / jnp.maximum(1.0, size), slope)
    mean = jax.tree.map(lambda m, g: 0.9 * m + 0.1 * g, memory[0], slope)
    square = jax.tree.map(lambda s, g: 0.99 * s + 0.01 * g * g, memory[1], slope)
    rate = RATE * np.sqrt(1.0 - 0.99**count) / (1.0 - 0.9**count) * (1.0 - count / (ROUNDS + 1))
    return jax.tree.map(lambda p, m, s: p - rate * m / (jnp.sqrt(s) + 1e-8), policy, mean, square), (mean, square)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="of weights and starts")
    rng = np.random.default_rng(parser.parse_args().seed)
    policy = {"hidden": 0.2 * rng.standard_normal((HIDDEN, 12)), "output": 0.01 * rng.standard_normal((4, HIDDEN))}
    policy = jax.tree.map(jnp.asarray, policy)
    memory = (jax.tree.map(jnp.zeros_like, policy),) * 2
    tests = SPREAD * np.random.default_rng(1_000_000).standard_normal((64, 12))
    fly = jax.jit(jax.vmap(lambda policy, start: flown(policy, start, 10.0), (None, 0)))
    before = np.asarray(fly(policy, tests))
    loss(policy, tests[:LANES])  # compiles
    begun = time.perf_counter()
    for count in range(1, ROUNDS + 1):
        value, slope = loss(policy, WIDER * SPREAD * rng.standard_normal((LANES, 12)))
        policy, memory = adam(policy, slope, memory, count)
        if count % 25 == 0:
            print(f"{count}: {float(value):.4f}  {time.perf_counter() - begun:.1f} s", flush=True)
    took = time.perf_counter() - begun
    after = np.asarray(fly(policy, tests))
    print(f"Measured on {heading(describe(('tandemlift', 'jax')))}\n\nTrained in {took:.1f} s.\n")
    rows = []
    for name, flights in (("random weights", before), ("trained", after)):
        away = np.linalg.norm(flights[:, :, :3], axis=2)
        rows.append(
            [name, number(float((away.max(axis=1) < 2.0).mean())), *map(number, np.quantile(away[:, -1], (0.5, 1.0)))]
        )
    print(table(["64 flights of 10 s", "within 2 m", "from the goal at the end, median, m", "largest, m"], rows))


if __name__ == "__main__":
    main()
