"""Rows about push detection in wind: no false triggers, and fast detection of pushes.

IRIS quadrotors hover with a beam in a mean wind along x, across the beam, with Dryden turbulence of that wind at 20 ft
and thresholds of 0.3, 0.3 and 0.4 N (the quadrotors cannot measure vertical gusts). Nobody pushes in ten-minute
flights; every detected push after the first seconds is a false trigger. Then a step push of 0.6 N every three seconds
measures the detection time. Without wind compensation, its bandwidth is nearly zero, so that all flights share one
loop.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tandemlift.flight.record import Flight
from tandemlift.missions import Mission
from validation.rows import Row
from validation.scenarios import Bench, Changes, mission

HOVER: Changes = {
    "initial.euler": [0.0, 0.0, 0.0],
    "phases.lift_start": 0.0,
    "phases.lift_duration": 2.0,
    "phases.land_start": 1e6,
    "estimator.tare_start": 4.0,
    "estimator.tare_duration": 3.0,
    "admittance.threshold": [0.3, 0.3, 0.4],
    "estimator.wind_compensation": "quadrotors",
    "sensors.gyroscope.noise": 0.0025,
}
WITH, WITHOUT = 25.0, 1e-6  # rad/s
LENGTH, MINUTES = 600.0, 5.0  # s of a hover; minutes of hover for each draw
CASES = ((1.0, WITHOUT, True), (2.0, WITHOUT, False), (2.0, WITH, True), (3.0, WITH, False))
PUSH, FIRST, EVERY, LASTS, PUSHES = 0.6, 12.0, 3.0, 1.0, 8  # N, s
EDGE = 0.01  # s, width of the Gaussians that a step is made of
SOON = 0.1  # s


def windy(wind: float, bandwidth: float, seed: int, changes: Changes) -> Mission:
    """A hover in a wind [m/s]."""
    air = {"wind.model": "air", "wind.velocity": [wind, 0.0, 0.0], "wind.turbulence": wind}
    return mission({**HOVER, **air, "estimator.wind_bandwidth": bandwidth, "mission.seed": seed, **changes})


def step(force: np.ndarray, start: float) -> list[dict[str, Any]]:
    """A step push to a force [N] at a time [s], as a sum of narrow Gaussians."""
    apart = 1.5 * EDGE
    peak = (force * apart / (EDGE * np.sqrt(2.0 * np.pi))).tolist()
    return [{"force": peak, "time": start + apart * (i + 0.5), "sigma": EDGE} for i in range(round(LASTS / apart))]


def pushed(wind: float, bandwidth: float, seed: int) -> Mission:
    """A flight with step pushes along ±x and ±y in turn."""
    pushes: list[dict[str, Any]] = []
    for i in range(PUSHES):
        force = np.eye(3)[i % 2] * PUSH * (1.0 if i % 4 < 2 else -1.0)
        pushes += step(force, FIRST + EVERY * i)
    changes = {"mission.duration": FIRST + EVERY * PUSHES, "mission.log_interval": 0.001, "pushes": pushes}
    return windy(wind, bandwidth, 500 + seed, changes)


def delays(flight: Flight) -> list[float]:
    """Detection time of each step push [s]; infinite for an undetected one."""
    found = []
    for i in range(PUSHES):
        start = FIRST + EVERY * i
        within = (flight.time >= start) & (flight.time < start + LASTS)
        active = np.flatnonzero(flight["push_active"][within, i % 2] > 0.0)
        found.append(float(flight.time[within][active[0]] - start) if len(active) else float("inf"))
    return found


def triggers(bench: Bench) -> Iterator[Row]:
    """Rows about false triggers and about detection times."""
    for wind, bandwidth, asked in CASES:
        how = "with compensation" if bandwidth == WITH else "without compensation"
        count = max(1, round(bench.draws * MINUTES * 60.0 / LENGTH))
        quiet = {"mission.duration": LENGTH, "mission.log_interval": LENGTH, "pushes": []}
        flown = bench.metrics(windy(wind, bandwidth, i, quiet) for i in range(count))
        false_triggers = sum(m["push_triggers_after_10s"] for m in flown)
        what = f"wind of {wind:g} m/s, {how}: false triggers in {count * LENGTH / 60.0:.0f} min"
        yield Row(what, "0" if asked else "", f"{false_triggers:.0f}", false_triggers == 0 if asked else None)
        flights = bench.fly(pushed(wind, bandwidth, i) for i in range(max(1, bench.draws // 5)))
        found = [d for flight in flights for d in delays(flight)]
        late = sum(d > SOON for d in found)
        said = "{:.0f} / {:.0f} / {:.0f} ms".format(*1e3 * np.quantile(found, [0.5, 0.95, 1.0]))
        limit = "≤ 100 ms for every push" if asked else ""
        yield Row(
            "the same: detection time of a push of 0.6 N, median / 95 % / max",
            limit,
            said,
            late == 0 if asked else None,
        )
