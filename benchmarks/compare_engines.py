"""Agreement of the engines, beside tolerances: `python benchmarks/compare_engines.py [mujoco] [gazebo]`.

Prints Markdown: the same vehicle under the same thrusts, then under the same pilot, one body compiled and one in
MuJoCo, unless other engines are named; they share no equation of motion. Differences of flights are those of
`tandemlift compare --engines`. Ends with status 1 if one is beyond its tolerance.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from machine import describe, heading, table

import tandemlift as tl
from tandemlift.analysis.studies.comparison import in_engines
from tandemlift.analysis.studies.comparison_scores import angles_between, differences
from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.compiler.tracer import traced
from tandemlift.core.types import flat, unflat
from tandemlift.core.vector import ZERO, Absent, each
from tandemlift.engines.compiled import advance, start_plant, start_state
from tandemlift.engines.registry import engine_named
from tandemlift.parts.mechanics.push import CentralPush, PushSamples
from tandemlift.parts.mechanics.vehicle import Vehicle

NONE, NO_AIR, NO_PUSH = Absent(), np.zeros(0), np.zeros(3)
HALF_MINUTE = {"mission.duration": 30.0}
FINE = {"mission.log_interval": 0.001}
SCALED = {"plant.mass_scale": 1.1, "plant.inertia_scale": [1.2, 1.3, 1.2]}  # a beam that there can be, as Gazebo wants
WIND = {"wind.model": "air", "wind.velocity": [3.0, 1.0, 0.0], "wind.turbulence": 5.0}
PLACES = [[0.1, 1.0, 0.075], [-0.2, -1.1, 0.05], [0.9, 0.1, 0.1], [-0.8, 0.2, -0.1]]  # m

QUANTITIES = {"position": "m", "attitude": "rad", "joint_force": "N", "joint_torque": "N m"}
FREE = {  # without contact, push as it is
    "mujoco": {"position": 5e-5, "attitude": 2e-4, "joint_force": 1e-3, "joint_torque": 1e-3},
    "gazebo": {"position": 1e-3, "attitude": 1e-3, "joint_force": 5e-2, "joint_torque": 5e-3},
}
FELT = {  # push as the joints feel it
    "mujoco": {"position": 2e-3, "attitude": 5e-4, "joint_force": 5e-2, "joint_torque": 5e-3},
    "gazebo": {"position": 2e-3, "attitude": 5e-3, "joint_force": 5e-2, "joint_torque": 5e-3},
}
ALONE = {"mujoco": 30.0, "gazebo": 1.0}  # s, of bodies without a pilot: Gazebo's steps are of first order
BEGUN = 0.1  # s: in Gazebo joints are looked at from then on, as they close the gaps that a swift start tears
HEIGHT, CARRIED = 1e-4, 5e-3  # m, N
TIME = {"mujoco": 5e-3, "gazebo": 5e-2}  # s: a foot leaves the sooner or later for how its friction is modelled
SETTLED = 0.2  # s: a wind that blows from the first step shakes a standing vehicle until friction holds it


class Row(NamedTuple):
    """A line of the table."""

    flight: str
    quantity: str
    difference: float
    tolerance: float

    @property
    def cells(self) -> list[str]:
        return [f"{self.tolerance:.0e}", f"{self.difference:.1e}"]


def rows_of(flight: str, largest: dict[str, float], tolerances: dict[str, float]) -> Iterator[Row]:
    """The lines of a flight, from the largest difference of each quantity."""
    for name, unit in QUANTITIES.items():
        yield Row(flight, f"{name.replace('_', ' ')} [{unit}]", largest[name], tolerances[name])


def unlike(count: int) -> tl.Mission:
    """So many unlike quadrotors at unlike places, heavier and slower to turn than known, that start tilted and turn."""
    one = tl.load_mission("paper").vehicle.quadrotors[0].model_dump(mode="json", exclude_none=True)
    quadrotors = [{**one, "position": p, "mass": 1.2 + 0.2 * i} for i, p in enumerate(PLACES[:count])]
    start = {"initial.euler": [0.2, -0.1, 0.4], "initial.velocity": [1.0, 0.5, -0.3], "initial.rates": [1.0, -2.0, 0.5]}
    return tl.load_mission("paper", {"vehicle.quadrotors": quadrotors, **start, **SCALED})


def excited(mission: tl.Mission, vehicle: Vehicle) -> Any:
    """Thrusts [N] of all rotors at time t in a state: those that keep it upright, plus a slow sine of 30 % of hover."""
    rng, weight, count = np.random.default_rng(3), vehicle.weight * mission.plant.mass_scale, vehicle.rotor_count
    phase, rate = rng.uniform(0.0, 6.0, (2, count))
    J, allocation = np.diag(vehicle.inertia), vehicle.allocation()

    def thrusts(t: float, state: Any) -> np.ndarray:
        q, w = np.array(state.attitude), np.array(state.rates)
        upright = allocation @ [weight, *(-J * (20.0 * q[1:] + 6.0 * w))]
        return upright + 0.3 * weight / count * np.sin(rate * t + phase)

    return thrusts


def open_loop(engine: str, count: int) -> dict[str, float]:
    """The bodies alone, both under the same thrusts: the largest differences, of positions by coordinate."""
    mission = unlike(count)
    vehicle, h = Vehicle.from_settings(mission.vehicle), mission.mission.step
    state, plant = start_state(mission.initial), start_plant(mission, vehicle, NONE, NONE)
    body = engine_named(engine).start(mission, vehicle, NONE, NONE)
    hand, rotors, thrusts_at = (
        PushSamples(*[CentralPush(ZERO)] * 3),
        each(vehicle.rotor_count),
        excited(mission, vehicle),
    )

    def step(state: Any, thrusts: Any) -> Any:
        return traced(advance)(plant, state, NONE, NONE, thrusts, NONE, hand, h)

    like = advance(plant, state, NONE, NONE, NONE, rotors(*thrusts_at(0.0, state)), NONE, hand, h)
    stepped = compiled(step, state, rotors(*[0.0] * vehicle.rotor_count))
    largest, joints = dict.fromkeys(QUANTITIES, 0.0), {"joint_force": slice(3, 3 + 3 * count)}
    joints["joint_torque"] = slice(3 + 3 * count, 3 + 6 * count)
    for k in range(round(ALONE[engine] / h)):
        thrusts = thrusts_at(k * h, state)
        moved = unflat(stepped(np.array([[*flat(state), *thrusts]]))[0], like)
        body.advance(thrusts, NO_AIR, NO_PUSH, NO_PUSH)
        state, felt = moved.state, np.abs(np.array(flat(moved.readings)) - body.readings)
        found = {name: felt[part].max() * looked_at(engine, k * h) for name, part in joints.items()}
        found["position"] = np.abs(np.array(state.position) - body.state[:3]).max()
        found["attitude"] = angles_between(np.array([state.attitude]), body.state[None, 6:10])[0]
        largest = {name: max(largest[name], float(found[name])) for name in largest}
    return largest


def looked_at(engine: str, t: Any) -> Any:
    """Whether joints are looked at, at times t [s]."""
    return np.asarray(t) > BEGUN if engine == "gazebo" else np.asarray(t) >= 0.0


def both(engine: str, name: str, changes: dict[str, Any]) -> tuple[tl.Flight, tl.Flight]:
    """A mission flown in the compiled engine and in another."""
    a, b = in_engines(tl.load_mission(name, changes), ["compiled", engine]).fly().flights.values()
    return a, b


def largest_difference(a: tl.Flight, b: tl.Flight, part: Any = slice(None)) -> dict[str, float]:
    """The largest difference of each quantity between two flights, over some samples."""
    found, joints = differences(b, a), looked_at(b.version["engine"], a.time[part])
    parts = {name: found[name][part] for name in QUANTITIES}
    return {name: float((x[joints] if name.startswith("joint") else x).max()) for name, x in parts.items()}


def changes_of_floor(flight: tl.Flight) -> tuple[float, float]:
    """The times at which the floor first carries no load, and first carries one again [s]."""
    free = flight["contact_force"][:, 2] == 0.0
    off = int(np.flatnonzero(free)[0])
    long_after = off + round(1.0 / (flight.time[1] - flight.time[0]))  # s: it may touch again as it leaves
    return float(flight.time[off]), float(flight.time[long_after + np.flatnonzero(~free[long_after:])[0]])


def with_floor(engine: str, name: str) -> Iterator[Row]:
    """A flight on sensors and real rotors, from the floor and back to it."""
    a, b = both(engine, name, FINE)
    title = f"`{name}`, {a.time[-1]:g} s"
    (off, down), (other_off, other_down) = changes_of_floor(a), changes_of_floor(b)
    standing = (a.time > SETTLED) & (a.time < a.mission["phases"]["lift_start"])
    flying = (a.time > max(off, other_off) + 1.0) & (a.time < min(down, other_down))
    height = float(np.abs(a["position"] - b["position"])[standing, 2].max())
    carried = largest_difference(a, b, standing)["joint_force"]
    yield Row(f"{title}, standing", "height [m]", height, HEIGHT)
    yield Row(f"{title}, standing", "joint force [N]", carried, CARRIED)
    yield Row(title, "time of take-off [s]", abs(off - other_off), TIME[engine])
    yield Row(title, "time of touch-down [s]", abs(down - other_down), TIME[engine])
    yield from rows_of(f"{title}, in the air", largest_difference(a, b, flying), FELT[engine])


def all_rows(engine: str) -> Iterator[Row]:
    """The whole table of an engine."""
    free = FREE[engine]
    for count in (1, 2, 4):
        yield from rows_of(f"bodies alone, N = {count}, varying thrusts", open_loop(engine, count), free)
    flown: dict[str, tuple[str, dict[str, Any]]] = {
        "`paper`, 30 s": ("paper", {}),
        "`paper`, 30 s, mass + 10 %, inertia + 20, + 30, + 20 %": ("paper", SCALED),
        "`paper`, 30 s, in wind and turbulence": ("paper", WIND),
        "`four`, 30 s": ("four", {}),
    }
    for title, (name, changes) in flown.items():
        yield from rows_of(title, largest_difference(*both(engine, name, HALF_MINUTE | changes)), free)
    yield from with_floor(engine, "iris")
    yield from with_floor(engine, "gusts")


def main() -> None:
    engines = sys.argv[1:] or ["mujoco"]
    print(heading(describe(("tandemlift", "llvmlite", "numpy", "mujoco"))), end="\n\n")
    columns = [list(all_rows(engine)) for engine in engines]
    print("Largest difference of each engine from the compiled one:", end="\n\n")
    header = ["flight", "quantity", *(cell for engine in engines for cell in ("tolerance", f"`{engine}`"))]
    lines = zip(*columns, strict=True)
    print(table(header, [[*line[0][:2], *(cell for row in line for cell in row.cells)] for line in lines], texts=2))
    rows = [(engine, row) for engine, column in zip(engines, columns, strict=True) for row in column]
    beyond = [f"{e}, {row.flight}: {row.quantity}" for e, row in rows if not row.difference <= row.tolerance]
    print(f"\nBeyond tolerance: {'; '.join(beyond)}." if beyond else "\nEvery difference is within its tolerance.")
    sys.exit(bool(beyond))


if __name__ == "__main__":
    main()
