"""What a page may change of a flight while it goes on, within which bounds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from tandemlift.controllers import CONTROLLERS
from tandemlift.missions import tables_of
from tandemlift.missions.values import MISSING, value_at
from tandemlift.settings import Mission

EVERY = "vehicle.quadrotors.each."  # begins the key of a control that all quadrotors have together


class Control(NamedTuple):
    """A number or a list of numbers: its key, what a page calls it, where it puts it, its unit and its bounds."""

    key: str
    label: str
    group: str
    unit: str
    low: float
    high: float


CONTROLS = (
    Control("admittance.mass", "virtual mass", "feel", "kg", 0.3, 20.0),
    Control("admittance.damping", "damping", "feel", "N s/m", 0.2, 30.0),
    Control("admittance.stiffness", "stiffness", "feel", "N/m", 0.0, 20.0),
    Control("admittance.threshold", "threshold", "feel", "N", 0.05, 5.0),
    Control("compliance.max_speed", "speed, at most", "feel", "m/s", 0.1, 3.0),
    Control("person.stiffness", "stiffness", "spring", "N/m", 1.0, 40.0),
    Control("person.damping", "damping", "spring", "N s/m", 0.0, 20.0),
    Control("person.max_force", "force, at most", "spring", "N", 0.5, 20.0),
    Control("controller.gains.xi", "ξ", "pilot", "1/s", 0.05, 20.0),
    Control("controller.gains.lambda_1", "λ₁", "pilot", "1/s", 0.05, 40.0),
    Control("controller.gains.lambda_2", "λ₂", "pilot", "m/s², rad/s²", 0.05, 40.0),
    Control("wind.velocity", "wind", "world", "m/s", -8.0, 8.0),
    Control("wind.turbulence", "turbulence", "world", "m/s", 1e-3, 8.0),
    Control(f"{EVERY}lag_up", "rotor lag, up", "world", "s", 0.002, 0.1),
    Control(f"{EVERY}lag_down", "rotor lag, down", "world", "s", 0.002, 0.1),
    Control("sensors.joints.force_noise", "noise of the joints", "world", "N", 0.0, 1.0),
    Control("sensors.motion.position_noise", "noise of the position", "world", "m", 0.0, 0.05),
)
BY_KEY = {c.key: c for c in CONTROLS}
CONTROLLER, GATE = "controller.name", "admittance.gate"
CHOICES = (CONTROLLER, GATE)


def keys_of(mission: Mission, key: str) -> list[str]:
    """The keys of a mission that a control's key stands for."""
    if not key.startswith(EVERY):
        return [key]
    return [f"vehicle.quadrotors.{i}.{key.removeprefix(EVERY)}" for i in range(len(mission.vehicle.quadrotors))]


def value_of(tables: dict[str, Any], key: str) -> Any:
    """The value of a control in a mission's tables, or `MISSING`."""
    place = key.replace(EVERY, "vehicle.quadrotors.0.").split(".")
    return value_at(tables, tuple(int(part) if part.isdigit() else part for part in place))


def bounds_of(control: Control, first: Mission) -> tuple[float, float]:
    """The bounds of a control, which hold what the mission says."""
    value = value_of(tables_of(first), control.key)
    own = [] if value is MISSING else value if isinstance(value, list) else [value]
    return min([control.low, *own]), max([control.high, *own])


def _may_be_changed(mission: Mission, key: str) -> bool:
    absent = {
        "wind": mission.wind.model == "none",
        "sensors": mission.sensors.model == "none",
        "vehicle": mission.actuators.model == "ideal",
        "compliance": mission.pilot.guidance != "hand",
    }
    return not absent.get(key.partition(".")[0], False)


def controls_of(mission: Mission, first: Mission) -> Iterator[dict[str, Any]]:
    """The controls of a mission, as a scene has them; `first`: the one that they can be brought back to."""
    tables, initial = tables_of(mission), tables_of(first)
    for c in CONTROLS:
        value = value_of(tables, c.key)
        if value is not MISSING and _may_be_changed(mission, c.key):
            back = value_of(initial, c.key)
            held = {} if back is MISSING else {"initial": back}
            about = {"key": c.key, "label": c.label, "group": c.group, "unit": c.unit, "value": value}
            low, high = bounds_of(c, first)
            yield {**about, **held, "min": low, "max": high}
    name = {"key": CONTROLLER, "label": "controller", "group": "pilot", "value": mission.controller.name}
    yield {**name, "initial": first.controller.name, "choices": sorted(CONTROLLERS)}
    if mission.pilot.guidance == "clock":  # a hand is felt through a dead-band instead
        gate = {"key": GATE, "label": "gate", "group": "feel", "value": mission.admittance.gate}
        yield {**gate, "initial": first.admittance.gate, "choices": ["hard", "soft"]}
