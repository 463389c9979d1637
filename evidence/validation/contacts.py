"""Rows about contacts: touches of walls are detected quickly, and pushes are not misclassified as such.

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

from tandemlift.core.faults import ALARM_TEXTS, FAULTS
from tandemlift.core.phases import CONTACT, GUIDED, HOLD
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, load_mission
from validation.persons import random_persons
from validation.rows import Row
from validation.scenarios import Bench, Changes

SIDE, POST, ACROSS, MOUTH = "side", "post", "across", "mouth"
KINDS = (SIDE, POST, ACROSS, MOUTH)
WATCHED: Changes = {"supervision.model": "on", "phases.land_start": 1e6, "mission.log_interval": 0.002}
SLOWEST, FASTEST = 0.2, 1.0  # m/s
START = 8.0  # s, after the tare
SOON = 0.15  # s
SPARE = 1.15  # times as many flights as touches, because some miss the wall
MINUTES = 5.0  # of hands for each draw
LEAST_SHARE, MOST_FALSE = 0.95, 1
BLOW = 10  # logged samples of 2 ms: the first impact
SENSOR_FAULTS = {fault.text for fault in FAULTS[:9]}
PERSON, HAND = 60.0, 240.0  # s, with a hand on the beam, of one flight with a person, and of one with jerky pushes
TURBULENT = (0.0, 2.0, 4.0, 7.7)  # m/s, wind at 20 ft of the turbulence; the mean wind is half of it


class Touch(NamedTuple):
    """The result of a touch: its speed [m/s]; the time until it was named [s], or None; whether in its direction.

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
    speed, side = float(rng.uniform(SLOWEST, 1.03 * FASTEST)), float(rng.choice([-1.0, 1.0]))
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
        changes |= {
            "corridor.centreline": [],
            "walls": [wall],
            "person.path": [{"point": [8.0, float(rng.uniform(-1.0, 1.0))]}],
        }
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
    """The result of the first touch of a flight; None if it touches nothing in the air."""
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
        right=bool(len(after))
        and float(force[first : first + BLOW].sum(axis=0) @ flight["contact_normal"][after[0]]) > 0.0,
        sensor_fault=bool(blamed) and any(text.startswith(tuple(SENSOR_FAULTS)) for text in blamed),
        crashed=flight.ending is not None,
        landed=any(text.endswith("land") for text in events),
    )


def jerky_pushes(rng: np.random.Generator, until: float) -> list[dict[str, Any]]:
    """Pushes of up to 7 N from START on, of 30 ms to 0.6 s, at any point of the beam, in any direction."""
    pushes, time = list[dict[str, Any]](), START
    while time < until:
        force, angle = rng.uniform(0.5, 7.0), rng.uniform(0.0, 2.0 * np.pi)
        sigma = 0.03 * 20.0 ** rng.uniform(0.0, 1.0)
        push = [force * np.cos(angle), force * np.sin(angle), rng.uniform(-0.3, 0.3)]
        point = [0.0, float(rng.uniform(-1.0, 1.0)), -0.0642857]
        pushes.append({"force": [float(x) for x in push], "time": time, "sigma": float(sigma), "point": point})
        time += float(rng.uniform(0.3, 2.0))
    return pushes


def jerky(number: int) -> Mission:
    """A hover in wind, with jerky pushes."""
    rng = np.random.default_rng([number, len(KINDS)])
    air, angle = TURBULENT[number % len(TURBULENT)], rng.uniform(0.0, 2.0 * np.pi)
    wind = [0.5 * air * float(np.cos(angle)), 0.5 * air * float(np.sin(angle)), 0.0]
    changes: Changes = {
        **WATCHED,
        "mission.seed": number,
        "mission.duration": START + HAND,
        "corridor.centreline": [],
        "person.model": "none",
        "pushes": jerky_pushes(rng, START + HAND),
        "admittance.threshold": [0.3, 0.3, 4.0],  # or gusts from above lead it to the floor
        "supervision.watchdog.max_position": 1000.0,  # pushes lead it far
        "wind.model": "air",
        "wind.velocity": wind,
        "wind.turbulence": max(air, 1e-3),
    }
    return load_mission("zigzag", changes)


def hands(minutes: float) -> list[Mission]:
    """Missions with that time of hands on the beam [min], half of it of persons, half of it jerky."""
    half, watched = 30.0 * minutes, {"supervision.model": "on", "mission.duration": START + PERSON}
    led = random_persons("zigzag", max(1, round(half / PERSON)), seed=2, changes=watched)
    return [*led, *map(jerky, range(max(1, round(half / HAND))))]


def broken(number: int) -> Mission:
    """A flight in the open, with pushes, in which the sensor of a joint gets a horizontal bias of 3 N to 20 N."""
    rng = np.random.default_rng([number, len(KINDS) + 1])
    angle, size = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(3.0, 20.0)
    bias = [float(size * np.cos(angle)), float(size * np.sin(angle)), 0.0]
    fault = {"sensor": "joints", "kind": "bias", "quadrotor": 1 + number % 2, "time": START + 4.0, "size": bias}
    changes: Changes = {
        **WATCHED,
        "mission.seed": number,
        "mission.duration": START + 12.0,
        "corridor.centreline": [],
        "person.model": "none",
        "pushes": jerky_pushes(rng, START + 12.0),
        "sensor_faults": [fault],
    }
    return load_mission("zigzag", changes)


def is_blamed(metrics: dict[str, Any]) -> bool:
    """Whether the events of a flight report that joints disagree."""
    return any(text.startswith("joints disagree") for _, text in metrics["events"])


def contacts_named(metrics: dict[str, Any]) -> int:
    """The number of contacts in the events of a flight."""
    return sum(text.startswith("contact:") for _, text in metrics["events"])


def touch_rows(touched: list[Touch]) -> Iterator[Row]:
    """The rows about touches."""
    count, named = len(touched), [1e3 * t.named for t in touched if t.named is not None]
    speeds = [t.speed for t in touched]
    what = f"{count} random touches at {min(speeds):.2f} m/s to {max(speeds):.2f} m/s: a sensor blamed"
    blamed, crashed = sum(t.sensor_fault for t in touched), sum(t.crashed for t in touched)
    yield Row(what, "0", str(blamed), blamed == 0)
    soon = sum(n <= 1e3 * SOON for n in named)
    share = f"{100.0 * soon / count:.1f} %"
    yield Row(
        f"the same: named contact within {1e3 * SOON:.0f} ms",
        f"≥ {100.0 * LEAST_SHARE:.0f} %",
        share,
        soon >= LEAST_SHARE * count,
    )
    times = "{:.0f} / {:.0f} / {:.0f} ms".format(*np.quantile(named or [np.inf], [0.5, 0.95, 1.0]))
    yield Row("the same: time until named, median / 95 % / max", "", times, None)
    yield Row("the same: named with the way out of the wall", "", f"{sum(t.right for t in touched)} of {count}", None)
    yield Row("the same: crashed", "0", str(crashed), crashed == 0)
    yield Row("the same: contact that did not end, landed", "", str(sum(t.landed for t in touched)), None)


def contacts(bench: Bench) -> Iterator[Row]:
    """Rows about touches, and about hands."""
    touched = [touch_of(flight) for flight in bench.fly(touches(round(SPARE * bench.draws)))]
    yield from touch_rows([touch for touch in touched if touch][: bench.draws])
    faulty = bench.metrics(map(broken, range(bench.draws)))
    found, false = sum(map(is_blamed, faulty)), sum(map(contacts_named, faulty))
    what = f"{bench.draws} joint sensors that get a bias of 3 N to 20 N under a hand: found"
    yield Row(what, f"{bench.draws} of {bench.draws}", f"{found} of {bench.draws}", found == bench.draws)
    yield Row("the same: contacts named", "", str(false), None)
    minutes = MINUTES * bench.draws
    flown = list(zip(missions := hands(minutes), bench.metrics(missions), strict=True))
    free = [m for _, m in flown if not m.get("wall_contact")]
    false = sum(map(contacts_named, free))
    what = f"{minutes:.0f} min of hands, {len(flown) - len(free)} flights with a wall touched left out: contacts named"
    yield Row(what, f"≤ {MOST_FALSE}", str(false), false <= MOST_FALSE)
