"""MJX: MuJoCo's model of `mujoco.py` in JAX, compiled for the processor; many steps in one compiled call."""

from __future__ import annotations

from typing import Any

from simulators import Advance, Row, fastest
from simulators.mujoco import THRUST, model_of

STEP = "plant only: three welded bodies, {integrator}; float32, 1 ms"
PACKAGES = ("mujoco-mjx", "mujoco", "jax")
ROWS = {
    "Euler": Row("MJX, Euler", STEP.format(integrator="semi-implicit Euler"), PACKAGES),
    "RK4": Row("MJX, RK4", STEP.format(integrator="RK4"), PACKAGES),
}
COUNTS = (256, 1024, 4096)
STEPS = 100_000  # of all simulations together, a compiled call


def one(row: str) -> Advance:
    return _worlds(row, None, 2_000)


def many(row: str, cores: int) -> Advance:
    return fastest([_worlds(row, count, STEPS // count) for count in COUNTS])


def _worlds(integrator: str, count: int | None, steps: int) -> Advance:
    """So many simulations side by side, or one alone."""
    import jax
    from mujoco import mjx

    model = mjx.put_model(model_of(integrator))
    data = mjx.make_data(model)
    data = data.replace(
        xfrc_applied=data.xfrc_applied.at[1, 2].set(THRUST), qvel=data.qvel.at[3:].set(jax.numpy.array([0.1, 0.2, 0.3]))
    )

    def step(data: Any) -> Any:
        return mjx.step(model, data)

    if count is not None:
        data = jax.tree.map(lambda x: jax.numpy.repeat(x[None], count, 0), data)
        step = jax.vmap(step)
    run = jax.jit(lambda data: jax.lax.fori_loop(0, steps, lambda _, d: step(d), data))

    def advance() -> int:
        nonlocal data
        data = jax.block_until_ready(run(data))
        return (count or 1) * steps

    return advance
