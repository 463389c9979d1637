"""Vehicles of unlike quadrotors, simulated by no code of the package, and identified at 250, 500 and 1,000 Hz.

python evidence/identify_unlike_vehicles.py --vehicles 50 --out out/unlike

`other_body.py` draws and flies them: masses, inertias, thrust constants, torques per thrust, lags and delay of each
quadrotor are up to 10 % off those of the other, about a mean up to 15 % off that of mission iris. Accelerometer and
joints are read at the instant of their stamps, at each rate from the same flight. `tl.identify` gets the log, mission
iris and the payload's mass. Intervals of 95 % should hold the truth in 93 to 97 %.

Results are lines of JSON in OUT/vehicles.jsonl, which a second run continues; the table is printed at the end.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np
from other_body import drawn, flown, log_of

import tandemlift as tl
from tandemlift.analysis.identification.identify import reference_rows
from tandemlift.core.errors import without_flight_warnings

FIRST_SEED, BATCH = 52000, 10
RATES = (250.0, 500.0, 1000.0)  # Hz
SECONDS = 24.0


def compared(changes: dict[str, Any], flight: dict[str, np.ndarray], rate: float, seed: int) -> dict[str, Any]:
    """What is found of a vehicle at a rate [Hz], beside the truth."""
    with without_flight_warnings():
        true = tl.load_mission("iris", changes)
        start = tl.load_mission("iris", {f"vehicle.quadrotors.{i}.max_speed": 1600.0 for i in (0, 1)})
    truth, weighed, began = (
        reference_rows(true),
        {"vehicle.payload.mass": true.vehicle.payload.mass},
        time.process_time(),
    )
    found = tl.identify(log_of(flight, rate, seed), start, weighed=weighed, progress=lambda done, of: None)
    rows = {row.key: [row.value, truth[row.key], row.low, row.high] for row in (*found.rows, *found.whole)}
    seconds = time.process_time() - began
    return {
        "seed": seed,
        "rate": rate,
        "rows": rows,
        "left_out": found.details["windows"]["left_out"],
        "seconds": seconds,
    }


def holds(row: list[float]) -> bool:
    """Whether an interval holds the truth."""
    _, truth, low, high = row
    return low <= truth <= high


def main() -> None:
    """Fly and identify vehicles, and print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--vehicles", type=int, default=50)
    options.add_argument("--first-seed", type=int, default=FIRST_SEED)
    options.add_argument("--out", type=Path, default=Path("out/unlike"))
    given = options.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    file = given.out / "vehicles.jsonl"
    rows = [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.exists() else []
    done = {(row["seed"], row["rate"]) for row in rows}
    for first in range(given.first_seed, given.first_seed + given.vehicles, BATCH):
        seeds = range(first, min(first + BATCH, given.first_seed + given.vehicles))
        if all((seed, rate) in done for seed in seeds for rate in RATES):
            continue
        changes = [drawn(seed) for seed in seeds]
        with without_flight_warnings():
            flights = flown([tl.load_mission("iris", one) for one in changes], SECONDS, first)
        for seed, one, flight in zip(seeds, changes, flights, strict=True):
            for rate in RATES:
                if (seed, rate) not in done:
                    rows.append(compared(one, flight, rate, seed))
                    with file.open("a", encoding="utf-8") as out:
                        out.write(json.dumps(rows[-1]) + "\n")
    for rate in RATES:
        own = [row for row in rows if row["rate"] == rate]
        inside = [holds(x) for row in own for x in row["rows"].values()]
        delay = np.array([row["rows"]["actuators.delay"] for row in own])
        halves = (delay[:, 0] - delay[:, 1]) / (0.5 * (delay[:, 3] - delay[:, 2]))
        print(
            f"{rate:5.0f} Hz: {len(own)} vehicles, {np.mean(inside):.1%} of {len(inside)} intervals hold the truth; "
            f"delay off by {1e3 * np.mean(delay[:, 0] - delay[:, 1]):+.3f} ms (mean), {np.abs(halves).max():.2f} half "
            "intervals at most"
        )
        keys = {key: np.mean([holds(row["rows"][key]) for row in own]) for key in own[0]["rows"]}
        print(
            "   least often:",
            ", ".join(f"{key} {part:.0%}" for key, part in sorted(keys.items(), key=lambda x: x[1])[:5]),
        )


if __name__ == "__main__":
    main()
