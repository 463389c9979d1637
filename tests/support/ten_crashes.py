"""Ten missions that crash, each in another way, and what a flight of them in an engine tells of it."""

from __future__ import annotations

from typing import Any, NamedTuple

import tandemlift as tl
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import flight_of
from tandemlift.simulation.stepping import body_of, fly_stepwise
from tandemlift.simulation.touches import TouchReport, touches_of

HELD = {  # iris, held at the start in the air by a pilot who knows its state
    "pushes": [],
    "pilot.state": "truth",
    "pilot.push": "truth",
    "sensors.model": "none",
    "estimator.tare_start": None,
    "estimator.identify_mass": False,
    "actuators.start": "hover",
    "phases.rotors": "always",
    "phases.lift_start": 60.0,
    "phases.land_start": 70.0,
    "initial.position": 0.0,
    "ground.height": -1.5,
    "mission.duration": 6.0,
    "crash.fly_on": 4.0,
}
THROWN = HELD | {"actuators.start": "stopped", "phases.rotors": "flight"}  # rotors stand still
LONG = {"vehicle.payload.length": 3.2}  # the beam reaches beyond the guards
BARE = {f"vehicle.quadrotors.{i}.guard_radius": 0.2 for i in (0, 1)}  # rotors stand out of their guards
WALL_AHEAD = {"walls": [{"start": [0.95, 0.7], "end": [0.85, 2.0], "top": 9.0}]}  # of quadrotor 1 alone
WALL_ACROSS = {"walls": [{"start": [0.9, 3.0], "end": [1.0, -3.0], "top": 9.0}]}
WALL_BESIDE = {"walls": [{"start": [-2.0, 2.2], "end": [2.0, 2.3], "top": 9.0}]}
ALL_ROTORS = [(i, j) for i in (1, 2) for j in (1, 2, 3, 4)]


def _lost(rotors: list[tuple[int, int]], time: float) -> list[dict[str, Any]]:
    return [{"quadrotor": i, "rotor": j, "time": time, "efficiency": 0.0} for i, j in rotors]


CRASHES: dict[str, dict[str, Any]] = {
    "turned over by an unknown moment": HELD | {"disturbance.moment": [0.3, 5.0, 0.5]},
    "thrown onto its back": THROWN
    | {"initial.euler": [0.3, 1.4, 0.5], "initial.velocity": [1.0, 0.5, 0.5], "initial.rates": [0.8, 3.0, 0.0]},
    "dropped on one end of the beam": THROWN | LONG | {"initial.euler": [1.1, 0.05, 0.0], "ground.height": -2.0},
    "dropped on its side": THROWN | {"initial.euler": [0.05, 1.3, 0.4], "initial.rates": [0.2, 0.3, 0.0]},
    "flown into a wall with one rotor": HELD | BARE | WALL_AHEAD | {"initial.velocity": [3.2, 0.0, 0.0]},
    "flown into a wall with its guards": HELD | WALL_ACROSS | {"initial.velocity": [4.0, 0.2, 0.0]},
    "flown into a wall with one end of the beam": HELD | LONG | WALL_BESIDE | {"initial.velocity": [0.0, 3.0, 0.0]},
    "front rotors lost without a word": HELD
    | {"faults": _lost([(1, 1), (1, 3), (2, 1), (2, 3)], 0.5), "disturbance.moment": [0.5, 0.0, 0.0]},
    "fallen from 2 m at a stop": HELD | {"ground.height": -2.2, "faults": _lost(ALL_ROTORS, 0.5)},
    "landed too fast while drifting": THROWN
    | {"initial.velocity": [4.0, 0.3, -2.0], "ground.height": -0.7, "initial.euler": [0.1, 0.5, 0.0]},
}


class Crashed(NamedTuple):
    """A crash in an engine: the flight, its touches in the order of time, and where it is at the end [m]."""

    flight: Flight
    touches: list[TouchReport]
    rests: tuple[float, float, float]


def crash_mission(name: str) -> Mission:
    """The mission of a crash by its name."""
    return tl.load_mission("iris", CRASHES[name] | {"mission.name": "crash"})


def crashed_in(engine: str, mission: Mission) -> Crashed:
    """A crash as an engine flies it."""
    p = FlightPlan(mission, engine)
    raw = fly_stepwise(p, p.steps // p.every + 1, p.every, None, body_of(p))
    x, y, z = map(float, raw.flight_state.state.position)
    return Crashed(flight_of(p, raw, engine), touches_of(raw.flight_state), (x, y, z))
