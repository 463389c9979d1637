"""The smallest push that an observer finds within 80 ms, over the wind, with thresholds that nothing else exceeds.

    python evidence/smallest_push.py --observer kalman --minutes 1000

`iris` hovers without joint sensors in a wind along x with Dryden turbulence of that wind at 20 ft. First nobody pushes:
each active push is a false hand, and the largest filtered force is what a threshold must exceed. Then pushes that rise
within 20 ms act along ±x and ±y, and the smallest is looked for that is found within 80 ms each time.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import Any

import numpy as np
from validation.triggers import EVERY, FIRST, HOVER, PUSHES, delays, step

import tandemlift as tl
from tandemlift.core.types import Array

FLIGHT, AT_ONCE, AFTER, SEEDS = 600.0, 8, 12.0, 3  # s; flights in memory; s; flights with pushes
SOON = 0.08  # s
FORCES = np.geomspace(1.0, 3.0, 23)  # over the threshold
THRESHOLDS = {  # N by wind [m/s]: chosen above the largest force of 1,000 minutes with `kalman`
    0.0: (0.15, 0.15, 0.25),
    1.0: (0.3, 0.15, 0.25),
    2.0: (1.3, 0.2, 0.55),
    3.0: (3.2, 0.4, 1.2),
}


def hovering(observer: str, wind: float, seed: int, changes: dict[str, Any]) -> tl.Mission:
    """A hover in a wind [m/s], with an observer."""
    sensed = {} if observer in ("joints", "fused") else {"sensors.joints.model": "none"}
    air = {"wind.model": "air", "wind.velocity": [wind, 0.0, 0.0], "wind.turbulence": wind} if wind else {}
    own = {
        **sensed,
        "estimator.wrench": observer,
        "estimator.wind_compensation": "none",
        "admittance.threshold": list(THRESHOLDS[wind]),
        "mission.seed": seed,
        "pushes": [],
    }
    return tl.load_mission("iris", {**HOVER, **own, **air, **changes})


def quiet(observer: str, wind: float, minutes: float) -> tuple[float, Array]:
    """(false hands, the largest filtered force along each axis [N]) in so many minutes without a push."""
    count, hands, largest = max(1, round(minutes * 60.0 / FLIGHT)), 0.0, np.zeros(3)
    logged = {"mission.duration": FLIGHT + AFTER, "mission.log_interval": 0.05}
    for first in range(0, count, AT_ONCE):
        seeds = range(1000 + first, 1000 + min(first + AT_ONCE, count))
        for flight in tl.fly_many([hovering(observer, wind, seed, logged) for seed in seeds]):
            hands += flight.metrics()["push_triggers_after_10s"]
            flown = flight["push_filtered"][flight.time > AFTER]
            largest = np.maximum(largest, np.abs(flown).max(axis=0))
    return hands, largest


def detection_times(observer: str, wind: float, force: Array) -> Array:
    """The times in which pushes of a force along x and y [N] are found [s], in pairs."""
    times: list[float] = []
    for seed in range(SEEDS):
        pushes: list[dict[str, Any]] = []
        for i in range(PUSHES):
            way = np.eye(3)[i % 2] * (1.0 if i % 4 < 2 else -1.0)
            pushes += step(way * np.append(force, 0.0), FIRST + EVERY * i)
        changes = {"mission.duration": FIRST + EVERY * PUSHES, "mission.log_interval": 0.001, "pushes": pushes}
        times += delays(tl.fly(hovering(observer, wind, 2000 + seed, changes)))
    return np.array(times).reshape(-1, 2)


def smallest(observer: str, wind: float) -> Array:
    """The smallest force along x and y that is found within `SOON` in all flights [N]; infinite without one."""
    threshold, found = np.array(THRESHOLDS[wind][:2]), np.full(2, np.inf)
    for factor in FORCES:
        in_time = np.all(detection_times(observer, wind, threshold * factor) <= SOON, axis=0)
        found = np.where(in_time & np.isinf(found), threshold * factor, found)
        if np.isfinite(found).all():
            break
    return found


def rows(observer: str, minutes: float, winds: list[float]) -> Iterator[str]:
    """The rows of the table, as they are flown."""
    yield "| wind (m/s) | threshold x, y (N) | false hands | largest x, y, z (N) | smallest push x, y (N) |"
    yield "|---|---|---|---|---|"
    for wind in winds:
        hands, largest = quiet(observer, wind, minutes)
        push, at = smallest(observer, wind), THRESHOLDS[wind]
        most = ", ".join(f"{force:.2f}" for force in largest)
        yield f"| {wind:g} | {at[0]:g}, {at[1]:g} | {hands:.0f} | {most} | {push[0]:.2f}, {push[1]:.2f} |"


def main() -> None:
    """Print a row for each wind."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--observer", default="kalman")
    parser.add_argument("--minutes", type=float, default=1000.0, help="of hover without a push, for each wind")
    parser.add_argument("--winds", type=float, nargs="+", default=list(THRESHOLDS))
    given = parser.parse_args()
    for row in rows(given.observer, given.minutes, given.winds):
        print(row, flush=True)


if __name__ == "__main__":
    main()
