"""gym-pybullet-drones: its aviary, with PyBullet's rigid body and its own PID controller, all called from Python.

Many quadrotors fly in one world, for which it has no threads. It is not on PyPI: install a checkout of it, without its
dependencies, into the environment of requirements-peers.txt.
"""

from __future__ import annotations

from simulators import Advance, Row, fastest

ROWS = {
    "pyb": Row(
        "gym-pybullet-drones",
        "closed loop: its PID controller and a hover, one quadrotor without rotor lag, PyBullet's semi-implicit Euler; "
        "float64, 4.2 ms; one world, one thread",
        ("gym-pybullet-drones", "pybullet"),
    ),
}
COUNTS = (1, 8, 32)
STEPS = 64  # of all quadrotors together


def one(row: str) -> Advance:
    return _world(1)


def many(row: str, cores: int) -> Advance:
    return fastest([_world(count) for count in COUNTS])


def _world(count: int) -> Advance:
    import numpy as np
    from gym_pybullet_drones.control.DSLPIDControl import DSLPIDControl
    from gym_pybullet_drones.envs.CtrlAviary import CtrlAviary
    from gym_pybullet_drones.utils.enums import DroneModel

    start = np.array([[0.5 * (k % 8), 0.5 * (k // 8), 1.0] for k in range(count)])  # m
    world = CtrlAviary(DroneModel.CF2X, count, initial_xyzs=start, user_debug_gui=False)
    pilots = [DSLPIDControl(DroneModel.CF2X) for _ in range(count)]
    seen, _ = world.reset()
    speeds = np.zeros((count, 4))  # rpm

    def advance() -> int:
        nonlocal seen
        for _ in range(STEPS // count):
            for i, pilot in enumerate(pilots):
                speeds[i], _, _ = pilot.computeControlFromState(world.CTRL_TIMESTEP, seen[i], start[i])
            seen, *_ = world.step(speeds)
        return STEPS // count * count

    return advance
