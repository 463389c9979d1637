"""The uncertain parameters of a mission's vehicle: their box, and the mission with deviations of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from tandemlift.analysis.linearization.linear_model import LinearModel
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import NO_KINK, WAITS, calm_mission, is_calm
from tandemlift.core.errors import InputError, unknown, without_flight_warnings
from tandemlift.missions import Mission, check, tables_of

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
LARGEST = 0.9  # relative, that a parameter deviates
LONGEST = 0.2  # s, of the delay
SECONDS, GROWTH = 90.0, 1.5  # s of a tier with the most parameters; its growth with each further one

Values = Mapping[str, float]
"""Deviations of parameters by name; rotors are "rotor.1", "rotor.2", …; the others are 0."""


class Span(NamedTuple):
    """The interval of a parameter's deviation: its middle and half its width."""

    middle: float
    half: float


def parameters_of(mission: Mission, box: Mapping[str, float]) -> dict[str, float]:
    """The half width of each parameter that has an effect, of "rotors" for each rotor.

    Raises:
        InputError: a parameter is unknown, a width is not allowed, or there are more than ten beside the rotors.
    """
    rotors = [f"rotor.{i + 1}" for i in range(4 * len(mission.vehicle.quadrotors))]
    for name, width in box.items():
        if name not in {*UNITS, *rotors, "rotors"}:
            raise unknown("uncertain parameter", name, [*UNITS, "rotors", *rotors])
        most = LONGEST if name == "delay" else LARGEST
        if not 0.0 < width < most:
            raise InputError(f"uncertain parameter {name} = {width:g}: its half width must be in (0, {most:g})")
    named = [name for name in box if name != "rotors"]
    if len(named) > MOST:
        minutes = SECONDS * GROWTH ** (len(named) - MOST) / 60.0
        raise InputError(
            f"{len(named)} uncertain parameters: must be at most {MOST} beside rotors, or the search for the worst "
            f"takes some {minutes:.2g} min; leave out {', '.join(named[MOST:])}"
        )
    without = set() if mission.hover.lag else {"lag"}
    if mission.actuators.model != "rotors":
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
    return min((LONGEST if name == "delay" else LARGEST) / width for name, width in widths.items())


def weakens(name: str) -> bool:
    """Whether a parameter is a gain of rotors, which can be flown below 1 alone."""
    return name == "thrust" or name.startswith("rotor.")


def uncertain_tables(tables: Mapping[str, Any], values: Values) -> dict[str, Any]:
    """The tables of a mission whose vehicle deviates from them, and its pilot does not.

    Vehicle and pilot share the key of the thrust constant, so that it has no effect. Weaker rotors are flown by faults
    that the pilot does not know.

    Args:
        tables: of the mission.
        values: deviations; no rotor is stronger.
    """
    fleet, plant = tables["vehicle"]["quadrotors"], tables["plant"]
    thrust, slow = 1.0 + values.get("thrust", 0.0), 1.0 + values.get("lag", 0.0)
    gains = [thrust * (1.0 + values.get(f"rotor.{i + 1}", 0.0)) for i in range(4 * len(fleet))]
    inertia = [x * (1.0 + values.get(name, 0.0)) for x, name in zip(plant["inertia_scale"], INERTIAS, strict=True)]
    mass = plant["mass_scale"] * (1.0 + values.get("mass", 0.0))
    return {
        **tables,
        "plant": {**plant, "mass_scale": mass, "inertia_scale": inertia},
        "vehicle": {
            **tables["vehicle"],
            "quadrotors": [{**q, "lag_up": slow * q["lag_up"], "lag_down": slow * q["lag_down"]} for q in fleet],
        },
        "actuators": {**tables["actuators"], "delay": tables["actuators"]["delay"] + values.get("delay", 0.0)},
        "faults": [
            {"quadrotor": i // 4 + 1, "rotor": i % 4 + 1, "time": 0.0, "efficiency": gain}
            for i, gain in enumerate(gains)
            if gain != 1.0
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
