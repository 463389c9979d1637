"""hyperdrone: the dynamics of l2f, compiled in C++ for each number of drones, all of which a call of Python steps.

Its first use compiles by CMake (3.24 or later), with a JSON library of the system or a download, and keeps the result.
"""

from __future__ import annotations

from simulators import Advance, Row, fastest

ROWS = {
    "RK4": Row(
        "hyperdrone",
        "plant only: one quadrotor with rotor lag, RK4; float32, 10 ms; a Python call a step",
        ("hyperdrone",),
    ),
}
EPISODE = 500  # steps until the state is set back, as in l2f
COUNTS = (1024, 4096)


def one(row: str) -> Advance:
    return _drones(1, 20 * EPISODE)


def many(row: str, cores: int) -> Advance:
    return fastest([_drones(count, EPISODE // 10) for count in COUNTS])


def _drones(count: int, steps: int) -> Advance:
    import numpy as np
    from hyperdrone.dynamics import Sim

    sim = Sim(count, seed=0, device="cpu")
    action = np.full((count, 4), 0.3, np.float32)

    def advance() -> int:
        for k in range(steps):
            if k % EPISODE == 0:
                sim.reset()
            sim.step(action)
        return count * steps

    return advance
