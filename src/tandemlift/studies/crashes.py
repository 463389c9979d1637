"""Ten crashes: how the bodies of several engines strike floor and walls.

The engines share the shapes of the vehicle's parts and their stiffness, and no equation of motion or of contact. So the
same flight must end alike: the same outcome, the same part first, at nearly the same time and place. Where the vehicle
comes to rest differs, as bounces do.
"""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np

from tandemlift.algebra.vector import Nothing
from tandemlift.common.errors import FlightWarning
from tandemlift.laws.contact.touches import TouchRecord
from tandemlift.missions import load_mission
from tandemlift.simulation.outcome import ending_of
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.stepping import body_of, fly_stepwise

Changes = dict[str, Any]
ON_ITS_OWN: Changes = {  # the rotors never start
    "pushes": [],
    "ground.height": 0.0,
    "phases.lift_start": 1e6,
    "phases.land_start": 2e6,
    "mission.duration": 20.0,
    "crash.fly_on": 10.0,
}
FACING: Changes = {"walls": [{"start": [1.0, -6.0], "end": [1.0, 6.0], "top": 3.0}]}
ALONG: Changes = {"walls": [{"start": [-6.0, 3.0], "end": [6.0, 2.8], "top": 4.0}]}
LOW: Changes = {"walls": [{"start": [-6.0, 0.3], "end": [6.0, 0.1], "top": 1.0}]}
SMALL_GUARDS: Changes = {f"vehicle.quadrotors.{i}.guard_radius": 0.1 for i in (0, 1)}  # rotors stand out


def _thrown(position: list[float], euler: list[float], more: Changes) -> tuple[str, Changes]:
    """A vehicle that is let go at a position [m] and attitude [rad], with more settings."""
    return "iris", ON_ITS_OWN | {"initial.position": position, "initial.euler": euler} | more


AT_WALL: Changes = {"initial.velocity": [3.0, 0.5, 1.0]}
CRASHES: dict[str, tuple[str, Changes]] = {  # name: mission, settings
    "falls on its feet": _thrown([0.0, 0.0, 1.4], [0.05, 0.08, 0.0], {}),
    "falls on a guard": _thrown([0.0, 0.0, 2.2], [0.7, 0.9, 0.0], {}),
    "tumbles on a rotor": _thrown([0.0, 0.0, 4.0], [0.1, 0.2, 0.3], {"initial.rates": [2.5, -1.0, 0.4]}),
    "turns upside down": _thrown([0.0, 0.0, 4.0], [0.1, 0.2, 0.3], {"initial.rates": [3.6, -0.6, 0.4]}),
    "flies into a wall": _thrown([-1.0, 0.0, 2.0], [0.0, 0.1, 0.3], FACING | AT_WALL),
    "flies into a wall with a rotor": _thrown([-1.0, 0.0, 2.0], [0.0, 0.1, 0.3], FACING | AT_WALL | SMALL_GUARDS),
    "slides into a wall": _thrown([-1.0, 0.0, 2.0], [0.1, 0.1, 0.2], ALONG | {"initial.velocity": [0.3, 3.5, 2.0]}),
    "falls with the beam on a wall": _thrown([0.0, 0.0, 2.5], [0.1, 0.05, 0.2], LOW),
    "is pushed into a wall": (
        "zigzag",
        {
            "crash.fly_on": 10.0,
            "mission.duration": 20.0,
            "pushes": [{"force": [0.0, 40.0, 0.0], "time": 8.0, "sigma": 0.5}],
        },
    ),
    "rotors answer too late": ("iris", {"actuators.delay": 0.2, "mission.duration": 20.0, "crash.fly_on": 10.0}),
}


class FirstTouch(NamedTuple):
    """The first touch: part such as "rotor 1 of quadrotor 2", surface, time [s], place (3) [m, world axes]."""

    part: str
    surface: str
    time: float
    place: tuple[float, ...]


class Crash(NamedTuple):
    """A crash in an engine: its ending in words, the first touch or None, and where the vehicle comes to rest.

    Attributes:
        outcome: of the flight.
        ending: in words.
        first: the first touch; None if only feet touch.
        rest: position of the centre of mass at the end [m, world axes] (3).
        time: of the end [s].
    """

    outcome: str
    ending: str
    first: FirstTouch | None
    rest: tuple[float, ...]
    time: float


def crash_in(name: str, engine: str) -> Crash:
    """One of the `CRASHES` in an engine."""
    with warnings.catch_warnings():  # they are meant to end badly
        warnings.simplefilter("ignore", FlightWarning)
        mission, changes = CRASHES[name]
        p = FlightPlan(load_mission(mission, changes), engine)
    flown = fly_stepwise(p, 1, p.steps + 1, body=body_of(p))
    state, ending = flown.flight_state, ending_of(p, flown.flight_state, flown.step)
    rest = tuple(float(v) for v in state.state.position)
    return Crash(ending.outcome if ending else "", str(ending), first_touch(state.touches), rest, flown.step * p.dt)


def first_touch(touches: Any) -> FirstTouch | None:
    """The first of all touches of a flight; None without any."""
    found = []
    for surface in ("floor", "walls"):
        records = getattr(touches, surface, Nothing())
        for kind in getattr(records, "_fields", ()):
            record = getattr(records, kind)
            if isinstance(record, TouchRecord) and record.part > 0.5:
                place = tuple(float(v) for v in record.place)
                part = _part(kind, int(record.part))
                found.append(FirstTouch(part, surface.removesuffix("s"), float(record.time), place))
    return min(found, key=lambda touch: touch.time, default=None)


def _part(kind: str, number: int) -> str:
    """A part in words."""
    if kind == "rotors":
        return f"rotor {(number - 1) % 4 + 1} of quadrotor {(number - 1) // 4 + 1}"
    return "beam" if kind == "beam" else f"guard of quadrotor {number}"


def apart(a: FirstTouch, b: FirstTouch) -> tuple[float, float]:
    """How much two first touches differ in time [s] and in place [m]."""
    return abs(a.time - b.time), float(np.linalg.norm(np.subtract(a.place, b.place)))
