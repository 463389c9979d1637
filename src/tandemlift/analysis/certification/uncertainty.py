"""The uncertain vehicle of a mission: its box of parameters, the mission with deviations, responses of its hover.

Mass and thrust change the hover, and with it what the pilot does. So the loop is linearized at two more values p of
each, where its response is off by Δ₁ and Δ₂; U p (I − V p)⁻¹ W of the least rank passes through all three, and is exact
for a response that is so rational.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.structured_singular_value import Complex
from tandemlift.analysis.linearization.frequency_response import frequency_response
from tandemlift.analysis.linearization.linear_model import LinearModel
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import (
    DELAYS,
    LOW_END,
    NO_KINK,
    POINTS,
    calm_mission,
    is_calm,
    rotor_delay_and_lag,
    rotors_of,
)
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.types import Array
from tandemlift.missions import HoverFacts, Mission, check, tables_of

INERTIAS = ("inertia_x", "inertia_y", "inertia_z")
UNITS = {"mass": "1", **dict.fromkeys(INERTIAS, "1"), "thrust": "1", "lag": "1", "delay": "s"}
DEFAULT_BOX: Mapping[str, float] = {
    "mass": 0.1,
    **dict.fromkeys(INERTIAS, 0.15),
    "thrust": 0.1,
    "lag": 0.3,
    "delay": 0.005,
    "rotors": 0.02,
}
"""Half widths: relative, the delay's in s, by which it is longer; "rotors": of each rotor's own gain."""
LIMIT = 10  # parameters beside the rotors
MAX_SHARE = 0.9  # relative, that a parameter deviates
MAX_DELAY = 0.2  # s, of the delay
RANK_TOLERANCE = 1e-3  # of the largest singular value at any frequency
SENSOR_BAND = 0.5  # of half the sample rate, where sensors are slower than the steps in which rotors act
SECONDS, GROWTH = 90.0, 1.5  # s of a tier with the most parameters; its growth with each further one

Values = Mapping[str, float]
"""Deviations of parameters by name; rotors are "rotor.1", "rotor.2", …; the others are 0."""


class Span(NamedTuple):
    """The interval of a parameter's deviation: its middle and half its width."""

    middle: float
    half: float


def parameters_of(hover: HoverFacts, box: Mapping[str, float]) -> dict[str, float]:
    """The half width of each parameter that has an effect, of "rotors" for each rotor.

    Raises:
        InputError: a parameter is unknown, a width is not allowed, or there are more than ten beside the rotors.
    """
    rotors = [f"rotor.{i + 1}" for i in range(hover.vehicle.rotor_count)]
    for name, width in box.items():
        if name not in {*UNITS, *rotors, "rotors"}:
            raise unknown("uncertain parameter", name, [*UNITS, "rotors", *rotors])
        most = MAX_DELAY if name == "delay" else MAX_SHARE
        if not 0.0 < width < most:
            raise InputError(f"uncertain parameter {name} = {width:g}: its half width must be in (0, {most:g})")
    named = [name for name in box if name != "rotors"]
    if len(named) > LIMIT:
        minutes = SECONDS * GROWTH ** (len(named) - LIMIT) / 60.0
        raise InputError(
            f"{len(named)} uncertain parameters: must be at most {LIMIT} beside rotors, or the search for the worst "
            f"takes some {minutes:.2g} min; leave out {', '.join(named[LIMIT:])}"
        )
    without = set() if hover.lag else {"lag"}
    if hover.actuators.model != "rotors":
        rotors, without = [], {"thrust", "lag", "delay"}
    own = {name: box.get(name, box.get("rotors", 0.0)) for name in rotors}
    return {n: box[n] for n in UNITS if n in box and n not in without} | {n: x for n, x in own.items() if x}


def box_at(widths: Mapping[str, float], factor: float) -> dict[str, Span]:
    """The box that is larger by a factor; the delay only grows."""
    return {
        name: Span(0.5 * factor * width, 0.5 * factor * width) if name == "delay" else Span(0.0, factor * width)
        for name, width in widths.items()
    }


def largest_factor(widths: Mapping[str, float]) -> float:
    """The factor at which a parameter of a box reaches its largest deviation."""
    return min((MAX_DELAY if name == "delay" else MAX_SHARE) / width for name, width in widths.items())


def uncertain_tables(tables: Mapping[str, Any], values: Values) -> dict[str, Any]:
    """The tables of a mission whose vehicle deviates from them, and its pilot does not.

    `plant.thrust_scale` is the gain of the strongest rotor; weaker ones have faults that the pilot does not know.

    Args:
        tables: of the mission.
        values: deviations.
    """
    fleet, plant = tables["vehicle"]["quadrotors"], tables["plant"]
    slow, gains = 1.0 + values.get("lag", 0.0), [1.0 + values.get(f"rotor.{i + 1}", 0.0) for i in range(4 * len(fleet))]
    strongest = max(gains)
    thrust = plant["thrust_scale"] * (1.0 + values.get("thrust", 0.0)) * strongest
    inertia = [x * (1.0 + values.get(name, 0.0)) for x, name in zip(plant["inertia_scale"], INERTIAS, strict=True)]
    mass = plant["mass_scale"] * (1.0 + values.get("mass", 0.0))
    return {
        **tables,
        "plant": {**plant, "mass_scale": mass, "inertia_scale": inertia, "thrust_scale": thrust},
        "vehicle": {
            **tables["vehicle"],
            "quadrotors": [{**q, "lag_up": slow * q["lag_up"], "lag_down": slow * q["lag_down"]} for q in fleet],
        },
        "actuators": {**tables["actuators"], "delay": tables["actuators"]["delay"] + values.get("delay", 0.0)},
        "faults": [
            {"quadrotor": i // 4 + 1, "rotor": i % 4 + 1, "time": 0.0, "efficiency": gain / strongest}
            for i, gain in enumerate(gains)
            if gain != strongest
        ],
    }


def calm_model(mission: Mission, values: Values, *, real: bool) -> LinearModel:
    """The linear model of a mission's calm hover, from thrusts and moments to thrusts and rates.

    Args:
        mission: the nominal one.
        values: deviations of its vehicle.
        real: whether the rotors have their lag and delay.

    Raises:
        InputError: the controller is plain Python, or the flight is lost.
    """
    real = real and mission.actuators.model == "rotors"
    slow = 1.0 + values.get("lag", 0.0) if real else None
    off = {**values, "lag": 0.0, "delay": values.get("delay", 0.0) if real else 0.0}
    for wait in DELAYS:
        calm, at = calm_mission(mission, slow=slow, wait=wait)
        calm = check(uncertain_tables(tables_of(calm), off), mission.mission.name, quiet=True)
        inputs, outputs = ["thrust_offsets", "disturbance_moment"], ["rotor_thrusts", "rates"]
        model = linearize(calm, at, inputs=inputs, outputs=outputs, kink_tolerance=NO_KINK)
        if is_calm(model):
            break
    return model


class Trim(NamedTuple):
    """The part of H of `Family` that a parameter p adds because it changes the hover: U p (I − V p)⁻¹ W."""

    U: Complex
    W: Complex
    V: Complex


class Family(NamedTuple):
    """The response of a vehicle with ideal rotors.

    Attributes:
        w: frequencies (F) [rad/s].
        H: (F, 7, 4 + n + 3) from the wrench that rotors add to the commanded one, what each adds itself [N] and a
            moment [N m], to the commanded wrench and to J ω̇ [N m].
        trims: of "mass" and "thrust".
        spread: (n, 4), thrusts of all rotors from a wrench.
        effect: (4, n), the wrench of the thrusts of all rotors.
        lags: of the rotors (n) [s].
        delay: of them all [s].
    """

    w: Array
    H: Complex
    trims: dict[str, Trim]
    spread: Array
    effect: Array
    lags: Array
    delay: float

    def share(self, lag: float) -> Array:
        """(4, 4): the wrench of the rotors with a lag over the commanded one."""
        return np.asarray(self.effect[:, self.lags == lag] @ self.spread[self.lags == lag], float)


class Hovers(NamedTuple):
    """Models of a mission's hover with ideal rotors.

    Attributes:
        hover: the vehicle and its rotors.
        step: of the mission [s].
        model: as it is.
        off: of "mass" and "thrust", two deviations each with their models.
    """

    hover: HoverFacts
    step: float
    model: LinearModel
    off: dict[str, tuple[tuple[float, LinearModel], ...]]

    @property
    def w(self) -> Array:
        """Frequencies of its loop [rad/s]."""
        share = 1.0 if self.model.step == self.step else SENSOR_BAND
        return np.geomspace(LOW_END, share * math.pi / self.model.step, POINTS)


def hovers_of(mission: Mission, widths: Mapping[str, float]) -> Hovers:
    """The hovers of a mission whose parameters deviate by as much as `widths`.

    Raises:
        InputError: the controller is plain Python, or a flight is lost.
    """
    off = {"mass": (-1.0, 1.0), "thrust": (-1.0, 1.0)}
    at = {name: [end * widths[name] for end in ends] for name, ends in off.items() if name in widths}
    models = {name: tuple((p, calm_model(mission, {name: p}, real=False)) for p in ps) for name, ps in at.items()}
    return Hovers(mission.hover, mission.mission.step, calm_model(mission, {}, real=False), models)


def family_at(hovers: Hovers, w: Array) -> Family:
    """The responses at frequencies [rad/s].

    Raises:
        InputError: a hover is not calm.
    """
    hover, trims = hovers.hover, dict[str, Trim]()
    H = port_response(hover, hovers.step, hovers.model, w)
    for name, ((p, one), (q, other)) in hovers.off.items():
        gains = (1.0 + p, 1.0 + q) if name == "thrust" else (1.0, 1.0)
        models = zip((one, other), gains, strict=True)
        off = [unit_gain(port_response(hover, hovers.step, m, w), g) - H for m, g in models]
        trims[name] = rational(off[0], off[1], p, q)
    (delay, lag), rotors = rotor_delay_and_lag(hover), rotors_of(hover)
    return Family(w, H, trims, rotors.allocation, rotors.effect, lag * rotors.shares, delay)


def unit_gain(H: Complex, gain: float) -> Complex:
    """H of a vehicle whose rotors give `gain` times the command, closed with those that give it, in the same hover."""
    added = np.zeros((len(H), H.shape[2], H.shape[2]), dtype=complex)
    added[:, :4] = (1.0 - 1.0 / gain) * H[:, :4]
    scaled = np.concatenate([H[:, :4] / gain, H[:, 4:]], axis=1)
    return np.asarray(scaled @ np.linalg.inv(np.eye(H.shape[2]) + added))


def port_response(hover: HoverFacts, step: float, model: LinearModel, w: Array) -> Complex:
    """H of `Family`, of a linear model of a hover with ideal rotors, in a mission with steps of T = `step` [s].

    Inputs of a model are held over its sample time h. A rotor's thrust is held over a step, the moment of an inertia is
    not; and a rate at the samples tells the mean acceleration between them.

    Raises:
        InputError: the hover is not calm.
    """
    if not is_calm(model):
        raise InputError("the hover does not settle even with rotors without delay and lag")
    vehicle, few = hover.vehicle, model.connected()
    n, J, T, h, s = vehicle.rotor_count, vehicle.real_inertia(hover.plant), step, model.step, 1j * w
    R = frequency_response(few, w / (2.0 * math.pi)) - np.eye(*few.D.shape) * (np.arange(len(few.D)) < n)[:, None]
    sampled = s * h / -np.expm1(-s * h)
    R[:, :, :n] *= (sampled * -np.expm1(-s * T) / (s * T))[:, None, None]
    R[:, :, n:] *= sampled[:, None, None]
    turning = (s * np.sinc(w * h / (2.0 * math.pi)) ** 2)[:, None, None] * (J @ R[:, n:])
    out = np.concatenate([vehicle.effect @ R[:, :n], turning], axis=1)
    return np.concatenate([out[:, :, :n] @ vehicle.allocation(hover.allocation.weights), out], axis=2)


def rational(off_low: Complex, off_high: Complex, low: float, high: float) -> Trim:
    """U p (I − V p)⁻¹ W, equal to matrices (F, a, b) at p = low and p = high, of the least rank."""
    columns, sizes, _ = np.linalg.svd(np.concatenate([off_low, off_high], axis=2))
    _, _, rows = np.linalg.svd(np.concatenate([off_low, off_high], axis=1))
    ranks = (sizes > RANK_TOLERANCE * sizes.max()).sum(axis=1)
    R = int(ranks.max())
    U, W, V = columns[:, :, :R].astype(complex), rows[:, :R].astype(complex), np.zeros((len(ranks), R, R), complex)
    for k, r in enumerate(ranks):
        u, v = U[k, :, :r], W[k, :r]
        at_low, at_high = (np.linalg.inv(u.conj().T @ X[k] @ v.conj().T) for X in (off_low, off_high))
        core = (at_high - at_low) / (1.0 / high - 1.0 / low)  # of the inverse core / p − rest
        U[k, :, :r], V[k, :r, :r] = u @ np.linalg.inv(core), (core / high - at_high) @ np.linalg.inv(core)
        U[k, :, r:], W[k, r:] = 0.0, 0.0
    return Trim(U, W, V)
