"""The interface of a figure's file besides its drawing: a caption, and the flights that have the figure."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, Protocol

from matplotlib.figure import Figure

from tandemlift.flight.record import Flight


class Caption(NamedTuple):
    """Title and text printed with a figure, and `alt`, a description for those who cannot see it."""

    title: str
    text: str
    alt: str


class FlightFigure(Protocol):
    """A file that draws a figure of a flight; its name is the figure's."""

    @property
    def CAPTION(self) -> Caption:
        """The caption."""

    @property
    def IN_FLIGHTS(self) -> Callable[[Flight], bool]:
        """Whether a flight has this figure."""

    @property
    def OVERLAY(self) -> Callable[[Mapping[str, Flight]], Figure] | None:
        """Draws several flights, by name, over each other; None where that would show nothing."""

    @property
    def draw(self) -> Callable[[Flight], Figure]:
        """Draws it."""


def all_flights(flight: Flight) -> bool:
    """True: a figure that every flight has."""
    return True


def with_any_of(*channels: str) -> Callable[[Flight], bool]:
    """For a figure of flights that have one of these channels."""
    return lambda flight: any(name in flight.channels for name in channels)


def with_walls(flight: Flight) -> bool:
    """Whether there are walls around a flight."""
    mission = flight.mission
    return bool(mission.get("walls") or mission.get("corridor", {}).get("centreline"))
