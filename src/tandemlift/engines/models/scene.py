"""The view of a mission for an engine: the body, its start, and its surroundings, without the pilot."""

from __future__ import annotations

from typing import Protocol

from tandemlift.parts.contact.corridor import WallTable
from tandemlift.parts.contact.ground_table import GroundTable
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable, PlantTable, VehicleTable


class Timing(Protocol):
    """Name of the flight, and its time step [s]."""

    @property
    def name(self) -> str:
        """Name of the flight."""

    @property
    def step(self) -> float:
        """Time step [s]."""


class Scene(Protocol):
    """The tables of a mission that an engine reads; every `Mission` is one."""

    @property
    def mission(self) -> Timing:
        """Name and step."""

    @property
    def vehicle(self) -> VehicleTable:
        """The body's parts."""

    @property
    def initial(self) -> InitialTable:
        """State at the start."""

    @property
    def plant(self) -> PlantTable:
        """The differences of the real body."""

    @property
    def disturbance(self) -> DisturbanceTable:
        """Constant force and moment."""

    @property
    def ground(self) -> GroundTable:
        """The floor."""

    @property
    def all_walls(self) -> tuple[WallTable, ...]:
        """Every wall."""
