"""A mission whose vehicle is uncertain, as M and Δ at each frequency: det(I − M Δ) = 0 where it oscillates.

Each parameter p (relative, or in s) lies within [low, high] and enters as p = middle + half δ, |δ| ≤ 1, δ real:

- a rotor's own gain adds the thrust p T of that rotor;
- an inertia adds the moment −p J ω̇ about its axis;
- the rotors' lag is τ (1 + p);
- their delay is longer by p: e^(−jωp) = (1 − jt)/(1 + jt), with t = tan(ωp/2) real;
- a mass moves the hover and what the pilot makes of it. The loop is linearized at the mass and at two others, Δ₋ and Δ₊
  apart from it: U p (I − V p)⁻¹ W of the least rank passes through all three, and is exact for what is so rational;
- a thrust constant that is off by p is the mass and all inertias off by 1/(1 + p): force and moment over inertia.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from tandemlift.analysis.certification.structured_singular_value import Complex
from tandemlift.analysis.linearization.linear_model import LinearModel, frequency_response
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import (
    HIGHEST,
    LOWEST,
    NO_KINK,
    POINTS,
    WAITS,
    calm_mission,
    is_calm,
)
from tandemlift.core.errors import InputError, unknown, without_flight_warnings
from tandemlift.core.types import Array
from tandemlift.missions import Mission, check, tables_of
from tandemlift.parts.mechanics.vehicle import Vehicle

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
MOST = 10  # parameters beside the rotors
LARGEST = 0.9  # relative, of a parameter that the factor of a box leads to
RANK = 1e-4  # of the largest singular value
SECONDS, GROWTH = 60.0, 2.0  # s, that a certificate with the most parameters takes, and its growth with each more

Values = Mapping[str, float]
"""Deviations of parameters by name; rotors are "rotor.1", "rotor.2", …; the others are 0."""


class Range(NamedTuple):
    """The interval of a parameter's deviation."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        return 0.5 * (self.low + self.high)

    @property
    def half(self) -> float:
        return 0.5 * (self.high - self.low)


Box = Mapping[str, Range]


def parameters_of(mission: Mission, widths: Mapping[str, float]) -> dict[str, float]:
    """The half width of each parameter that has an effect, "rotors" as one for each rotor.

    Raises:
        InputError: a parameter is unknown, a width is not allowed, or there are more than ten beside the rotors.
    """
    rotors = [f"rotor.{i + 1}" for i in range(4 * len(mission.vehicle.quadrotors))]
    for name, width in widths.items():
        if name not in {*UNITS, *rotors, "rotors"}:
            raise unknown("uncertain parameter", name, [*UNITS, "rotors", *rotors])
        if not 0.0 < width < (math.inf if name == "delay" else LARGEST):
            most = "" if name == "delay" else f" and below {LARGEST:g}"
            raise InputError(f"{name} = {width:g}: its half width must be above 0{most}")
    named = [name for name in widths if name != "rotors"]
    if len(named) > MOST:
        minutes = SECONDS * GROWTH ** (len(named) - MOST) / 60.0
        raise InputError(
            f"{len(named)} uncertain parameters: at most {MOST} beside \"rotors\"; with each more the time doubles, "
            f"and these would take some {minutes:.2g} min: leave out {', '.join(named[MOST:])}"
        )
    ideal = mission.actuators.model != "rotors"
    found = {n: widths[n] for n in UNITS if n in widths and not (ideal and n in ("lag", "delay"))}
    if mission.hover.lag == 0.0:
        found.pop("lag", None)
    own = {name: widths.get(name, widths.get("rotors", 0.0)) for name in rotors}
    return found | {name: width for name, width in own.items() if width > 0.0}


def box_at(widths: Mapping[str, float], factor: float) -> dict[str, Range]:
    """The box that is larger by a factor."""
    return {name: Range(0.0 if name == "delay" else -factor * w, factor * w) for name, w in widths.items()}


def largest_factor(widths: Mapping[str, float]) -> float:
    """The factor at which a relative parameter reaches the largest deviation."""
    return min(LARGEST / width for name, width in widths.items() if name != "delay")


def uncertain_tables(tables: dict[str, Any], values: Values) -> dict[str, Any]:
    """The tables of a mission whose vehicle deviates from them, its pilot does not.

    A rotor cannot give more than it should by a key: the largest gain of a rotor and the thrust constant are flown as a
    lighter body of less inertia, the rotors' differences as faults that the pilot does not know.
    """
    plant, fleet = tables["plant"], tables["vehicle"]["quadrotors"]
    rotors = [1.0 + values.get(f"rotor.{i + 1}", 0.0) for i in range(4 * len(fleet))]
    gain = (1.0 + values.get("thrust", 0.0)) * max(rotors)
    scales = [
        scale * (1.0 + values.get(name, 0.0)) / gain for name, scale in zip(INERTIAS, plant["inertia_scale"], strict=True)
    ]
    mass = plant["mass_scale"] * (1.0 + values.get("mass", 0.0)) / gain
    slow = 1.0 + values.get("lag", 0.0)
    weak = [
        {"quadrotor": i // 4 + 1, "rotor": i % 4 + 1, "time": 0.0, "efficiency": own / max(rotors)}
        for i, own in enumerate(rotors)
        if own < max(rotors)
    ]
    return {
        **tables,
        "plant": {**plant, "mass_scale": mass, "inertia_scale": scales},
        "vehicle": {
            **tables["vehicle"],
            "quadrotors": [{**q, "lag_up": slow * q["lag_up"], "lag_down": slow * q["lag_down"]} for q in fleet],
        },
        "actuators": {**tables["actuators"], "delay": tables["actuators"]["delay"] + values.get("delay", 0.0)},
        "faults": weak,
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
    lag = mission.hover.lag * (1.0 + values.get("lag", 0.0)) if real else None
    off = {**values, "lag": 0.0, "delay": values.get("delay", 0.0) if real else 0.0}
    for wait in WAITS:
        calm, at = calm_mission(mission, lag=lag, wait=wait)
        with without_flight_warnings():
            calm = check(uncertain_tables(tables_of(calm), off), mission.mission.name)
        ports: Any = {"inputs": ["thrust_offsets", "disturbance_moment"], "outputs": ["rotor_thrusts", "rates"]}
        model = linearize(calm, at, **ports, kink_tolerance=NO_KINK)
        if is_calm(model):
            break
    return model


class Family(NamedTuple):
    """The response of a vehicle with ideal rotors at frequencies w (F), in any mass.

    Attributes:
        w: [rad/s].
        H: (F, 7, 4 + n + 3) from the wrench that rotors add [N, N m], their own thrusts [N], a moment [N m], to the
            commanded wrench and to J ω̇ [N m], without deviation of the mass.
        U: (F, 7, R); z = p y acts through it.
        W: (F, R, 4 + n + 3), V (F, R, R): y = W inputs + V z.
        spread: thrusts of the rotors (n, 4) from a wrench.
        lag, delay: of the rotors [s].
    """

    w: Array
    H: Complex
    U: Complex
    W: Complex
    V: Complex
    spread: Array
    lag: float
    delay: float


def family_of(mission: Mission, widths: Mapping[str, float]) -> Family:
    """The responses of a mission, linearized at its mass and, where that is uncertain, at two more.

    Raises:
        InputError: the controller is plain Python, or a flight is lost.
    """
    model = calm_model(mission, {}, real=False)
    w = np.geomspace(LOWEST, min(HIGHEST, 0.9 * math.pi / model.step), POINTS)
    H, mass, thrust = port_response(mission, model, w), widths.get("mass", 0.0), widths.get("thrust", 0.0)
    low, high = (1.0 - mass) / (1.0 + thrust) - 1.0, (1.0 + mass) / (1.0 - thrust) - 1.0
    U, W, V = H[:, :, :0], H[:, :0], H[:, :0, :0]
    if high > low:
        models = [calm_model(mission, {"mass": p}, real=False) for p in (low, high)]
        U, W, V = rational(*[port_response(mission, one, w) - H for one in models], low, high)
    real = mission.actuators.model == "rotors"
    spread = Vehicle.from_settings(mission.vehicle).allocation(mission.allocation.weights)
    lag, delay = (mission.hover.lag, mission.actuators.delay) if real else (0.0, 0.0)
    return Family(w, H, U, W, V, spread, lag, delay)


def port_response(mission: Mission, model: LinearModel, w: Array) -> Complex:
    """H of `Family`, of a linear model of a mission's hover.

    Inputs of a model are held over its sample time h. A rotor's thrust is held over a step, the moment of an inertia
    is not; and the acceleration between two samples of a rate is not that at a time.
    """
    vehicle, few = Vehicle.from_settings(mission.vehicle), model.connected()
    n, J, T, h, s = vehicle.rotor_count, vehicle.real_inertia(mission.plant), mission.mission.step, model.step, 1j * w
    R = frequency_response(few, w / (2.0 * math.pi)) - np.eye(*few.D.shape) * (np.arange(len(few.D)) < n)[:, None]
    by_sample = s * h / -np.expm1(-s * h)
    R[:, :, :n] *= (by_sample * -np.expm1(-s * T) / (s * T))[:, None, None]
    R[:, :, n:] *= by_sample[:, None, None]
    turning = (s * np.sinc(w * h / (2.0 * math.pi)) ** 2)[:, None, None] * (J @ R[:, n:])
    out = np.concatenate([vehicle.effect @ R[:, :n], turning], axis=1)
    return np.concatenate([out[:, :, :n] @ vehicle.allocation(mission.allocation.weights), out], axis=2)


def rational(off_low: Complex, off_high: Complex, low: float, high: float) -> tuple[Complex, Complex, Complex]:
    """(U, W, V) of U p (I − V p)⁻¹ W, equal to matrices (F, a, b) at p = low and p = high, of the least rank."""
    columns, sizes, _ = np.linalg.svd(np.concatenate([off_low, off_high], axis=2))
    _, _, rows = np.linalg.svd(np.concatenate([off_low, off_high], axis=1))
    rank = (sizes > RANK * sizes[:, :1]).sum(axis=1)
    R = int(rank.max())
    U, W = columns[:, :, :R].astype(complex), rows[:, :R].astype(complex)
    V = np.zeros((len(U), R, R), dtype=complex)
    for k, r in enumerate(rank):
        u, v = U[k, :, :r], W[k, :r]
        at_low, at_high = (np.linalg.inv(u.conj().T @ X[k] @ v.conj().T) for X in (off_low, off_high))
        core = (at_high - at_low) / (1.0 / high - 1.0 / low)  # X⁻¹ = core / p − rest
        back = np.linalg.inv(core)
        U[k, :, :r], V[k, :r, :r] = u @ back, (core / high - at_high) @ back
        U[k, :, r:], W[k, r:] = 0.0, 0.0
    return U, W, V
