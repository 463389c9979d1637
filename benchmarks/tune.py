"""Tune a controller on the trial: `python benchmarks/tune.py CONTROLLER [--budget N] [--seed S]`.

Prints the best settings as TOML. Every controller gets the same vehicle, mission, scenes, targets, budget and search,
so that none is ahead because more time was spent on it. The cost of a setting is the worst RMSE of position after 10 s,
over scenes and axes, each over its target, and a little of their mean, so that the other axes do not drift.

The search keeps the best so far and tries eight changes of it at a time (a (1+8) evolution strategy: Rechenberg,
Evolutionsstrategie, 1973): each changes some of the numbers by a random factor, whose size grows with success.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import tandemlift as tl
from tandemlift.missions import format_toml

TRIAL = Path(__file__).parent / "trial.toml"
SEED = 7  # of the flights, another one than the mission's, on which controllers are compared
TOGETHER = 8  # flights in a block
HELD = {"name", "max_tilt", "a", "velocity_i_limit", "rate_i_limit", "integral_limit", "tracking"}  # not tuned: limits
LEAST_STEP, FIRST_STEP, SHARE = 0.04, 0.35, 0.35


class Scene(NamedTuple):
    """What a controller is tuned in: changes to the trial, and the RMSE [mm] wanted along x, y, z."""

    changes: dict[str, Any]
    targets: tuple[float, float, float]


def slow(lag: float, delay: float) -> dict[str, Any]:
    """Rotors of a lag [s], up and down, commanded with a delay [s]."""
    lags = {f"vehicle.quadrotors.{i}.lag_{way}": lag for i in (0, 1) for way in ("up", "down")}
    return {**lags, "actuators.delay": delay}


STILL = {"wind.model": "air"}  # everywhere, so that one compiled loop serves all scenes
SCENES = {
    "nominal": Scene(STILL, (4.0, 4.0, 1.0)),
    "steady force": Scene({**STILL, "disturbance.force": [3.0, 3.0, 0.0]}, (4.0, 4.0, 1.0)),
    "wind": Scene({**STILL, "wind.velocity": [6.0, 3.0, 0.0], "wind.turbulence": 8.0}, (18.0, 18.0, 2.0)),
    "slow rotors": Scene({**STILL, **slow(0.05, 0.02)}, (5.0, 5.0, 1.0)),
    "slower still": Scene({**STILL, **slow(0.065, 0.03)}, (20.0, 20.0, 4.0)),  # so that a margin is left
}


def start_of(controller: str) -> dict[str, Any]:
    """The settings to start from: those of the trial's own controller, the defaults of any other, by dotted key."""
    table = tl.load_mission(TRIAL, controller=controller).controller.model_dump(mode="json", exclude_none=True)
    return dict(_leaves(table, "controller"))


def _leaves(table: dict[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}.{key}")
        elif key not in HELD and isinstance(value, (float, list)):
            yield f"{prefix}.{key}", value


def changed(settings: dict[str, Any], step: float, rng: np.random.Generator) -> dict[str, Any]:
    """Some of the numbers by random factors, rounded to three digits."""

    def near(value: float) -> float:
        factor = np.exp(step * rng.standard_normal()) if rng.random() < SHARE else 1.0
        return float(f"{value * factor:.3g}")

    return {k: [near(x) for x in v] if isinstance(v, list) else near(v) for k, v in settings.items()}


def flown(controller: str, candidates: list[dict[str, Any]], seed: int = SEED) -> np.ndarray:
    """RMSE [mm] of every candidate in every scene: (candidates, scenes, 3 axes); infinite where one is lost."""
    missions = [
        tl.load_mission(TRIAL, {**s.changes, **c, "mission.seed": seed}, controller=controller)
        for s in SCENES.values()
        for c in candidates
    ]
    found = [m["position_rmse_after_10s_m"] for m in tl.fly_many(missions, keep="metrics")]
    errors = np.array([[np.inf] * 3 if rmse is None else rmse for rmse in found]) * 1e3
    return errors.reshape(len(SCENES), -1, 3).swapaxes(0, 1)


def costs(errors: np.ndarray) -> np.ndarray:
    """The cost of every candidate."""
    ratios = (errors / np.array([s.targets for s in SCENES.values()])).reshape(len(errors), -1)
    return ratios.max(axis=1) + 0.1 * ratios.mean(axis=1)


def tuned(controller: str, budget: int, seed: int) -> tuple[dict[str, Any], float]:
    """The best settings found with at most `budget` candidates, and their cost."""
    rng = np.random.default_rng(seed)
    best, step = start_of(controller), FIRST_STEP
    lowest = float(costs(flown(controller, [best] * 2))[0])  # two of each fly as a block
    for spent in range(TOGETHER, budget, TOGETHER):
        candidates = [changed(best, step, rng) for _ in range(TOGETHER)]
        cost = costs(flown(controller, candidates))
        if better := bool(cost.min() < lowest):
            best, lowest = candidates[int(cost.argmin())], float(cost.min())
        step = min(1.0, step * 1.2) if better else max(LEAST_STEP, step * 0.9)
        print(f"\r{controller}: {spent + TOGETHER} of {budget} tried, cost {lowest:.3f}", end="", file=sys.stderr)
    print(file=sys.stderr)
    return best, lowest


def nested(settings: dict[str, Any]) -> dict[str, Any]:
    """Settings by dotted key as nested tables."""
    tables: dict[str, Any] = {}
    for key, value in settings.items():
        at = tables
        *above, last = key.split(".")
        for name in above:
            at = at.setdefault(name, {})
        at[last] = value
    return tables


def main() -> None:
    parser = argparse.ArgumentParser(description="Tune a controller on the trial; print the best settings as TOML.")
    parser.add_argument("controller", help="of `tandemlift controllers`, or a .py file")
    parser.add_argument(
        "--budget",
        type=int,
        default=240,
        help="settings to try, five flights each (default: 240); 0 flies what there is",
    )
    parser.add_argument("--seed", type=int, default=0, help="of the search (default: 0)")
    given = parser.parse_args()
    warnings.simplefilter("ignore", tl.FlightWarning)
    name = tl.load_controller(given.controller).name if given.controller.endswith(".py") else given.controller
    settings, cost = tuned(name, given.budget, given.seed)
    print(f"# {name}: cost {cost:.3f} after {given.budget} settings; RMSE after 10 s along x, y, z, another seed:")
    for scene, errors in zip(SCENES, flown(name, [settings] * 2, seed=0)[0], strict=True):
        print(f"#   {scene:14}{'  '.join(f'{e:6.2f}' for e in errors)} mm")
    settings = {"controller.name": name, **settings}
    print(format_toml(nested(settings)), end="")


if __name__ == "__main__":
    main()
