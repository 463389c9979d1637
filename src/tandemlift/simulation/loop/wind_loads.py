"""The wind around the vehicle, and its loads on the parts."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra.law import choice
from tandemlift.core.algebra.vector import Nothing
from tandemlift.parts.mechanics.air_drag import AirDrag, air_loads
from tandemlift.parts.mechanics.loads import PartsLayout
from tandemlift.parts.mechanics.wind import wind_step


class WindModel(NamedTuple):
    """The wind, and the drag of the parts."""

    wind: Any
    drag: AirDrag


class WindOutput(NamedTuple):
    """The wind over a step: its velocity [m/s, world axes], its loads on the parts, and its memory after the step."""

    velocity: Any
    loads: Any
    memory: Any


@choice
def wind_loads(kind: Any, memory: Any, frame: PartsLayout, state: Any, gust: Any, noise: Any) -> Any:
    """`WindOutput` over a step that starts in `state`; `gust`: velocity of all gusts together [m/s, world axes]."""


@wind_loads.register(Nothing)
def _no_wind(kind: Nothing, memory: Any, frame: PartsLayout, state: Any, gust: Any, noise: Any) -> WindOutput:
    return WindOutput(kind, kind, memory)


@wind_loads.register(WindModel)
def _wind(kind: WindModel, memory: Any, frame: PartsLayout, state: Any, gust: Any, noise: Any) -> WindOutput:
    velocity, after = wind_step(kind.wind, memory, gust, noise)
    return WindOutput(velocity, air_loads(kind.drag, frame, state, velocity), after)
