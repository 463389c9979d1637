"""RotorPy: its own closed loop in NumPy and SciPy, and its batched one in PyTorch."""

from __future__ import annotations

from typing import Any

from simulators import Advance, Row, fastest

ROWS = {
    "closed": Row(
        "RotorPy",
        "closed loop: its SE(3) controller and a hover, one quadrotor with rotor lag and drag, RK45 of SciPy alone, "
        "RK4 in batches; float64, 1 ms",
        ("rotorpy", "torch"),
    ),
}
STEP = 1e-3  # s
COUNTS = (4096, 16384)


def one(row: str) -> Advance:
    import numpy as np
    from rotorpy.controllers.quadrotor_control import SE3Control
    from rotorpy.trajectories.hover_traj import HoverTraj
    from rotorpy.vehicles.hummingbird_params import quad_params
    from rotorpy.vehicles.multirotor import Multirotor

    vehicle, controller, hover = Multirotor(quad_params), SE3Control(quad_params), HoverTraj()
    start = {name: np.array(value, float) for name, value in vehicle.initial_state.items()}

    def advance() -> int:
        state = start
        for k in range(100):
            t = k * STEP
            state = vehicle.step(state, controller.update(t, state, hover.update(t)), STEP)
        return 100

    return advance


def many(row: str, cores: int) -> Advance:
    import torch

    torch.set_num_threads(cores)
    torch.set_grad_enabled(False)
    return fastest([_batch(torch, count) for count in COUNTS])


def _start(torch: Any, count: int) -> dict[str, Any]:
    zero = torch.zeros(count, 3).double()
    upright = torch.tensor([0.0, 0.0, 0.0, 1.0]).repeat(count, 1).double()
    speeds = torch.full((count, 4), 470.0).double()  # rad/s, about hover
    return {"x": zero, "v": zero, "q": upright, "w": zero, "wind": zero, "rotor_speeds": speeds}


def _batch(torch: Any, count: int) -> Advance:
    import numpy as np
    from rotorpy.controllers.quadrotor_control import BatchedSE3Control
    from rotorpy.trajectories.hover_traj import BatchedHoverTraj
    from rotorpy.vehicles.hummingbird_params import quad_params
    from rotorpy.vehicles.multirotor import BatchedMultirotor, BatchedMultirotorParams

    processor = torch.device("cpu")
    parameters = BatchedMultirotorParams([quad_params] * count, count, processor)
    vehicles = BatchedMultirotor(parameters, count, _start(torch, count), processor, integrator="rk4")
    controller, hover = BatchedSE3Control(parameters, count, processor), BatchedHoverTraj(count)
    everyone = np.arange(count)

    def advance() -> int:
        states = _start(torch, count)
        for k in range(4):
            control = controller.update(k * STEP, states, hover.update(k * STEP), everyone)
            states = vehicles.step(states, control, STEP, everyone)
        return 4 * count

    return advance
