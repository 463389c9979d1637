"""A flight by hand as far as it has come, and the files that it is saved in."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tandemlift.common.errors import FlightWarning
from tandemlift.common.files import atomic_write
from tandemlift.common.types import Array
from tandemlift.flight.record import Flight
from tandemlift.missions import changed, format_toml, load_mission, tables_of
from tandemlift.missions.recording import WIDTH, Recording, write_recording
from tandemlift.settings import Mission
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import RawResult, flight_of

MISSION, HAND, FLIGHT = "recorded.toml", "hand.npz", "flight.npz"


@dataclass(frozen=True)
class FlightSnapshot:
    """A flight as far as it had come, and what made it: enough to fly it again to the last bit.

    Attributes:
        start: the mission that it began as.
        engine: name of the body's engine.
        flown: its raw outcome.
        hand: positions of the hand, each with the step from which on it holds.
        changes: what was changed in flight, as a mission's `[[changes]]`.
    """

    start: Mission
    engine: str
    flown: RawResult
    hand: list[tuple[int, Array]]
    changes: list[dict[str, Any]]

    def save(self, folder: Path) -> Flight:
        """Write mission, hand and flight into a folder; the flight that the mission flies again."""
        self.save_mission(folder)
        return save_flight(folder, self.flown, self.engine)

    def save_mission(self, folder: Path) -> None:
        """Write mission and hand into a folder."""
        steps = np.array([k for k, _ in self.hand], dtype=np.int64)
        hands = np.reshape([hand for _, hand in self.hand], (len(steps), WIDTH))
        write_recording(folder / HAND, Recording(steps, hands, self.engine))
        with atomic_write(folder / MISSION) as partial:
            comment = f"# Flies again, in the engine {self.engine}: tandemlift run {MISSION}\n\n"
            partial.write_text(comment + self._toml(folder.name), "utf-8")

    def alone(self) -> Flight:
        """The flight by itself, with a mission of the same length that has neither hand nor changes."""
        duration = self.flown.step * self.start.mission.step
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FlightWarning)
            p = FlightPlan(changed(self.start, "mission.duration", duration))
        return flight_of(p, self.flown, self.engine)

    def _toml(self, name: str) -> str:
        tables, step = tables_of(self.start), self.start.mission.step
        tables["mission"] |= {"name": name, "duration": self.flown.step * step}
        tables["person"]["recording"] = HAND
        tables["changes"] = [c for c in self.changes if round(c["time"] / step) <= self.flown.step]
        return format_toml(tables)


def save_flight(folder: Path, flown: RawResult, engine: str) -> Flight:
    """Write the flight that was flown into the folder of its recorded mission."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)
        p = FlightPlan(load_mission(folder / MISSION))
    flight = flight_of(p, flown, engine)
    flight.save(folder / FLIGHT)
    return flight
