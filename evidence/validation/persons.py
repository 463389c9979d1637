"""Rows about the corridors, with the mission's person and with random persons: success and effort."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.core.types import GRAVITY
from tandemlift.missions import Mission, load_mission
from validation.rows import Row
from validation.scenarios import Bench, Changes

NEAR, STANDS = 1.2, 0.02  # m, tolerance of the path's end and of the final height
LEAST = {"zigzag": 0.0, "narrow": 0.3, "narrow-zigzag": 0.1, "doorway": 0.05}  # m, smallest clearance


def random_persons(name: str, count: int, seed: int = 1, changes: Changes | None = None) -> list[Mission]:
    """A mission with `count` random persons, as a study draws them, with further changes of it."""
    study = {"name": "persons", "missions": [name], "persons": "random", "draws": count, "seed": seed}
    plan = load_plan({"study": study, "set": changes or {}})
    return [plan.mission(row) for row in plan.rows(0, plan.count)]


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
