"""Parameters of the real vehicle whose limits a certificate predicts, each with the keys that set it in a flight."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from tandemlift.analysis.linearization.loop_margins import AXES, rotor_delay_and_lag, rotors_of
from tandemlift.core.errors import unknown
from tandemlift.missions import Mission, changed_tables, check, tables_of

ARM = "arm stiffness"
LIFTED_SHARE = 1.0 - 1e-9  # of the mass that the rotors lift: rounding refuses no mission


class UncertainParameter(NamedTuple):
    """A number of the real vehicle or person that the pilot does not know.

    Attributes:
        name: of the parameter.
        unit: of its values.
        nominal: its value in a mission.
        keys: the changes of a mission, by dotted key, that give it a value.
    """

    name: str
    unit: str
    nominal: Callable[[Mission], float]
    keys: Callable[[Mission, float], dict[str, Any]]


def _lag_keys(mission: Mission, lag: float) -> dict[str, Any]:
    """The lags of rotors with a mean [s]: each in proportion to its own."""
    own = rotors_of(mission.hover).shares[::4].tolist()
    return {f"vehicle.quadrotors.{i}.{key}": lag * x for i, x in enumerate(own) for key in ("lag_up", "lag_down")}


def _mass_keys(mission: Mission, scale: float) -> dict[str, Any]:
    """A mass; beyond what the rotors lift, which no mission may have, the missing weight is a constant force down."""
    hover, (x, y, z) = mission.hover, mission.disturbance.force
    most = hover.lift / hover.vehicle.weight
    if mission.actuators.model != "rotors" or scale <= most:
        return {"plant.mass_scale": scale}
    held = LIFTED_SHARE * most
    return {"plant.mass_scale": held, "disturbance.force": [x, y, z - (scale - held) * hover.vehicle.weight]}


def _inertia(i: int, axis: str) -> UncertainParameter:
    return UncertainParameter(
        f"{axis} inertia", "1", lambda m: m.plant.inertia_scale[i], lambda m, x: {f"plant.inertia_scale.{i}": x}
    )


PARAMETERS = {
    p.name: p
    for p in (
        UncertainParameter(
            "delay", "s", lambda m: rotor_delay_and_lag(m.hover)[0], lambda m, x: {"actuators.delay": x}
        ),
        UncertainParameter(
            "lag",
            "s",
            lambda m: rotor_delay_and_lag(m.hover)[1],
            _lag_keys,
        ),
        UncertainParameter("mass", "1", lambda m: m.plant.mass_scale, _mass_keys),
        *(_inertia(i, axis) for i, axis in enumerate(AXES[1:])),
        UncertainParameter(ARM, "N/m", lambda m: m.person.stiffness, lambda m, x: {"person.stiffness": x}),
    )
}
"""Mass and inertia are factors of the pilot's values."""


def parameter(name: str) -> UncertainParameter:
    """A parameter by its name.

    Raises:
        InputError: there is none of this name.
    """
    if name not in PARAMETERS:
        raise unknown("parameter", name, PARAMETERS)
    return PARAMETERS[name]


def with_keys(mission: Mission, changes: dict[str, Any]) -> Mission:
    """A mission with changes by dotted key.

    Raises:
        InputError: the changed mission is invalid.
    """
    tables = tables_of(mission)
    for key, value in changes.items():
        tables = changed_tables(tables, key, value, "certificate")
    return check(tables, mission.mission.name, quiet=True)
