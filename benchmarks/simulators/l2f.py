"""l2f: compiled in C++, stepped one step a call from Python; many simulations thread by OpenMP."""

from __future__ import annotations

from typing import Any

from simulators import Advance, Row, fastest

ROWS = {
    "RK4": Row("l2f", "plant only: one quadrotor with rotor lag, RK4; float32, 10 ms; a Python call a step", ("l2f",)),
}
EPISODE = 500  # steps until the state is set back, as in its own environment
COUNTS = (256, 1024, 4096)


def one(row: str) -> Advance:
    import l2f

    device, env, rng = l2f.Device(), l2f.Environment(), l2f.Rng()
    parameters, state, after = l2f.Parameters(), l2f.State(), l2f.State()
    l2f.initialize_rng(device, rng, 0)
    l2f.initialize_environment(device, env)
    l2f.initial_parameters(device, env, parameters)
    action, step = [0.3] * 4, l2f.step

    def advance() -> int:
        for _ in range(200):
            l2f.initial_state(device, env, parameters, state)
            for _ in range(EPISODE // 2):
                step(device, env, parameters, state, action, after, rng)
                step(device, env, parameters, after, action, state, rng)
        return 200 * EPISODE

    return advance


def many(row: str, cores: int) -> Advance:
    import l2f

    return fastest([_vector(l2f, count) for count in COUNTS])


def _vector(l2f: Any, count: int) -> Advance:
    import numpy as np

    kind = l2f.vector_selector[count]
    device, env, rng = l2f.Device(), kind.VectorEnvironment(), kind.VectorRng()
    parameters, state, after = kind.VectorParameters(), kind.VectorState(), kind.VectorState()
    kind.initialize_rng(device, rng, 0)
    kind.initialize_environment(device, env)
    kind.initial_parameters(device, env, parameters)
    action, step = np.full((count, 4), 0.3, np.float32), kind.step

    def advance() -> int:
        kind.initial_state(device, env, parameters, state)
        for _ in range(EPISODE // 2):
            step(device, env, parameters, state, action, after, rng)
            step(device, env, parameters, after, action, state, rng)
        return count * EPISODE

    return advance
