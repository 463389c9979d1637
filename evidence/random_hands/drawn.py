"""Hands drawn at random: shakes, couples, taps, trains of taps, leaning, pulling, pressing and an arm's spring.

All forces are those for the 3.5 kg of `iris`, in proportion to the mass. A family has a mission, a way to sense the
push, and a weather; its hands differ in kind, size, place and battery or load.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

import tandemlift as tl
from tandemlift.core.types import Array
from tandemlift.missions import Mission
from tandemlift.parts.flight_checks.authority import HAND_MASS

MISSIONS = (
    *("iris", "crazyflie-stick", "two-x500", "heavy-payload", "off-centre-push", "rotor-loss", "gusts"),
    *("zigzag", "narrow", "narrow-zigzag", "doorway"),
)
OBSERVERS = ("momentum", "hybrid", "kalman", "extended-kalman", "unscented", "fused")
KINDS = ("shake", "couple", "tap", "taps", "lean", "pull", "press", "arm")
CONDITIONS = ("nominal", "low battery", "+0.3 kg")
START, LASTS, RESTS = 11.0, 8.0, 4.0  # s: after lift and tare; of a hand at most; after it
WIND = 3.0  # m/s
BATTERY, LOAD = 0.9, 0.3  # of the thrust; kg for 3.5 kg
HOVER: dict[str, Any] = {  # a hover without walls, person, faults and landing
    **{"phases.lift_start": 1.0, "phases.lift_duration": 5.0, "phases.land_start": None, "supervision.model": "none"},
    **{"estimator.tare_start": 7.0, "estimator.tare_duration": 3.0, "person.model": "none", "person.path": []},
    **{"walls": [], "corridor.centreline": [], "faults": [], "requests": [], "wind.gusts": [], "pushes": []},
    **{"mission.duration": START + LASTS + RESTS, "mission.log_interval": 0.02},
}


class Family(NamedTuple):
    """What hands have in common: number, built-in mission, source of the push, and whether it blows."""

    number: int
    base: str
    observer: str
    windy: bool


class Hand(NamedTuple):
    """A hand: its family, kind, condition, the changes by which it is flown, the mission, and its hand's warnings."""

    family: Family
    kind: str
    condition: str
    changes: dict[str, Any]
    mission: Mission
    warnings: tuple[str, ...]


def families(seed: int, count: int, bases: tuple[str, ...]) -> Iterator[Family]:
    """Families: half of those of `iris` by its joint sensors or another observer each, the others by their own."""
    rng = np.random.default_rng([seed, 52])
    for number in range(count):
        base = bases[number % len(bases)]
        observer = str(rng.choice(OBSERVERS)) if base == "iris" and rng.random() < 0.75 else ""
        yield Family(number, base, observer, bool(rng.random() < 0.4))


def drawn_hand(seed: int, family: Family, member: int) -> Hand:
    """A hand of a family."""
    rng = np.random.default_rng([seed, family.number, member])
    common = family_changes(family, rng)
    plain = tl.load_mission(family.base, {**HOVER, **common})
    kind = KINDS[(family.number + member) % len(KINDS)]
    condition = str(rng.choice(CONDITIONS, p=[0.5, 0.25, 0.25]))
    scale = plain.hover.mass / HAND_MASS
    own: dict[str, Any] = {
        "nominal": {},
        "low battery": {"plant.thrust_scale": BATTERY * plain.plant.thrust_scale},
        "+0.3 kg": {"plant.mass_scale": plain.plant.mass_scale + LOAD / HAND_MASS},
    }[condition]
    before = {**HOVER, **common, **own, "mission.seed": int(rng.integers(1, 10**6))}
    changes = before | DRAWS[kind](rng, plain, scale)
    _, known = _loaded(family.base, before)
    mission, said = _loaded(family.base, changes)
    return Hand(family, kind, condition, changes, mission, tuple(text for text in said if text not in known))


def _loaded(base: str, changes: dict[str, Any]) -> tuple[Mission, list[str]]:
    """(The mission, its warnings)."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", tl.FlightWarning)
        mission = tl.load_mission(base, changes)
    return mission, [str(w.message) for w in heard]


def family_changes(family: Family, rng: np.random.Generator) -> dict[str, Any]:
    """The changes of a family: its observer, and wind from any side."""
    found = dict[str, Any]()
    if family.observer:
        sensed = {} if family.observer == "fused" else {"sensors.joints.model": "none"}
        found |= {"estimator.wrench": family.observer, "estimator.wind_compensation": "none", **sensed}
    angle = rng.uniform(0.0, 2.0 * math.pi)
    blows = {"wind.model": "air", "wind.velocity": [WIND * math.cos(angle), WIND * math.sin(angle), 0.0]}
    return found | (blows if family.windy else {"wind.model": "none"} if family.base != "gusts" else {})


def _place(rng: np.random.Generator, mission: Mission) -> Array:
    """The middle, near an end, or anywhere on the payload, off its axis too [m, body axes]."""
    vehicle = mission.hover.vehicle
    low, high = vehicle.payload.box
    half = 0.5 * (vehicle.payload.span or 2.0 * float(np.abs(vehicle.lever_arms[:, 1]).max()))
    y = rng.choice([0.0, 0.9 * half, -0.9 * half, rng.uniform(-half, half)])
    off = rng.uniform(low, high) * [1.0, 0.0, 1.0] if rng.random() < 0.5 else np.zeros(3)
    return np.asarray(vehicle.origin + off + np.array([0.0, y, 0.0]))


def _way(rng: np.random.Generator) -> Array:
    """A world axis, or any direction."""
    way = np.eye(3)[rng.integers(3)] if rng.random() < 0.75 else rng.normal(size=3)
    return np.asarray(way / np.linalg.norm(way))


def _bell(force: Array, time: float, sigma: float, point: Array) -> dict[str, Any]:
    return {"force": force.tolist(), "time": time, "sigma": sigma, "point": point.tolist()}


def held(force: Array, begin: float, rise: float, end: float, sigma: float, point: Array) -> list[dict[str, Any]]:
    """A force that rises over `rise` [s] and is let go within some σ [s]: Gaussians σ apart make it."""
    times = np.arange(begin, end, sigma)
    share = np.minimum((times - begin) / rise, 1.0) / math.sqrt(2.0 * math.pi)
    return [_bell(force * s, float(t), sigma, point) for t, s in zip(times, share, strict=True) if s > 0.0]


def _sine(force: Array, frequency: float, point: Array) -> list[dict[str, Any]]:
    """A sine within 0.2 %: Gaussians of alternating sign, half a period apart, of a fifth of it."""
    sigma, count = 0.2 / frequency, max(1, round(2.0 * LASTS * frequency))
    scale = 0.8 * math.sqrt(2.0 * math.pi) * math.exp(-0.5 * (0.4 * math.pi) ** 2)
    times = [START + (0.5 * k + 0.25) / frequency for k in range(count)]
    return [_bell(force * (-1) ** k / scale, t, sigma, point) for k, t in enumerate(times)]


def shake(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """0.5 to 10 Hz, 0.5 to 6 N peak."""
    frequency, peak = math.exp(rng.uniform(math.log(0.5), math.log(10.0))), rng.uniform(0.5, 6.0) * scale
    return {"pushes": _sine(peak * _way(rng), frequency, _place(rng, mission))}


def couple(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """Two hands that shake about the vertical, 0.25 to 3 N each, one against the other."""
    frequency, peak = math.exp(rng.uniform(math.log(0.5), math.log(10.0))), rng.uniform(0.25, 3.0) * scale
    vehicle = mission.hover.vehicle
    arm = np.array([0.0, rng.uniform(0.1, 0.45) * (vehicle.payload.span or 1.0), 0.0])
    force = peak * np.array([1.0, 0.0, 0.0])
    return {"pushes": [*_sine(force, frequency, vehicle.origin + arm), *_sine(-force, frequency, vehicle.origin - arm)]}


def tap(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """One of 0.1 to 1 N s, within 10 to 100 ms."""
    lasts, impulse = math.exp(rng.uniform(math.log(0.01), math.log(0.1))), rng.uniform(0.1, 1.0) * scale
    return {"pushes": [_tap(impulse * _way(rng), START + 0.5, lasts, _place(rng, mission))]}


def _tap(impulse: Array, time: float, lasts: float, point: Array) -> dict[str, Any]:
    sigma = lasts / math.sqrt(2.0 * math.pi)  # a Gaussian has the impulse of its peak for this time
    return _bell(impulse / lasts, time, sigma, point)


def taps(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """3 to 20 of 0.05 to 0.4 N s one way, 1 to 6 a second."""
    way, point, apart = _way(rng), _place(rng, mission), 1.0 / rng.uniform(1.0, 6.0)
    impulse, lasts = rng.uniform(0.05, 0.4) * scale, rng.uniform(0.01, 0.05)
    count = min(int(rng.integers(3, 21)), int((LASTS - 0.5) / apart))
    return {"pushes": [_tap(impulse * way, START + 0.5 + k * apart, lasts, point) for k in range(count)]}


def lean(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """Up to 8 N for 2 to 6 s, let go at once."""
    force = rng.uniform(1.0, 8.0) * scale * _way(rng) * [1.0, 1.0, 0.3]
    end = START + rng.uniform(2.0, 6.0)
    return {"pushes": held(force, START, rng.uniform(0.2, 1.0), end, 0.03, _place(rng, mission))}


def pull(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """At an end, around the threshold: 0.5 to 3 times it."""
    vehicle, axis = mission.hover.vehicle, int(rng.integers(3))
    end = 0.45 * (vehicle.payload.span or 1.0) * float(rng.choice([-1.0, 1.0]))
    force = np.eye(3)[axis] * rng.uniform(0.5, 3.0) * mission.admittance.threshold[axis] * rng.choice([-1.0, 1.0])
    last = START + rng.uniform(3.0, 7.5)
    point = vehicle.origin + np.array([0.0, end, 0.0])
    return {"pushes": held(force, START, 1.0, last, rng.uniform(0.03, 0.2), point)}


def press(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """Down by up to 6 N for 0.5 to 2 s, then up as hard."""
    point, half = _place(rng, mission) if rng.random() < 0.5 else mission.hover.vehicle.origin, rng.uniform(0.5, 2.0)
    force = np.array([0.0, 0.0, rng.uniform(1.0, 6.0) * scale])
    down = held(-force, START, 0.2, START + half, 0.05, point)
    return {"pushes": [*down, *held(force, START + half + 0.3, 0.2, START + 2.0 * half + 0.3, 0.05, point)]}


def arm(rng: np.random.Generator, mission: Mission, scale: float) -> dict[str, Any]:
    """An arm's spring that holds the grip, and follows; shaken at its resonance with the vehicle's mass."""
    vehicle, start = mission.hover.vehicle, mission.initial
    k, c = rng.uniform(3.0, 25.0) * scale, rng.uniform(0.3, 3.0) * scale
    grip = float(rng.choice([0.0, 0.45, -0.45])) * (vehicle.payload.span or 1.0)
    yaw, (x, y, _) = start.euler[2], start.position
    hand = [x - grip * math.sin(yaw), y + grip * math.cos(yaw)]
    frequency = math.sqrt(k / mission.hover.mass) / (2.0 * math.pi)
    force = rng.uniform(0.2, 2.0) * scale * np.array([1.0, 0.0, 0.0] if rng.random() < 0.5 else [0.0, 1.0, 0.0])
    person = {"model": "hold", "grip": grip, "path": [{"point": hand, "dwell": 1e4}], "start_time": START - 0.5}
    person |= {"stiffness": k, "damping": c, "max_force": 8.0 * scale}
    pushes = _sine(force, frequency, vehicle.origin + np.array([0.0, grip, 0.0]))
    return {"pushes": pushes, "person": person}


DRAWS: dict[str, Callable[[np.random.Generator, Mission, float], dict[str, Any]]] = {
    **{"shake": shake, "couple": couple, "tap": tap, "taps": taps, "lean": lean, "pull": pull, "press": press},
    "arm": arm,
}
