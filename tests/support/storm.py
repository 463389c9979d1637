"""A mission with all parts, and the same mission in calm: one compiled loop for the tests of whole flights.

Two different quadrotors off the beam's axes, delays of all signals, a floor, two walls, wind with turbulence and a
gust, a fault that the pilot knows, a tare, a push off the centre, guidance by hand and an observer. `CALM` has the same
parts without effect: no wind, walls out of reach, a fault after the end, perfect sensors.
"""

from typing import Any

import numpy as np

import tandemlift as tl

DT = 0.001
UNIT, MOTION, COMMAND = 3, 10, 10  # steps of delay


def quadrotors() -> list[dict[str, Any]]:
    """Two quadrotors that differ in position and mass, so that the inertia tensor is full."""
    iris = tl.load_mission("iris").vehicle.quadrotors[0].model_dump(mode="json", exclude_none=True)
    return [{**iris, "position": p, "mass": m} for p, m in (([0.05, 1.0, 0.075], 1.4), ([-0.04, -0.95, 0.09], 1.6))]


STORM: dict[str, Any] = {
    "vehicle.quadrotors": quadrotors(),
    "mission.duration": 5.0,
    "phases.lift_start": 0.3,
    "phases.lift_duration": 1.5,
    "phases.height": 0.6,
    "phases.land_start": 3.6,
    "phases.land_duration": 1.2,
    "compliance.max_descent_speed": 1.0,
    "observer.force_bandwidth": [0.1, 20.0, 18.0],  # rad/s; slow along x, so that the wind presses against the wall
    "estimator.tare_start": 2.0,
    "estimator.tare_duration": 0.4,
    "sensors.delay": UNIT * DT,
    "sensors.motion.delay": MOTION * DT,
    "actuators.delay": COMMAND * DT,
    "wind.model": "air",
    "wind.velocity": [2.0, 1.0, 0.2],
    "wind.turbulence": 4.0,
    "wind.gusts": [{"velocity": [2.0, 0.0, 0.5], "start": 2.5, "rise": 0.4, "hold": 0.3}],
    "walls": [{"start": [0.5, -3.0], "end": [0.4, 3.0]}, {"start": [-2.0, 1.5], "end": [2.0, 1.6], "top": 0.4}],
    "faults": [{"quadrotor": 2, "rotor": 3, "time": 3.0, "efficiency": 0.6, "known_after": 0.05}],
    "pushes": [{"force": [2.0, 1.0, -1.0], "time": 2.8, "sigma": 0.15, "point": [0.0, 0.6, -0.06]}],
}

PERFECT: dict[str, Any] = {
    **{f"sensors.joints.{what}_{error}": 0.0 for what in ("force", "torque") for error in ("noise", "bias", "drift")},
    **{f"sensors.joints.{what}_resolution": 0.0 for what in ("force", "torque")},
    "sensors.joints.misalignment": 0.0,
    **{f"sensors.{who}.{error}": 0.0 for who in ("accelerometer", "gyroscope") for error in ("noise", "bias", "drift")},
    **{f"sensors.motion.{what}_noise": 0.0 for what in ("position", "velocity", "attitude")},
}
CALM: dict[str, Any] = {
    **STORM,
    **PERFECT,
    "vehicle.drag.force": 0.0,
    "vehicle.drag.moment": 0.0,
    "vehicle.payload.drag_coefficient": 0.0,
    "wind.velocity": 0.0,
    "wind.turbulence": 1e-9,
    "wind.gusts": [],
    "walls": [{"start": [900.0, 0.0], "end": [900.0, 1.0]}],
    "faults": [{"quadrotor": 1, "rotor": 1, "time": 900.0}],
}


def storm(changes: dict[str, Any] | None = None, **keywords: Any) -> Any:
    """The mission with all parts, with changes."""
    return tl.load_mission("iris", STORM | (changes or {}), **keywords)


def calm(changes: dict[str, Any] | None = None) -> Any:
    """The mission in calm, with changes."""
    return tl.load_mission("iris", CALM | (changes or {}))


def storms(count: int) -> list[Any]:
    """Missions that differ in all that can differ within one compiled loop."""
    rng, made = np.random.default_rng(4), []

    def drawn() -> list[float]:
        return rng.uniform(-2.0, 2.0, 3).tolist()

    for i in range(count):
        changes = {
            "mission.seed": i,
            "plant.mass_scale": 1.0 + 0.02 * i,
            "wind.velocity": drawn(),
            "wind.turbulence": 1.0 + i,
            "wind.gusts": [{"velocity": drawn(), "start": 1.0 + j, "rise": 0.3} for j in range(i % 3)],
            "walls": [{"start": [0.5 - 0.02 * j, -3.0], "end": [0.4, 3.0]} for j in range(1 + i % 3)],
            "faults": [{"quadrotor": 1 + i % 2, "rotor": 1 + i % 4, "time": 0.5 * i, "efficiency": 0.1 * i}],
        }
        push = {"sigma": 0.2, "point": [0.0, 0.5, 0.0]}
        changes["pushes"] = [{"force": drawn(), "time": 1.0 + 0.4 * j} | push for j in range(1 + i % 4)]
        made.append(storm(changes))
    return made
