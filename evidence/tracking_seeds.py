"""Tracking of mission iris over five seeds, with the true state: calm, wind, slow rotors, and a wrong model.

python evidence/tracking_seeds.py [MISSION]

The flights start in the air, hovering, rolled by 0.15 rad and pitched by −0.15 rad, without ground. Sensors have noise,
but neither bias nor drift, and the joints' sensors are aligned; the pilot gets the true state. RMSE after 10 s, median
of seeds 911 to 915. The error against the pilot's own reference is small, too, if the pilot filters the person's hand
away; so the second column has the error against the unfiltered admittance of the true push. The last column is the
largest error of the height from 5 s after the lift to the landing.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from validation.rows import errors, rms, triple
from validation.scenarios import CLEAN, IN_THE_AIR, SLOW, WINDY, Changes, quadrotors
from validation.tracking import ASIDE, HEAVIER, admittance_error

from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.flight.record import Flight
from tandemlift.missions import load_mission

SEEDS = range(911, 916)
KEPT = ("sensors.gyroscope.noise", "sensors.motion.interval")  # of mission iris
BASE: Changes = (
    {name: value for name, value in CLEAN.items() if name not in KEPT} | IN_THE_AIR | {"pilot.state": "truth"}
)
SCENES: dict[str, Changes] = {
    "calm": {},
    "wind of 3 + 3 N, with turbulence": WINDY,
    "rotor lag 50 ms, delay 20 ms": SLOW,
    f"+{HEAVIER} kg, unknown": {"plant.mass_scale": 1.0 + HEAVIER / 3.5},
    f"payload's centre of mass off by {ASIDE} m": {"disturbance.moment": [0.5 * 9.81 * ASIDE, 0.0, 0.0]},
    "rotors that speed up as they slow down, 18 ms": {"vehicle.quadrotors": quadrotors(lag_up=0.018, lag_down=0.018)},
}


def median(flights: list[Flight], of: Any) -> np.ndarray:
    """The median of a measurement over flights, along each axis."""
    return np.median([of(flight) for flight in flights], axis=0)


def highest(flight: Flight) -> float:
    """The largest error of the height [mm], without lift and landing."""
    phases = flight.mission["phases"]
    since = phases["lift_start"] + phases["lift_duration"] + 5.0
    return float(np.abs(errors(flight, since, phases["land_start"])[:, 2]).max())


def main() -> None:
    """Fly all scenes with all seeds, and print a table."""
    mission = sys.argv[1] if len(sys.argv) > 1 else "iris"
    print(
        "| | RMSE x / y / z (mm) | x / y against the unfiltered admittance (mm) | largest z (mm) |\n|---|---|---|---|"
    )
    for name, scene in SCENES.items():
        flights = fly_each(
            (load_mission(mission, {**BASE, **scene, "mission.seed": seed}) for seed in SEEDS), keep="flights"
        )
        own, hand = median(flights, lambda flight: rms(errors(flight))), median(flights, admittance_error)
        print(f"| {name} | {triple(own, 2)} | {triple(hand)} | {median(flights, highest):.2f} |", flush=True)


if __name__ == "__main__":
    main()
