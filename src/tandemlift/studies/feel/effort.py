"""The person's effort: how mission `zigzag` goes for a person with the admittance of another mission."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.errors import FlightWarning
from tandemlift.common.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, check, load_mission, merge, tables_of
from tandemlift.missions.values import Tables
from tandemlift.simulation.many import fly_each
from tandemlift.studies.validation.persons import succeeded

CORRIDOR = "zigzag"
LOGGED = 0.05  # s: motions of a person are slow against it


class Effort(NamedTuple):
    """What leading the vehicle took.

    Attributes:
        force: mean force of the person [N]; None if nobody pushed.
        work: of the person for each metre of the way [J/m]; below 0 where the vehicle drove the hand.
        time: for which the person pushed [s].
        jerk: root mean square of the beam's jerk while the person pushed [m/s³].
        clearance: the least to any wall [m]; below 0 it touched.
        arrived: whether it landed at the end, and touched nothing.
        outcome: of the flight.
    """

    force: float | None
    work: float | None
    time: float | None
    jerk: float | None
    clearance: float | None
    arrived: bool
    outcome: str

    @property
    def touched(self) -> bool:
        """Whether the vehicle touched a wall."""
        return self.clearance is not None and self.clearance < 0.0


def corridor_tables(m: Mission) -> Tables:
    """The tables of mission `zigzag` with the admittance of a mission, whose threshold the person knows."""
    admittance = {name: value for name, value in tables_of(m)["admittance"].items() if name != "feel"}
    known = max(m.admittance.threshold[:2])
    changes: Tables = {
        "admittance": admittance,
        "person": {"breakaway_force": known},
        "mission": {"log_interval": LOGGED},
    }
    return merge(tables_of(load_mission(CORRIDOR)), changes)


def quietly_checked(tables: Tables, source: str) -> Mission:
    """A checked mission without warnings: what may fly badly is flown, and judged by how it flew."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)
        return check(tables, source)


def effort_in_corridor(m: Mission) -> Effort:
    """The effort of the person of mission `zigzag` with the admittance of a mission."""
    return efforts([quietly_checked(corridor_tables(m), f"{CORRIDOR}, with the admittance of {m.mission.name}")])[0]


def efforts(missions: Sequence[Mission], progress: Progress | None = None) -> list[Effort]:
    """The efforts of missions with persons, in their order."""
    return [
        _effort(m, flight)
        for m, flight in zip(missions, fly_each(missions, keep="flights", progress=progress), strict=True)
    ]


def _effort(m: Mission, flight: Flight) -> Effort:
    found: dict[str, Any] = flight.metrics()
    return Effort(
        force=found.get("human_force_mean_n"),
        work=found.get("human_work_per_path_j_m"),
        time=found.get("human_time_s"),
        jerk=jerk_of(flight),
        clearance=found.get("clearance_min_m"),
        arrived=succeeded(m, found),
        outcome=flight.outcome,
    )


def jerk_of(flight: Flight) -> float | None:
    """Root mean square of the jerk [m/s³] of the centre of mass while somebody pushes; None if nobody does."""
    pushed = np.linalg.norm(flight["push_force"], axis=1) > 0.0
    if pushed.sum() < 4:
        return None
    jerk = np.gradient(np.gradient(flight["velocity"], flight.time, axis=0), flight.time, axis=0)
    return float(np.sqrt(np.mean(np.sum(jerk[pushed] ** 2, axis=1))))
