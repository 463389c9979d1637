"""Rows about the corridors, with the mission's person and with random persons: success and effort.

Gains, arm, speed and lag of a random person are those of the mission times independent factors of 0.7 to 1.3. The
visual delay is 0.1 s to 0.3 s (in steps of 20 ms, so that blocks fill), the tremor up to 0.1 N, the grip anywhere on
the beam. A wind of up to 1 N, unknown to the pilot, comes from a random direction.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tandemlift.algebra.constants import GRAVITY
from tandemlift.missions import Mission, load_mission
from tandemlift.studies.validation.rows import Row
from tandemlift.studies.validation.scenarios import Bench, Changes

SCALED = (
    *("stiffness", "damping", "lag", "gain", "speed"),
    *("look_ahead", "approach_gain", "trim_rate", "yaw_gain", "yaw_damping"),
)
LONGER = 1.6  # times the mission's duration, because some persons are slow
NEAR, STANDS = 1.2, 0.02  # m, tolerance of the path's end and of the final height
LEAST = {"zigzag": 0.0, "narrow": 0.3, "narrow-zigzag": 0.1, "doorway": 0.05}  # m, smallest clearance


def random_persons(name: str, count: int, seed: int = 1, changes: Changes | None = None) -> list[Mission]:
    """A mission with `count` random persons, with further changes of it."""
    mission, rng = load_mission(name), np.random.default_rng(seed)
    drawn = []
    for i in range(count):
        wind, angle, grip = rng.uniform(0.0, 1.0), rng.uniform(0.0, 2.0 * np.pi), rng.uniform(-1.0, 1.0)
        own = {f"person.{key}": getattr(mission.person, key) * rng.uniform(0.7, 1.3) for key in SCALED}
        own |= {
            "mission.seed": i,
            "mission.duration": LONGER * mission.mission.duration,
            "person.delay": 0.02 * int(rng.integers(5, 16)),
            "person.tremor": rng.uniform(0.0, 0.1),
            "disturbance.force": [wind * np.cos(angle), wind * np.sin(angle), 0.0],
        }
        if mission.person.model == "steer":
            own["person.grip"] = grip
        drawn.append(load_mission(name, {**own, **(changes or {})}))
    return drawn


def succeeded(mission: Mission, metrics: dict[str, Any]) -> bool:
    """Whether a flight reached the end of its path, landed there, and touched no wall."""
    end = ([w.point for w in mission.person.path] or list(mission.corridor.centreline))[-1]
    x, y, z = metrics["final_position_m"] or [np.nan] * 3
    there = np.hypot(x - end[0], y - end[1]) < NEAR
    return bool(there and abs(z - mission.initial.position[2]) < STANDS and not metrics["wall_contact"])


def own_persons(bench: Bench) -> Iterator[Row]:
    """Rows about every corridor with its own person."""
    missions = [load_mission(name) for name in LEAST]
    for mission, m in zip(missions, bench.metrics(missions), strict=True):
        name = mission.mission.name
        least, passed = m["clearance_min_m"], succeeded(mission, m)
        limit = f"through, ≥ {LEAST[name]:g} m" if LEAST[name] else "through"
        said = f"{'through' if passed else 'not through'}, {least:.2f} m"
        yield Row(f"`{name}`: landed at its end, smallest clearance", limit, said, passed and least >= LEAST[name])
        weight = mission.vehicle.payload.mass * GRAVITY
        force, work = m["human_force_mean_n"], m["human_work_per_path_j_m"]
        said = f"{force:.2f} N, {work:.2f} J/m; carrying the payload by hand takes {weight:.2f} N"
        yield Row("the same: the person's mean force, work per metre", "", said, None)


def persons(bench: Bench) -> Iterator[Row]:
    """Rows about every corridor, and about random persons in `zigzag`."""
    yield from own_persons(bench)
    missions = random_persons("zigzag", bench.draws)
    flown = bench.metrics(missions)
    passed = sum(succeeded(m, f) for m, f in zip(missions, flown, strict=True))
    what = f"`zigzag`, {bench.draws} random persons: reached the end, touched nothing, landed"
    yield Row(what, f"{bench.draws} of {bench.draws}", f"{passed} of {bench.draws}", passed == bench.draws)
    clear = np.quantile([f["clearance_min_m"] for f in flown], [0.5, 0.05, 0.0])
    yield Row("the same: clearance, median / 5 % / min", "", "{:.2f} / {:.2f} / {:.2f} m".format(*clear), None)
    force, work = (np.mean([f[key] for f in flown]) for key in ("human_force_mean_n", "human_work_per_path_j_m"))
    yield Row("the same: mean force, work per metre", "", f"{force:.2f} N, {work:.2f} J/m", None)
