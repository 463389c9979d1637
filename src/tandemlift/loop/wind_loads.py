"""Moving air around the vehicle: the wind, and the loads that it puts on the parts."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice
from tandemlift.algebra.vector import Nothing
from tandemlift.laws.mechanics.air_drag import AirDrag, air_loads
from tandemlift.laws.mechanics.loads import PartsLayout
from tandemlift.laws.mechanics.wind import wind_step


class WindModel(NamedTuple):
    """The wind, and the parts' drag."""

    wind: Any
    drag: AirDrag


class WindOutput(NamedTuple):
    """The air over a step: its velocity [m/s, world axes], its loads on the parts, and the wind's memory after it."""

    velocity: Any
    loads: Any
    memory: Any


@choice
def wind_loads(kind: Any, memory: Any, frame: PartsLayout, state: Any, gust: Any, noise: Any) -> Any:
    """The air over a step that starts in `state`; `gust`: velocity of all gusts together [m/s, world axes]."""


@wind_loads.register(Nothing)
def _still(kind, memory, frame, state, gust, noise):
    return WindOutput(kind, kind, memory)


@wind_loads.register(WindModel)
def _moving(kind, memory, frame, state, gust, noise):
    velocity, after = wind_step(kind.wind, memory, gust, noise)
    return WindOutput(velocity, air_loads(kind.drag, frame, state, velocity), after)
