"""How often the wind is taken for a hand, and how soon a hand is heard: `python benchmarks/false_triggers.py`.

IRIS quadrotors hover with a beam in a mean wind along x with Dryden turbulence of that wind at 20 ft, guided by hand,
threshold 0.3 N; nobody pushes. Counted is every time that a push is heard, after the first minute, in ten-minute
flights. Then pushes of 0.6 N in steps, every three seconds, one flight a seed: how long after the step, whose middle is
when the push exceeds the threshold, it is heard. Sensors: joints 0.05 N, accelerometer 0.03 m/s², no bias.
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np
from machine import describe, heading, number, save, table

import tandemlift as tl

HOVER: dict[str, Any] = {
    "initial.position": [0.0, 0.0, 0.0],
    "ground.model": "none",
    "ground.effect": False,
    "actuators.start": "hover",
    "phases": {"rotors": "always", "lift_start": 0.0, "lift_duration": 2.0, "height": 1.0, "land_start": 1e6},
    "sensors.joints": {"force_bias": 0.0, "force_drift": 0.0, "torque_bias": 0.0, "misalignment": 0.0},
    "sensors.accelerometer": {"bias": 0.0, "drift": 0.0},
    "sensors.gyroscope": {"bias": 0.0, "drift": 0.0},
    "sensors.motion.interval": 0.0,
    "estimator": {"tare_start": 4.0, "tare_duration": 3.0},
    "pilot": {"guidance": "hand", "state": "measurement", "push": "measurement"},
    "controller.max_tilt": 0.5,
    "observer.model": "super-twisting",
}
WITH, WITHOUT = 25.0, 1e-6  # rad/s: without compensation it is never told, so that there is one compiled loop
LENGTH = 600.0  # s, of a hover
CASES = ((1.0, "none"), (2.0, "none"), (2.0, "quadrotors"), (3.0, "quadrotors"))  # wind [m/s], compensation
PUSH, FIRST, EVERY, LASTS = 0.6, 12.0, 3.0, 1.0  # N, s
EDGE = 0.01  # s, width of the Gaussians that a step is made of


def windy(wind: float, compensation: str, seed: int) -> dict[str, Any]:
    return {
        **HOVER,
        "wind": {"model": "air", "velocity": [wind, 0.0, 0.0], "turbulence": wind},
        "estimator.wind_compensation": "quadrotors",
        "estimator.wind_bandwidth": WITHOUT if compensation == "none" else WITH,
        "mission.seed": seed,
    }


def hovers(wind: float, compensation: str, minutes: float) -> list[Any]:
    changes = {"mission.duration": LENGTH, "mission.log_interval": LENGTH, "pushes": []}
    count = max(1, round(minutes * 60.0 / LENGTH))
    return [tl.load_mission("iris", {**windy(wind, compensation, i), **changes}) for i in range(count)]


def step(force: np.ndarray, start: float) -> list[dict[str, Any]]:
    """A push that rises to a force [N] at a time [s] and lasts, as a sum of narrow Gaussians."""
    apart = 1.5 * EDGE
    peak = (force * apart / (EDGE * np.sqrt(2.0 * np.pi))).tolist()
    return [{"force": peak, "time": start + apart * (i + 0.5), "sigma": EDGE} for i in range(round(LASTS / apart))]


def pushed(wind: float, compensation: str, seed: int, count: int = 8) -> Any:
    """A flight with steps along x and y in turn, either way."""
    pushes: list[dict[str, Any]] = []
    for i in range(count):
        force = np.eye(3)[i % 2] * PUSH * (1.0 if i % 4 < 2 else -1.0)
        pushes += step(force, FIRST + EVERY * i)
    changes = {"mission.duration": FIRST + EVERY * count, "mission.log_interval": 0.001, "pushes": pushes}
    return tl.load_mission("iris", {**windy(wind, compensation, 500 + seed), **changes})


def delays(flight: tl.Flight, count: int = 8) -> list[float]:
    """From each step to when it is heard [s]; infinite where it is not, before its end."""
    found = []
    for i in range(count):
        start = FIRST + EVERY * i
        within = (flight.time >= start) & (flight.time < start + LASTS)
        heard = np.flatnonzero(flight["push_on"][within, i % 2] > 0.0)
        found.append(float(flight.time[within][heard[0]] - start) if len(heard) else float("inf"))
    return found


def measured(wind: float, compensation: str, minutes: float, flights: int) -> dict[str, float]:
    triggers = [m["push_triggers_after_10s"] for m in tl.fly_many(hovers(wind, compensation, minutes), keep="metrics")]
    found: list[float] = []
    for seed in range(0, flights, 8):
        for flight in tl.fly_many([pushed(wind, compensation, seed + i) for i in range(8)]):
            found += delays(flight)
    return {
        "wind_m_s": wind,
        "minutes": len(triggers) * (LENGTH - 10.0) / 60.0,
        "triggers": sum(triggers),
        "pushes": len(found),
        "median_s": float(np.median(found)),
        "p95_s": float(np.quantile(found, 0.95)),
        "most_s": max(found),
        "within_100_ms": float(np.mean(np.array(found) <= 0.1)),
    }


HEADER = ["compensation", "wind m/s", "minutes", "triggers", "pushes", "ms, median", "95 %", "most", "in 100 ms"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    parser.add_argument("--minutes", type=float, default=1000.0, help="of hover, in each case")
    parser.add_argument("--flights", type=int, default=40, help="flights with eight pushes, in each case")
    options = parser.parse_args()
    about, rows, results = describe(("tandemlift", "numba", "numpy")), [], []
    for wind, compensation in CASES:
        m = measured(wind, compensation, options.minutes, options.flights)
        times = [number(1e3 * m[key]) for key in ("median_s", "p95_s", "most_s")]
        share = f"{100.0 * m['within_100_ms']:.1f} %"
        counts = [number(m["minutes"]), number(m["triggers"]), number(m["pushes"])]
        rows.append([compensation, number(wind), *counts, *times, share])
        results.append({"compensation": compensation, **m})
    print(heading(about), "\n")
    print(table(HEADER, rows))
    save(options.json, {"machine": about, "cases": results})


if __name__ == "__main__":
    main()
