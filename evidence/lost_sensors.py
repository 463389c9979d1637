"""Mission `iris` whose sensor fails while a hand pushes it: where, how fast and how upright it lands.

python evidence/lost_sensors.py [--seeds 24]

A push of 1 N and 0.5 N across it lasts from about 13 s to 17 s; at 15 s the sensor fails for good, and supervision
reacts. For each failure: how many flights land; the distance from the reference when the landing ends, median and
largest; the largest descent speed and tilt from the failure on.
"""

from __future__ import annotations

import argparse

import numpy as np

import tandemlift as tl
from tandemlift.core.errors import without_flight_warnings
from tandemlift.core.phases import IDLE

TIME = 15.0  # s, of the failure
PUSH = {"force": [1.0, 0.5, 0.0], "time": TIME, "sigma": 0.8}
CHANGES = {"supervision.model": "on", "pushes": [PUSH], "mission.duration": 45.0, "phases.land_start": 1e6}
FAILURES = {
    "motion, stale": ("motion", "stale"),
    "gyroscope, not a number": ("gyroscope", "nan"),
    "inertial measurement unit, stale": ("imu", "stale"),
    "accelerometer, frozen": ("accelerometer", "frozen"),
    "position, not a number": ("position", "nan"),
    "velocity, frozen": ("velocity", "frozen"),
    "attitude, frozen": ("attitude", "frozen"),
}


def measured(flight: tl.Flight) -> tuple[bool, float, float, float]:
    """(Whether it landed, distance from the reference then [m], largest descent [m/s] and tilt [rad])."""
    late = flight.time > TIME
    down = np.append(np.flatnonzero(late & (flight["phase"] == IDLE)), len(late) - 1)[0]
    sideways = np.linalg.norm((flight["position"] - flight["reference_position"])[down, :2])  # on the ground, it drifts
    roll, pitch = flight["euler"][late, :2].T
    tilt = np.arccos(np.cos(roll) * np.cos(pitch)).max()
    return flight.outcome == "landed", float(sideways), float(-flight["velocity"][late, 2].min()), float(tilt)


def main() -> None:
    """Fly, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=24)
    seeds = range(parser.parse_args().seeds)
    print(
        "| failure | landed | sideways, median and largest (m) | descent (m/s) | tilt (rad) |\n|---|---:|---|---|---|"
    )
    for name, (sensor, kind) in FAILURES.items():
        fault = {"sensor_faults": [{"sensor": sensor, "kind": kind, "time": TIME}]}
        missions = [tl.load_mission("iris", {**CHANGES, **fault, "mission.seed": seed}) for seed in seeds]
        with without_flight_warnings():
            rows = [measured(flight) for flight in tl.fly_many(missions)]
        landed, sideways, descent, tilt = zip(*rows, strict=True)
        far = f"{np.median(sideways):.2f}, {max(sideways):.2f}"
        print(f"| {name} | {sum(landed)} of {len(rows)} | {far} | {max(descent):.2f} | {max(tilt):.2f} |", flush=True)


if __name__ == "__main__":
    main()
