"""How the moments of a flight become frames: what a scene says of them, and the frame of one that has not begun."""

from __future__ import annotations

from typing import Any

import numpy as np

from tandemlift.common.types import Array
from tandemlift.live.frames import fields_of, frames_of
from tandemlift.live.recorded import Ready
from tandemlift.live.scene import scene_of
from tandemlift.live.values import places_of, values_of
from tandemlift.missions import tables_of
from tandemlift.settings import Mission
from tandemlift.vehicle import Vehicle


class Framing:
    """The frames of a mission's flight.

    Args:
        mission: what is flown.
        engine: name of the body's engine.
        ready: the mission put together.

    Attributes:
        scene: what a viewer must know before frames mean anything.
    """

    def __init__(self, mission: Mission, engine: str, ready: Ready) -> None:
        self.scene = scene_of(mission, engine)
        self._fields = fields_of(Vehicle.from_settings(mission.vehicle).rotor_count)
        self._phases, self._places = tables_of(mission)["phases"], places_of(ready.p.sample)
        self._start = ready.p.flying.moving.state

    def values(self, sample: Array, at: float) -> dict[str, Any]:
        """The values of the fields that a sample tells of, at a time [s]."""
        channels = {name: sample[places] for name, places in self._places.items()}
        return values_of(channels, np.array([at]), self._phases)

    def frame(self, values: dict[str, Any]) -> bytes:
        """The frame of some values."""
        return frames_of(self._fields, values).tobytes()

    def first(self) -> bytes:
        """The frame of a flight that has not begun."""
        s = self._start
        at = {"position": s.position, "attitude": s.attitude, "velocity": s.velocity, "reference": s.position}
        return self.frame({name: np.array(value) for name, value in at.items()})
