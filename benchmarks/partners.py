"""Random persons lead the vehicle through a corridor: how many get it through without touching, and at what effort.

    python benchmarks/partners.py [mission] [count]

Each person's gains, arm, speed and lag are the mission's times 0.7 to 1.3, each on its own; they see the vehicle 0.1 s
to 0.3 s late (in steps of 20 ms, so that blocks fill), tremble by up to 0.1 N, hold on anywhere on the beam (if they
lead the centre by one hand), and a wind of up to 1 N that the pilot does not know of comes from anywhere.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

import tandemlift as tl

COUNT, SEED = 200, 1
SCALED = (
    "stiffness",
    "damping",
    "lag",
    "gain",
    "speed",
    "look_ahead",
    "approach",
    "trimming",
    "turn_gain",
    "turn_damping",
)
LONGER = 1.6  # times the mission's duration: some persons are slow
NEAR, STANDS = 1.2, 0.02  # m: of the path's end, and of the height at which it stood


def persons(name: str, count: int, seed: int = SEED, changes: dict[str, Any] | None = None) -> list[tl.Mission]:
    """A mission with random persons."""
    mission, rng = tl.load_mission(name, changes), np.random.default_rng(seed)
    drawn = []
    for i in range(count):
        wind, angle = rng.uniform(0.0, 1.0), rng.uniform(0.0, 2.0 * np.pi)
        grip = rng.uniform(-1.0, 1.0)
        own = {f"partner.{key}": getattr(mission.partner, key) * rng.uniform(0.7, 1.3) for key in SCALED}
        own |= {
            "mission.seed": i,
            "mission.duration": LONGER * mission.mission.duration,
            "partner.delay": 0.02 * int(rng.integers(5, 16)),
            "partner.tremor": rng.uniform(0.0, 0.1),
            "disturbance.force": [wind * np.cos(angle), wind * np.sin(angle), 0.0],
        }
        if mission.partner.model == "steer":
            own["partner.grip"] = grip
        drawn.append(tl.load_mission(name, {**(changes or {}), **own}))
    return drawn


def outcome(mission: tl.Mission, metrics: dict[str, Any]) -> dict[str, Any]:
    """What came of one person's flight."""
    end = [w.point for w in mission.partner.path] or list(mission.corridor.centreline)
    x, y, z = metrics["final_position_m"] or [np.nan] * 3
    there = bool(np.hypot(x - end[-1][0], y - end[-1][1]) < NEAR)
    stands = bool(abs(z - mission.initial.position[2]) < STANDS)
    touched = bool(metrics["wall_contact"])
    return {"there": there, "landed": there and stands, "touched": touched, "through": there and stands and not touched}


def table(name: str, count: int) -> str:
    """The study as a table of text."""
    missions = persons(name, count)
    began = time.perf_counter()
    flown = tl.fly_many(missions, keep="metrics")
    wall, results = time.perf_counter() - began, [outcome(m, f) for m, f in zip(missions, flown, strict=True)]

    def column(key: str) -> Any:
        return np.array([f[key] if f[key] is not None else np.nan for f in flown], dtype=float)

    clear, force = column("clearance_min_m"), column("human_force_mean_n")
    work, seconds = column("human_work_per_path_j_m"), column("human_time_s")
    payload = missions[0].vehicle.payload.mass * 9.81
    rows = [
        ("through: there, landed, not touched", f"{sum(r['through'] for r in results)} of {count}"),
        ("landed at the end", f"{sum(r['landed'] for r in results)} of {count}"),
        ("touched a wall", f"{sum(r['touched'] for r in results)} of {count}"),
        (
            "least clearance, median, 5 %, worst",
            "{:.3f}, {:.3f}, {:.3f} m".format(*np.nanquantile(clear, [0.5, 0.05, 0])),
        ),
        ("time guided, median, longest", f"{np.nanmedian(seconds):.1f}, {np.nanmax(seconds):.1f} s"),
        ("mean force, mean, largest", f"{np.nanmean(force):.2f}, {np.nanmax(force):.2f} N"),
        ("beside the payload's weight", f"{np.nanmean(force) / payload:.0%} of {payload:.2f} N"),
        ("work over path, mean", f"{np.nanmean(work):.2f} J/m"),
        (
            "beside lifting the payload by a metre",
            f"{np.nanmean(work * column('human_path_m')):.1f} J against {payload:.2f} J",
        ),
        ("wall time", f"{wall:.1f} s"),
    ]
    return "\n".join([f"{name}, {count} persons", *(f"  {what:40s} {said}" for what, said in rows)])


if __name__ == "__main__":
    chosen = sys.argv[1] if len(sys.argv) > 1 else "zigzag"
    print(table(chosen, int(sys.argv[2]) if len(sys.argv) > 2 else COUNT))
