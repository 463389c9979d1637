"""Put an observer of one's own beside the others: the same flights of `iris`, as one Parquet file.

    pip install 'tandemlift[pandas,study]'
    python examples/observers/own_observer.py

The first call flies and writes `observers.parquet`, one row a millisecond: what sensors measured
(`measured_*`), the state by the pilot's navigator (`estimated_*`), the commands to the rotors
(`rotor_commands_*` [N]), the pilot's own estimate of the push by `kalman` (`push_estimate_*`), and
the truth (`push_force_*`, `push_moment_*`). Any reader of Parquet reads it. Edit `observer`, and
call again.
"""

from pathlib import Path

import numpy as np
import pandas as pd

import tandemlift as tl

FILE = Path("observers.parquet")
CASES = {
    "nominal": {},
    "wind of 2 m/s": {"wind": {"model": "air", "velocity": [2.0, 0.0, 0.0], "turbulence": 2.0}},
    "mass +20 %": {"plant.mass_scale": 1.2},
    "delay +5 ms": {"actuators.delay": 0.015},
}
SET = {"estimator.wrench": "kalman", "mission.log_interval": 0.001}
COLUMNS = "time|measured|estimated|rotor_commands|push_estimate|push_force|push_moment_[xyz]"
MASS, GRAVITY, STEP = 3.5, 9.81, 0.001  # kg, m/s², s
TARE, END = (9.0, 12.0), 69.0  # s: hover without a push; before the landing


def write() -> None:
    """Fly the cases and write them."""
    flights = {
        name: tl.fly(tl.load_mission("iris", {**SET, **case})) for name, case in CASES.items()
    }
    tables = [flight.to_pandas().reset_index() for flight in flights.values()]
    rows = [t.filter(regex=f"^({COLUMNS})").astype("float32") for t in tables]
    pd.concat(rows, keys=flights, names=["case", None]).reset_index("case").to_parquet(FILE)


def observer(table: pd.DataFrame) -> np.ndarray:
    """The force (n, 3) [N, world axes]: here a momentum observer of 10 rad/s, in NumPy."""
    w, x, y, z = table.filter(regex="^estimated_attitude").to_numpy(float).T
    up = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    thrust = table.filter(regex="^rotor_commands").to_numpy(float).sum(axis=1)
    late = np.concatenate([np.zeros(28), thrust[:-28]])  # lag and delay of the rotors, in steps
    known = up * late[:, None] - [0.0, 0.0, MASS * GRAVITY]
    momentum = MASS * table.filter(regex="^estimated_velocity").to_numpy(float)
    force, explained = np.zeros_like(known), momentum[0].copy()
    for i in range(len(force)):
        force[i] = 10.0 * (momentum[i] - explained)
        explained += (known[i] + force[i]) * STEP
    t = table["time"].to_numpy()
    return force - force[(t > TARE[0]) & (t < TARE[1])].mean(axis=0)


if __name__ == "__main__":
    if not FILE.exists():
        write()
    print("| case | force x, y, z (N) | `kalman` (N) | zero: says nothing (N) |\n|---|---|---|---|")
    for case, table in pd.read_parquet(FILE).groupby("case", sort=False):
        true = table.filter(regex="^push_force").to_numpy(float)
        within = table["time"].between(TARE[1] + 0.5, END).to_numpy()
        kalman = table.filter(regex="^push_estimate").to_numpy(float)
        forces = observer(table), kalman, np.zeros_like(true)
        errors = [np.sqrt(np.mean((force - true)[within] ** 2, axis=0)) for force in forces]
        print(f"| {case} |", " | ".join("{:.3f}, {:.3f}, {:.3f}".format(*e) for e in errors), "|")
