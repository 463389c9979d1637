"""Blind vehicles: drawn, flown in MuJoCo or Gazebo, and identified from their logs alone.

python evidence/identify_blind_vehicles.py --vehicles 200 --out out/blind
python evidence/identify_blind_vehicles.py --engine gazebo --vehicles 3 --out out/blind-gazebo

Each vehicle is mission iris with masses, inertias, thrust constant, yaw drag, lags and delay within ±20 % of it, and
the payload's centre of mass off its place, drawn from its seed. MuJoCo, or Gazebo, flies it with iris's sensors (noise,
biases, drifts, misalignments, resolution, motion capture at 200 Hz), excited for 60 s as `tl.excite` designs it for
mission iris, by a pilot that knows the vehicle. Motion capture and joints have clocks of their own, up to 50 ms and 100
ppm off that of the IMU, which `synchronised` (`--align`) and the fit find. `tl.identify` gets the log without pushes
and commanded thrusts, mission iris, and the payload weighed with an error of 0.05 % (one standard deviation). It also
predicts 10 s of another flight, along a figure in the air, with other errors and clocks, second by second. Development
used seeds below 1000; these begin at 20000.

Results are lines of JSON in OUT/vehicles.jsonl, which a second run continues; the table is printed at the end.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import tandemlift as tl
from tandemlift.analysis.identification.identification import Identification
from tandemlift.analysis.identification.identify import identify, reference_rows
from tandemlift.analysis.logs.clocks import GROUPS, synchronised
from tandemlift.analysis.logs.log import PUSH, Log, log_of
from tandemlift.core.errors import without_flight_warnings
from tandemlift.missions import Mission, load_mission, tables_of

START = "iris"
FIRST_SEED = 20000
EXCITED = 60.0  # s
CLOCK = 0.05, 1e-4  # s, s/s: largest offset and drift of a clock
FIGURE = [  # another flight: the reference along a figure
    {"axis": axis, "frequency": f, "amplitude": size, "phase": phase}
    for axis, f, size, phase in (("x", 0.25, 0.3, 0.0), ("y", 0.4, 0.2, 1.0), ("z", 0.3, 0.2, 2.0))
]
SECOND = {
    "mission.duration": 19.0,
    "phases.lift_start": 0.5,
    "phases.lift_duration": 3.5,
    "phases.height": 1.5,
    "phases.land_start": 1e4,
    "estimator.tare_start": 4.2,
    "estimator.tare_duration": 1.0,
    "excitation.model": "multisine",
    "excitation.begin": 6.0,
    "excitation.duration": 13.0,
    "excitation.lines": FIGURE,
}
PREDICTED = 7.0, 17.9  # s of it: ten windows after the first 0.4 s
TARGETS = {  # median errors: relative, or in the unit
    "mass": (0.003, True),
    "inertia.x": (0.02, True),
    "inertia.y": (0.02, True),
    "inertia.z": (0.02, True),
    "center_of_mass.x": (0.002, False),
    "center_of_mass.y": (0.002, False),
    "center_of_mass.z": (0.002, False),
    "vehicle.quadrotors.0.thrust_constant": (0.01, True),
    "vehicle.quadrotors.1.thrust_constant": (0.01, True),
    **{f"vehicle.quadrotors.{i}.lag_{way}": (0.05, True) for i in (0, 1) for way in ("up", "down")},
    "actuators.delay": (0.001, False),
}


def drawn(seed: int, start: Mission) -> dict[str, Any]:
    """The changes of mission iris that make the vehicle of a seed."""
    chance, table = np.random.default_rng(seed), start.vehicle
    factor = lambda: 1.0 + 0.2 * chance.uniform(-1.0, 1.0)  # noqa: E731

    def inertia(moments: tuple[float, ...]) -> list[float]:
        x, y, z = (0.5 * sum(moments) - J for J in moments)  # second moments: what is drawn is a body's
        x, y, z = x * factor(), y * factor(), z * factor()
        return [y + z, x + z, x + y]

    q = table.quadrotors[0]
    same = {
        "inertia": inertia(q.inertia),
        "thrust_constant": q.thrust_constant * factor(),
        "torque_per_thrust": q.torque_per_thrust * factor(),
        "lag_up": q.lag_up * factor(),
        "lag_down": q.lag_down * factor(),
    }
    changes = {
        "vehicle.payload.mass": table.payload.mass * factor(),
        "vehicle.payload.inertia": inertia(table.payload.moments),
        "vehicle.payload.center_of_mass": (chance.uniform(-1.0, 1.0, 3) * [0.02, 0.1, 0.02]).tolist(),
        "actuators.delay": round(start.actuators.delay * factor(), 3),
    }
    for i in range(len(table.quadrotors)):
        changes[f"vehicle.quadrotors.{i}.mass"] = q.mass * factor()
        changes |= {f"vehicle.quadrotors.{i}.{name}": value for name, value in same.items()}
    return changes


def first_flight(start: Mission) -> dict[str, Any]:
    """The changes of a mission that excite it as `tl.excite` designs it."""
    tables = tables_of(tl.excite(start, EXCITED).mission)
    found = {f"{table}.{name}": value for table in ("phases", "excitation") for name, value in tables[table].items()}
    return found | {"mission.duration": tables["mission"]["duration"]}


def flown(vehicle: dict[str, Any], flight: dict[str, Any], seed: int, engine: str) -> tuple[Log, Mission]:
    """(The log of a flight of a vehicle, with clocks of its own and errors of a seed; its mission)."""
    changes = {"mission.seed": seed, "mission.log_interval": 0.001, "pushes": []}
    with without_flight_warnings():
        mission = load_mission(START, vehicle | flight | changes)
        log = log_of(tl.fly(mission, engine=engine))
    streams = {n: s for n, s in log.items() if n not in (*PUSH, "rotor_commands")}
    log = Log(streams, f"vehicle {seed}", stamp_offset=log.stamp_offset)
    chance = np.random.default_rng([seed, 1])
    for names in GROUPS.values():
        log = log.aligned(names, *(size * chance.uniform(-1.0, 1.0) for size in CLOCK))
    return synchronised(log), mission


def row_of(seed: int, start: Mission, flight: dict[str, Any], engine: str) -> dict[str, Any]:
    """Fly and identify one vehicle."""
    vehicle = drawn(seed, start)
    (log, mission), (other, _) = flown(vehicle, flight, seed, engine), flown(vehicle, SECOND, seed + 500000, engine)
    error = 0.0005 * np.random.default_rng(seed + 1).standard_normal()
    weighed = {"vehicle.payload.mass": mission.vehicle.payload.mass * (1.0 + error)}
    began = time.process_time()
    found = identify(log, start, weighed=weighed, predict=other.between(*PREDICTED), progress=lambda done, of: None)
    return {"seed": seed, "seconds": time.process_time() - began, **_compared(found, reference_rows(mission))}


def _compared(found: Identification, truth: dict[str, float]) -> dict[str, Any]:
    rows = (*found.rows, *found.whole)
    return {
        "numbers": {row.key: [row.value, truth[row.key], row.low, row.high, row.excited] for row in rows},
        "bound": {row.key: row.half * np.sqrt(row.efficiency) / 1.959964 for row in rows},
        "held_back": found.details["held_back"]["ratio"],
        "predicted": found.details["predicted"]["ratio"],
        "left_out": found.details["windows"]["left_out"],
        "remarks": list(found.remarks),
    }


def report(rows: list[dict[str, Any]]) -> Iterator[str]:
    """Errors against targets, coverage and efficiency, in lines."""
    yield f"{len(rows)} vehicles; {np.median([r['seconds'] for r in rows]):.1f} s of processor time each (median)"
    yield f"{'number':40} {'median error':>13} {'target':>8} {'holds truth':>12} {'efficiency':>10}"
    every = list[bool]()
    for key in rows[0]["numbers"]:
        value, truth, low, high, _ = np.array([r["numbers"][key] for r in rows], float).T
        inside = (low <= truth) & (truth <= high)
        every += inside.tolist()
        target, relative = TARGETS.get(key, (None, bool(np.all(truth != 0.0))))
        error = np.abs(value - truth) / (np.abs(truth) if relative else 1.0)
        bound = np.mean(np.square([r["bound"][key] for r in rows]))
        efficiency = bound / np.mean((value - truth) ** 2)
        shown = f"{100 * np.median(error):.3g} %" if relative else f"{np.median(error):.3g}"
        wanted = "" if target is None else f"{100 * target:g} %" if relative else f"{target:g}"
        yield f"{key:40} {shown:>13} {wanted:>8} {inside.sum():>5} of {len(rows):<4} {efficiency:>9.2f}"
    yield f"all intervals together: {100.0 * np.mean(every):.1f} % hold the truth"
    yield f"windows left out: {sum(r['left_out'] for r in rows)} in all"
    for title, part in (("held-back part", "held_back"), ("another flight", "predicted")):
        for name in rows[0][part]:
            ratios = [r[part][name] for r in rows]
            yield f"{title}, {name}: {np.median(ratios):.3f} of the noise (median), {max(ratios):.3f} at most"


def main() -> None:
    """Fly and identify vehicles, and print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--vehicles", type=int, default=200)
    options.add_argument("--first-seed", type=int, default=FIRST_SEED)
    options.add_argument("--engine", default="mujoco")
    options.add_argument("--out", type=Path, default=Path("out/blind"))
    given = options.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    file = given.out / "vehicles.jsonl"
    rows = [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.exists() else []
    done, start = {row["seed"] for row in rows}, load_mission(START)
    flight = first_flight(start)
    for seed in range(given.first_seed, given.first_seed + given.vehicles):
        if seed not in done:
            rows.append(row_of(seed, start, flight, given.engine))
            with file.open("a", encoding="utf-8") as out:
                out.write(json.dumps(rows[-1]) + "\n")
    for line in report(rows):
        print(line)


if __name__ == "__main__":
    main()
