"""The frames of a flight in progress, and the frame that is shown before it begins."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.apps.live.session.frames import (
    Components,
    channel_columns,
    field_values,
    layout_for,
    pack_frames,
    phase_times,
)
from tandemlift.apps.live.session.scene_builder import scene_of
from tandemlift.core.types import Array
from tandemlift.missions import tables_of
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.simulation.plan import FlightPlan


class FrameBuilder:
    """Builds the frames of a mission's flight.

    Args:
        plan: of the mission in its engine.

    Attributes:
        scene: the description that a page needs to interpret frames.
    """

    def __init__(self, plan: FlightPlan) -> None:
        mission = plan.mission
        self.scene = scene_of(mission, plan.engine)
        self._layout = layout_for(Vehicle.from_settings(mission.vehicle).rotor_count)
        self._phases, self._columns = phase_times(tables_of(mission)["phases"]), channel_columns(plan.sample)
        self._start = plan.model.flight_state.state

    def values(self, sample: Array, at: float) -> dict[str, Components]:
        """The values of the fields in a sample, at a time [s], component by component."""
        channels = {name: tuple(map(float, sample[columns])) for name, columns in self._columns.items()}
        return field_values(channels, at, self._phases)

    def frame(self, values: Mapping[str, ArrayLike]) -> bytes:
        """The frame of some values."""
        return pack_frames(self._layout, values).tobytes()

    def first(self) -> bytes:
        """The frame of a flight that has not begun."""
        s = self._start
        at: dict[str, Any] = {
            "position": s.position,
            "attitude": s.attitude,
            "velocity": s.velocity,
            "reference": s.position,
        }
        return self.frame({name: np.array(value) for name, value in at.items()})
