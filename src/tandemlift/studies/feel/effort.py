"""The person's effort: how mission `zigzag` goes for a person with the admittance of another mission."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, load_mission
from tandemlift.simulation.many import fly_each
from tandemlift.studies.feel.quiet import quietly
from tandemlift.studies.validation.persons import succeeded

CORRIDOR = "zigzag"
LOGGED = 0.05  # s: motions of a person are slow against it
TOGETHER = 64  # flights


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


def corridor_changes(m: Mission) -> dict[str, Any]:
    """Changes of mission `zigzag`: the admittance of a mission, whose threshold the person knows."""
    a = m.admittance
    return {
        **{f"admittance.{name}": list(getattr(a, name)) for name in ("mass", "damping", "stiffness", "threshold")},
        "admittance.gate": a.gate,
        "admittance.reanchor": a.reanchor,
        "person.breakaway_force": max(a.threshold[:2]),
        "mission.log_interval": LOGGED,
    }


def effort_in_corridor(m: Mission) -> Effort:
    """The effort of the person of mission `zigzag` with the admittance of a mission."""
    with quietly():
        led = load_mission(CORRIDOR, corridor_changes(m))
    return efforts([led])[0]


def efforts(missions: Sequence[Mission], progress: Progress | None = None) -> list[Effort]:
    """The efforts of missions with persons, in their order; memory does not grow with their number."""
    found = list[Effort]()
    for first in range(0, len(missions), TOGETHER):
        some = missions[first : first + TOGETHER]
        found += [_effort(m, flight) for m, flight in zip(some, fly_each(some, keep="flights"), strict=True)]
        if progress:
            progress(len(found), len(missions))
    return found


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
