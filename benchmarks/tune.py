"""Tune a controller on the trial: `python benchmarks/tune.py CONTROLLER [--budget N] [--seed S]`.

Prints the best settings as TOML, and their RMSE of position in every scene. Every controller gets the same vehicle,
mission, scenes, targets, budget and search (`tandemlift tune`), so that none is ahead because more time was spent on
it. The cost of a setting is the worst RMSE after 10 s over scenes and axes, each over its target, and a little of their
mean, so that the other axes do not drift.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import tandemlift as tl
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.missions import format_toml, tables_of

TRIAL, SCENES = Path(__file__).parent / "trial.toml", Path(__file__).parent / "trial-scenes.toml"
METRIC = "position_rmse_after_10s_m"
TABLE_SEED = 0  # of the flights of the table, another one than in the search


def tuned(controller: str, budget: int, seed: int) -> dict[str, Any]:
    """The best settings found with at most `budget` candidates, as changes of the trial."""

    def show(tried: int, allowed: int, lowest: Any) -> None:
        print(f"\r{controller}: {tried} of {allowed} tried, cost {lowest.ratio:.3f}", end="", file=sys.stderr)

    found = tl.tune(
        *(TRIAL, METRIC), draws=SCENES, holdout=25, aim="worst", budget=budget, seed=seed, controller=controller,
        progress=show,
    )  # fmt: skip
    print(f"\n{controller}: {'better' if found.is_better else 'not better'}: {found.evidence.words}", file=sys.stderr)
    return found.changes


def errors(controller: str, settings: dict[str, Any]) -> dict[str, np.ndarray]:
    """RMSE [mm] along x, y, z by scene."""
    plan = load_plan(SCENES, {"study.seed": TABLE_SEED})
    rows = plan.rows(0, plan.count)
    missions = [tl.load_mission(TRIAL, {**row.changes, **settings}, controller=controller) for row in rows]
    found = [m[METRIC] for m in tl.fly_many(missions, keep="metrics")]
    return {row.case: 1e3 * np.array(rmse or [np.inf] * 3) for row, rmse in zip(rows, found, strict=True)}


def main() -> None:
    parser = argparse.ArgumentParser(description="Tune a controller on the trial; print the best settings as TOML.")
    parser.add_argument("controller", help="of `tandemlift controllers`, or a .py file")
    parser.add_argument("--budget", type=int, default=240, help="settings to try, default 240; 0 flies what there is")
    parser.add_argument("--seed", type=int, default=0, help="of the search (default: 0)")
    given = parser.parse_args()
    warnings.simplefilter("ignore", tl.FlightWarning)
    name = tl.load_controller(given.controller).name if given.controller.endswith(".py") else given.controller
    settings = tuned(name, given.budget, given.seed) if given.budget else {}
    print(f"# {name}: RMSE after 10 s along x, y, z, with seed {TABLE_SEED} of noise and wind:")
    for scene, rmse in errors(name, settings).items():
        print(f"#   {scene:14}{'  '.join(f'{e:6.2f}' for e in rmse)} mm")
    mission = tl.load_mission(TRIAL, settings, controller=name)
    print(format_toml({"controller": tables_of(mission)["controller"]}), end="")


if __name__ == "__main__":
    main()
