"""Rows about contacts: touches of walls are named as such, quickly, and hands are not.

Touches: the supervised vehicle of mission zigzag, with its sensors' noise, at up to 1 m/s. It is pushed at a random
point of the beam into the side of a corridor (`SIDE`), or onto a post between its guards, so that the beam touches
(`POST`); a hand leads it into a wall across its way (`ACROSS`), or into a corridor that is too narrow for it as it is
turned (`MOUTH`). Hands: random persons in mission zigzag, and hours of jerky pushes at any point of the beam in
turbulent wind, in a pilot without a map. Neither touches anything.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.faults import ALARM_TEXTS, FAULTS
from tandemlift.common.phases import CONTACT, GUIDED, HOLD
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, load_mission
from tandemlift.studies.persons import random_persons
from tandemlift.studies.rows import Row
from tandemlift.studies.scenarios import Bench, Changes

SIDE, POST, ACROSS, MOUTH = "side", "post", "across", "mouth"
KINDS = (SIDE, POST, ACROSS, MOUTH)
WATCHED: Changes = {"supervision.model": "watch", "phases.land_start": 1e6, "mission.log_interval": 0.002}
SLOWEST, FASTEST = 0.2, 1.0  # m/s
START = 8.0  # s, after the tare
SOON = 0.15  # s
LEAST_SHARE, MOST_FALSE = 0.95, 1
FREE = 6.0  # s, in which a flight with a touch ends after it
SENSOR_FAULTS = {fault.text for fault in FAULTS[:9]}
HAND_MINUTES = 2.0  # of one flight with hands
TURBULENT = ((1.0, 2.0), (2.0, 4.0), (3.0, 7.7))  # m/s: mean wind, wind at 20 ft of the turbulence


class Touch(NamedTuple):
    """What became of a touch: its speed [m/s]; after how long it was named [s], or None; whether by the right part.

    `sensor_fault`: whether a sensor was blamed; `crashed`; `landed`: whether it led to a landing.
    """

    speed: float
    named: float | None
    right: bool
    sensor_fault: bool
    crashed: bool
    landed: bool


def limited(speed: float, angle: float) -> Changes:
    """The largest speed [m/s] of a reference in a direction [rad]."""
    most = [max(speed * abs(np.cos(angle)), 0.05), max(speed * abs(np.sin(angle)), 0.05), 1.0]
    return {"compliance.max_speed": [float(v) for v in most]}


def pushed(force: float, angle: float, point: float, rng: np.random.Generator) -> list[dict[str, Any]]:
    """A push of 2 s or so in a direction [rad], at a point of the beam [m]."""
    sigma = float(rng.uniform(0.5, 0.9))
    push = [float(force * np.cos(angle)), float(force * np.sin(angle)), 0.0]
    return [
        {"force": push, "time": START + 0.5 + i * sigma, "sigma": sigma, "point": [0.0, point, -0.0642857]}
        for i in range(2, 7)
    ]


def touching(kind: str, number: int) -> Mission:
    """The mission of a touch of a kind."""
    rng = np.random.default_rng([number, KINDS.index(kind)])
    speed, side = float(rng.uniform(SLOWEST, 0.9 * FASTEST)), float(rng.choice([-1.0, 1.0]))
    changes: Changes = {**WATCHED, "mission.seed": number, "mission.duration": 24.0}
    if kind == SIDE:
        angle = side * float(rng.uniform(np.pi / 6.0, np.pi * 5.0 / 6.0))
        push = pushed(2.5, angle, float(rng.uniform(-0.3, 0.3)), rng)
        changes |= {**limited(speed, angle), "person.model": "none", "pushes": push}
    elif kind == POST:
        y = float(rng.uniform(-0.35, 0.35))
        changes |= {**limited(speed, 0.0), "person.model": "none", "pushes": pushed(2.5, 0.0, 0.0, rng)}
        changes |= {"corridor.centreline": [], "walls": [{"start": [1.2, y], "end": [1.2 + rng.uniform(0.1, 1.0), y]}]}
    elif kind == ACROSS:
        tilt = float(rng.uniform(-1.0, 1.0))
        wall = {"start": [2.5 - tilt, -8.0], "end": [2.5 + tilt, 8.0]}
        changes |= {"corridor.centreline": [], "walls": [wall], "person.path": [{"point": [8.0, float(rng.uniform(-1.0, 1.0))]}]}
        changes |= {"person.model": "steer", "person.grip": float(rng.uniform(-0.4, 0.4)), "person.speed": speed}
        changes |= {"compliance.max_speed": [speed, speed, 1.0]}
    else:
        y = float(rng.uniform(-0.25, 0.25))
        changes |= {"corridor.centreline": [[2.0, y], [12.0, y]], "corridor.width": float(rng.uniform(1.6, 2.4))}
        changes |= {"person.path": [{"point": [8.0, 0.0]}], "person.speed": speed}
        changes |= {"compliance.max_speed": [speed, speed, 1.0]}
    return load_mission("zigzag", changes)


def touches(count: int) -> list[Mission]:
    """Missions with a touch each, of all kinds in turn."""
    return [touching(KINDS[i % len(KINDS)], i) for i in range(count)]


def touch_of(flight: Flight) -> Touch | None:
    """What became of the first touch of a flight; None if it touches nothing in the air."""
    phase, force = flight["phase"], flight["contact_force"]
    aloft = np.isin(phase, (GUIDED, HOLD, CONTACT))
    touched = np.flatnonzero(aloft & np.any(force != 0.0, axis=1))
    if not len(touched):
        return None
    first = touched[0]
    after = np.flatnonzero((flight["contact_part"] != 0.0) & (flight.time >= flight.time[first]))
    events = [text for _, text in flight.metrics()["events"]]
    blamed = {ALARM_TEXTS[int(a)] for a in np.unique(flight["alarm"]) if a}
    return Touch(
        speed=float(np.linalg.norm(flight["velocity"][first])),
        named=float(flight.time[after[0]] - flight.time[first]) if len(after) else None,
        right=bool(len(after)) and bool(force[touched] @ flight["contact_normal"][after[0]] @ np.ones(len(touched)) > 0.0),
        sensor_fault=bool(blamed) and any(text.startswith(tuple(SENSOR_FAULTS)) for text in blamed),
        crashed=flight.divergence is not None,
        landed=any(text.endswith("land") for text in events),
    )
