"""Missions `iris` and `tolerant` among random vehicles, rotors and wind: how many fly without a finding.

python evidence/tolerant_draws.py [--draws 200] [--from-the-floor]

Mass within 25 % of the pilot's; the payload's centre of mass within 0.1 m along x and y; lags up to four times those of
the IRIS, 20 ms more delay; wind of up to 4 m/s from anywhere with turbulence of up to 4.7 m/s at 20 ft, on quadrotors
with a drag area of 0.1 m² each, as in the validation. All numbers are uniform and independent. Flights start in the
air, level, without ground, or as the mission says; estimates and all sensor errors are those of `iris`.
A line for each mission; then each flight with a finding: what was drawn, and the findings.
"""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from validation.scenarios import IN_THE_AIR, Changes, wind

from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.core.errors import without_flight_warnings
from tandemlift.missions import load_mission

SEED = 5
MASS, ASIDE, SLOWER, LATER = 0.25, 0.1, 4.0, 0.02  # relative; m; factor; s
SPEED, TURBULENCE = 4.0, 4.7  # m/s
UP, DOWN, DELAY = 0.0125, 0.025, 0.01  # s, of mission iris
MISSIONS = ("iris", str(Path(__file__).with_name("tolerant.toml")))


def draw(rng: np.random.Generator, number: int) -> tuple[dict[str, float], Changes]:
    """What is drawn, and the changes of a mission."""
    drawn = {
        "mass": rng.uniform(1.0 - MASS, 1.0 + MASS),
        "x (m)": rng.uniform(-ASIDE, ASIDE),
        "y (m)": rng.uniform(-ASIDE, ASIDE),
        "lag": rng.uniform(1.0, SLOWER),
        "delay (ms)": 1e3 * rng.uniform(DELAY, DELAY + LATER),
        "wind (m/s)": rng.uniform(0.0, SPEED),
        "gusts (m/s)": rng.uniform(0.0, TURBULENCE),
    }
    angle, share = rng.uniform(0.0, 2.0 * np.pi), 0.5 / 3.5  # of the payload in the mass
    blowing = drawn["wind (m/s)"] * np.array([np.cos(angle), np.sin(angle), 0.0])
    slow = {"lag_up": UP * drawn["lag"], "lag_down": DOWN * drawn["lag"]}
    changes = {
        **wind(blowing, drawn["gusts (m/s)"], slow),
        "mission.seed": number,
        "plant.mass_scale": drawn["mass"],
        "plant.center_of_mass_offset": [share * drawn["x (m)"], share * drawn["y (m)"], 0.0],
        "actuators.delay": 1e-3 * drawn["delay (ms)"],
    }
    return drawn, changes


def main() -> None:
    """Fly, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--from-the-floor", action="store_true", help="as the mission says; else in the air")
    given = parser.parse_args()
    rng = np.random.default_rng(SEED)
    draws = [draw(rng, number) for number in range(given.draws)]
    start: dict[str, Any] = {} if given.from_the_floor else {**IN_THE_AIR, "initial.euler": 0.0}
    print("| mission | without a finding | landed | findings, of so many flights |\n|---|---:|---:|---|")
    said = list[str]()
    for name in MISSIONS:
        with without_flight_warnings():
            rows = fly_each(load_mission(name, {**changes, **start}) for _, changes in draws)
        kinds = [sorted({finding[1] for finding in row["findings"]}) for row in rows]
        calm = sum(row["outcome"] == "landed" and not found for row, found in zip(rows, kinds, strict=True))
        landed = sum(row["outcome"] == "landed" for row in rows)
        counts = ", ".join(f"`{kind}` {n}" for kind, n in Counter(k for found in kinds for k in found).most_common())
        print(f"| `{Path(name).stem}` | {calm} | {landed} | {counts} |", flush=True)
        said += [
            f"{Path(name).stem} {number}: {', '.join(f'{k} {v:.3g}' for k, v in drawn.items())}: {', '.join(found)}"
            for number, ((drawn, _), found) in enumerate(zip(draws, kinds, strict=True))
            if found
        ]
    print("", *said, sep="\n")


if __name__ == "__main__":
    main()
