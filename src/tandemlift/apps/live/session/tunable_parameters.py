"""The parameters that may be changed in flight, and their bounds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from tandemlift.apps.live.wire.scene import SceneParameter
from tandemlift.apps.live.wire.server_messages import MAX_FORCE, STIFFNESS, THRESHOLD
from tandemlift.missions import Mission, tables_of
from tandemlift.missions.changes import MISSING, place_of, value_at
from tandemlift.parts.controllers import CONTROLLERS

EVERY = "vehicle.quadrotors.each."  # begins the key of a parameter that all quadrotors share


class TunableParameter(NamedTuple):
    """A number or a list of numbers: its key, its label and group on the page, its unit and its bounds."""

    key: str
    label: str
    group: str
    unit: str
    low: float
    high: float


TUNABLE = (
    TunableParameter("admittance.mass", "virtual mass", "admittance", "kg", 0.3, 20.0),
    TunableParameter("admittance.damping", "damping", "admittance", "N s/m", 0.2, 30.0),
    TunableParameter("admittance.stiffness", "stiffness", "admittance", "N/m", 0.0, 20.0),
    TunableParameter(THRESHOLD, "threshold", "admittance", "N", 0.05, 5.0),
    TunableParameter("compliance.max_speed", "maximum speed", "admittance", "m/s", 0.1, 3.0),
    TunableParameter(STIFFNESS, "stiffness", "hand spring", "N/m", 1.0, 40.0),
    TunableParameter("person.damping", "damping", "hand spring", "N s/m", 0.0, 20.0),
    TunableParameter(MAX_FORCE, "maximum force", "hand spring", "N", 0.5, 20.0),
    TunableParameter("controller.gains.xi", "ξ", "controller", "1/s", 0.05, 20.0),
    TunableParameter("controller.gains.lambda_1", "λ₁", "controller", "1/s", 0.05, 40.0),
    TunableParameter("controller.gains.lambda_2", "λ₂", "controller", "m/s², rad/s²", 0.05, 40.0),
    TunableParameter("wind.velocity", "wind", "world", "m/s", -8.0, 8.0),
    TunableParameter("wind.turbulence", "turbulence", "world", "m/s", 1e-3, 8.0),
    TunableParameter(f"{EVERY}lag_up", "rotor lag, up", "world", "s", 0.002, 0.1),
    TunableParameter(f"{EVERY}lag_down", "rotor lag, down", "world", "s", 0.002, 0.1),
    TunableParameter("sensors.joints.force_noise", "joint force noise", "world", "N", 0.0, 1.0),
    TunableParameter("sensors.motion.position_noise", "position noise", "world", "m", 0.0, 0.05),
)
BY_KEY = {p.key: p for p in TUNABLE}
CONTROLLER, GATE = "controller.name", "admittance.gate"
CHOICES = (CONTROLLER, GATE)


def keys_of(mission: Mission, key: str) -> list[str]:
    """The keys of a mission that a parameter's key stands for."""
    if not key.startswith(EVERY):
        return [key]
    return [f"vehicle.quadrotors.{i}.{key.removeprefix(EVERY)}" for i in range(len(mission.vehicle.quadrotors))]


def value_of(tables: dict[str, Any], key: str) -> Any:
    """The value of a parameter in a mission's tables, or `MISSING`."""
    value = value_at(tables, place_of(key.replace(EVERY, "vehicle.quadrotors.0.")))
    return "hard" if key == GATE and value is MISSING else value


def bounds_of(parameter: TunableParameter, first: Mission) -> tuple[float, float]:
    """The bounds of a parameter, widened to hold the mission's own value."""
    value = value_of(tables_of(first), parameter.key)
    own = [] if value is MISSING else value if isinstance(value, list) else [value]
    return min([parameter.low, *own]), max([parameter.high, *own])


def parameters_of(mission: Mission, first: Mission) -> Iterator[SceneParameter]:
    """The parameters of a mission as a scene has them; `first`: the mission that they can be restored to."""
    tables, initial = tables_of(mission), tables_of(first)
    for p in TUNABLE:
        value = value_of(tables, p.key)
        if value is not MISSING and _is_tunable(mission, p.key):
            low, high = bounds_of(p, first)
            shown = SceneParameter(key=p.key, label=p.label, group=p.group, unit=p.unit, value=value, min=low, max=high)
            restored = value_of(initial, p.key)
            if restored is not MISSING:
                shown["initial"] = restored
            yield shown
    yield from _choices(mission, first)


def _choices(mission: Mission, first: Mission) -> Iterator[SceneParameter]:
    yield SceneParameter(
        key=CONTROLLER,
        label="controller",
        group="controller",
        value=mission.controller.name,
        initial=first.controller.name,
        choices=sorted(CONTROLLERS),
    )
    if mission.pilot.guidance == "scheduled":  # other pilots have a dead-band instead
        yield SceneParameter(
            key=GATE,
            label="gate",
            group="admittance",
            value=mission.admittance.gate or "hard",
            initial=first.admittance.gate or "hard",
            choices=["hard", "soft"],
        )


def _is_tunable(mission: Mission, key: str) -> bool:
    """Whether a mission has the part of a key."""
    absent = {
        "wind": mission.wind.model == "none",
        "sensors": mission.sensors.model == "none",
        "vehicle": mission.actuators.model == "ideal",
        "compliance": mission.pilot.guidance != "interactive",
    }
    return not absent.get(key.partition(".")[0], False)
