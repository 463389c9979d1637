"""How far the engines are apart: `python benchmarks/validate.py`.

Prints Markdown: the same vehicle and the same pilot, one body compiled and one in MuJoCo; they share no equation.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from machine import describe, heading, table
from numba import njit

import tandemlift as tl
from tandemlift.engines.compiled import advance, start_plant, start_state
from tandemlift.engines.mujoco import MuJoCoBody
from tandemlift.jit import flat, install
from tandemlift.laws.push import CentralPush, Hand
from tandemlift.vector import ZERO, Nothing, each
from tandemlift.vehicle import Vehicle

NONE = Nothing()
CALM = {"mission.duration": 30.0}
WINDY = {
    "mission.duration": 30.0,
    "wind.model": "air",
    "wind.velocity": [1.0, 0.5, 0.0],
    "wind.turbulence": 3.0,
}
QUANTITIES = {  # channel: unit
    "position": "m",
    "velocity": "m/s",
    "joint_force": "N",
    "joint_torque": "N m",
}


def turned(a: np.ndarray, b: np.ndarray) -> float:
    """Largest angle [rad] between two series of quaternions (T, 4)."""
    same = np.sign(np.sum(a * b, axis=1))[:, None]
    return float(4.0 * np.arcsin(0.5 * np.linalg.norm(a - same * b, axis=1)).max())


def both(name: str, changes: dict[str, Any]) -> tuple[tl.Flight, tl.Flight]:
    """A mission flown in both engines."""
    mission = tl.load_mission(name, changes)
    return tl.fly(mission), tl.fly(mission, "mujoco")


def differences(a: tl.Flight, b: tl.Flight, part: Any = slice(None)) -> dict[str, float]:
    """The largest difference of each quantity between two flights, over some samples."""
    found = {f"{q} [{unit}]": float(np.abs(a[q][part] - b[q][part]).max()) for q, unit in QUANTITIES.items()}
    return {**found, "attitude [rad]": turned(a["attitude"][part], b["attitude"][part])}


def open_loop(duration: float = 30.0) -> dict[str, float]:
    """The bodies alone, under thrusts that vary smoothly: the largest differences."""
    mission = tl.load_mission("hover", {"plant.mass_scale": 1.2, "plant.inertia_scale": [1.1, 0.9, 1.3]})
    vehicle = Vehicle.from_settings(mission.vehicle)
    state, h = start_state(mission), mission.mission.step
    plant, body = start_plant(mission, vehicle, NONE, NONE), MuJoCoBody(mission, vehicle)
    phases, hand = np.arange(8) * 0.7, Hand(*[CentralPush(ZERO)] * 3)
    felt_size, apart = body.felt.size, np.zeros(4)

    install()

    @njit(error_model="numpy")
    def step(state, thrusts):
        return advance(plant, state, NONE, NONE, thrusts, NONE, hand, h)

    for k in range(round(duration / h)):
        thrusts = (5.15 + 0.02 * np.sin((1.0 + 0.3 * np.arange(8)) * k * h + phases)).tolist()
        moved = step(state, each(8)(*thrusts))
        body.advance(np.array(thrusts), np.zeros(0), np.zeros(3), np.zeros(3))
        state = moved.state
        felt = np.abs(np.array(flat(moved.felt)) - body.felt[:felt_size]).max()
        position = np.abs(np.array(state.position) - body.state[:3]).max()
        velocity = np.abs(np.array(state.velocity) - body.state[3:6]).max()
        attitude = turned(np.array([state.attitude]), body.state[None, 6:10])
        apart = np.maximum(apart, [position, velocity, felt, attitude])
    names = ("position [m]", "velocity [m/s]", "joint_force [N], joint_torque [N m]", "attitude [rad]")
    return dict(zip(names, apart.tolist(), strict=True))


def leaves_the_floor(flight: tl.Flight) -> float:
    """When the floor carries nothing any more [s]."""
    carried = flight["contact_force"][:, 2] > 0.0
    return float(flight.time[np.flatnonzero(carried[:-1] & ~carried[1:])[0] + 1])


def rows() -> list[list[str]]:
    """The table's rows: flight, quantity, difference."""
    found: list[list[str]] = []

    def tell(flight: str, values: dict[str, float]) -> None:
        found.extend([flight, quantity, f"{value:.1e}"] for quantity, value in values.items())

    tell("bodies alone, 30 s, thrusts that vary, heavier by 20 %", open_loop())
    tell("`paper`, 30 s, two quadrotors", differences(*both("paper", CALM)))
    scaled = {"plant.mass_scale": 1.1, "plant.inertia_scale": [1.2, 0.9, 1.1]}
    tell("the same, heavier by 10 %, inertia by +20, −10, +10 %", differences(*both("paper", {**CALM, **scaled})))
    tell("`four`, 30 s, four quadrotors", differences(*both("four", CALM)))
    a, b = both("iris", CALM | {"mission.log_interval": 0.001})
    off = leaves_the_floor(a), leaves_the_floor(b)
    standing, air = a.time < 1.9, a.time > max(off) + 0.5
    tell(
        "`iris`, 30 s, on the floor",
        {
            "resting height [m]": float(np.abs(a["position"][standing, 2] - b["position"][standing, 2]).max()),
            "take-off [s]": abs(off[0] - off[1]),
        },
    )
    tell("`iris`, 30 s, in the air", differences(a, b, air))
    a, b = both("iris", WINDY)
    tell("`iris` in wind with turbulence, in the air", differences(a, b, a.time > max(off) + 0.5))
    return found


def main() -> None:
    print(heading(describe(("tandemlift", "numba", "numpy", "mujoco"))))
    print()
    print(table(["flight", "quantity", "largest difference"], rows()))


if __name__ == "__main__":
    main()
