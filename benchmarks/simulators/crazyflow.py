"""crazyflow: its own closed loop, traced and compiled by JAX for the processor; many steps in one compiled call.

On several processors the worlds are also tried sharded over as many JAX devices, which is its own way to spread them.
"""

from __future__ import annotations

from typing import Any

from simulators import Advance, Row, fastest

STEP = (
    "closed loop: its Mellinger state controller at 100 Hz and attitude controller at 500 Hz, one quadrotor with rotor "
    "lag, {integrator}; float32, 2 ms"
)
ROWS = {
    "euler": Row("crazyflow, Euler (its default)", STEP.format(integrator="explicit Euler"), ("crazyflow", "jax")),
    "rk4": Row("crazyflow, RK4", STEP.format(integrator="RK4"), ("crazyflow", "jax")),
}
COUNTS = (4096, 16384)
STEPS = 500_000  # of all worlds together, a compiled call


def one(row: str) -> Advance:
    return _worlds(row, 1, 20_000, None)


def many(row: str, cores: int) -> Advance:
    import jax
    from crazyflow.sim.sharding import world_mesh

    meshes = [None, world_mesh(jax.devices())] if len(jax.devices()) > 1 else [None]
    return fastest([_worlds(row, count, STEPS // count, mesh) for count in COUNTS for mesh in meshes])


def _worlds(integrator: str, count: int, steps: int, mesh: Any) -> Advance:
    import jax
    import numpy as np
    from crazyflow.control import Control
    from crazyflow.sim import Sim
    from crazyflow.sim.integration import Integrator

    sim = Sim(n_worlds=count, control=Control.state, integrator=Integrator(integrator), mesh=mesh)
    command = np.zeros((count, 1, 16), np.float32)
    command[..., 2], command[..., 12] = 0.5, 1.0  # hover at 0.5 m, unit quaternion
    sim.state_control(command)

    def advance() -> int:
        sim.step(steps)
        jax.block_until_ready(sim.data.states.pos)
        return count * steps

    return advance
