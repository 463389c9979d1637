"""The missions of the validation table: mission iris with sensor noise only, from a tilted start in the air.

IRIS rotors with lag 12.5/25 ms and 10 ms of delay; the joints' sensors with 0.05 N; the state as measured, with 3 mm,
2 mrad, 0.01 m/s and 0.01 rad/s. Wind acts on the quadrotors, whose drag is made so large that it comes to the force
that is specified: on the beam it would be estimated as a push, the subject of chapter `triggers`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, load_mission
from validation.census import Census

Changes = dict[str, Any]

CLEAN: Changes = {
    **{f"sensors.joints.{what}_{error}": 0.0 for what in ("force", "torque") for error in ("bias", "drift")},
    **{f"sensors.{meter}.{error}": 0.0 for meter in ("accelerometer", "gyroscope") for error in ("bias", "drift")},
    "sensors.joints.misalignment": 0.0,
    "sensors.gyroscope.noise": 0.01,
    "sensors.motion.interval": 0.0,
    "pilot.state": "measurement",
}
IN_THE_AIR: Changes = {
    "initial.position": [0.0, 0.0, 0.0],
    "initial.euler": [0.15, -0.15, 0.0],
    "ground.model": "none",
    "ground.effect": False,
    "actuators.start": "hover",
    "phases.rotors": "always",
}
BASE: Changes = {**CLEAN, **IN_THE_AIR, "mission.name": "validation"}
STEADY, TURBULENCE = 4.16, 4.7  # m/s: mean wind on each axis, and wind at 20 ft, for 3 N and 1 N rms at AREA
AREA = 0.1  # m², of each quadrotor


class Bench(NamedTuple):
    """The engine of the validation, the number of random draws, and the counter of outcomes, if any."""

    engine: str = "compiled"
    draws: int = 200
    census: Census | None = None

    def _counted(self, flown: list[dict[str, Any]]) -> list[dict[str, Any]]:
        if self.census is not None:
            self.census.add(flown)
        return flown

    def fly(self, missions: Iterable[Mission]) -> list[Flight]:
        """The flights of missions, in order."""
        flights = fly_each(missions, self.engine, keep="flights")
        self._counted([flight.metrics() for flight in flights])
        return flights

    def metrics(self, missions: Iterable[Mission]) -> list[dict[str, Any]]:
        """The metrics of flights, in order."""
        return self._counted(fly_each(missions, self.engine))


def quadrotors(**changes: Any) -> list[dict[str, Any]]:
    """The quadrotors of mission iris, each with the same changes."""
    fleet = load_mission("iris").model_dump(mode="json", exclude_none=True)["vehicle"]["quadrotors"]
    return [{**quadrotor, **changes} for quadrotor in fleet]


def mission(changes: Changes | None = None, base: Changes = BASE) -> Mission:
    """The base mission of the table with changes."""
    return load_mission("iris", {**base, **(changes or {})})


def wind(velocity: Any, turbulence: float, fleet: Changes | None = None) -> Changes:
    """Wind [m/s] on the quadrotors only, with further changes of them."""
    return {
        "wind.model": "air",
        "wind.velocity": [float(v) for v in velocity],
        "wind.turbulence": turbulence,
        "vehicle.payload.drag_area": [0.0] * 3,
        "vehicle.quadrotors": quadrotors(drag_area=[AREA] * 3, **(fleet or {})),
    }


WINDY = wind([STEADY, STEADY, 0.0], TURBULENCE)
SLOW: Changes = {"vehicle.quadrotors": quadrotors(lag_up=0.05, lag_down=0.05), "actuators.delay": 0.02}
DIAGONAL = 0.25 / np.sqrt(2.0)  # m
REGULAR = [[DIAGONAL, -DIAGONAL], [-DIAGONAL, DIAGONAL], [DIAGONAL, DIAGONAL], [-DIAGONAL, -DIAGONAL]]  # m, an even X


def drawn(rng: np.random.Generator, number: int) -> Mission:
    """A mission with random lag, delay, inertia, mass, wind, gusts, grip, noise and layout."""
    lag = float(rng.uniform(0.0125, 0.05))
    fleet: Changes = {"lag_up": lag, "lag_down": min(0.05, lag * float(rng.uniform(1.0, 2.0)))}
    if rng.random() < 0.5:
        fleet["rotor_positions"] = REGULAR
    angle, speed, noise = rng.uniform(0.0, 2.0 * np.pi), STEADY * np.sqrt(2.0) * rng.random(), rng.uniform(0.5, 1.5)
    grip = float(rng.uniform(-0.9, 0.9))
    pushes = load_mission("iris").model_dump(mode="json")["pushes"]
    below = -0.0642857  # m, of the payload's centre
    changes = {
        **wind([speed * np.cos(angle), speed * np.sin(angle), 0.0], float(rng.uniform(0.5, TURBULENCE)), fleet),
        "actuators.delay": round(float(rng.uniform(0.0, 0.02)), 3),
        "plant.inertia_scale": [float(x) for x in rng.uniform(0.8, 1.2, 3)],
        "plant.mass_scale": 1.0 + float(rng.uniform(-0.2, 0.3)) / 3.5,
        "mission.seed": number,
        "pushes": [{**p, "point": [0.0, grip * (i % 2), below]} for i, p in enumerate(pushes)],
        "sensors.joints.force_noise": 0.05 * noise,
        "sensors.gyroscope.noise": 0.01 * noise,
        **{f"sensors.motion.{k}_noise": v * noise for k, v in NOISE.items()},
    }
    return mission(changes)


NOISE = {"position": 0.003, "velocity": 0.01, "attitude": 0.002}
