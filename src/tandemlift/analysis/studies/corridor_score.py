"""The score of a flight through a corridor, by hand or by a simulated person.

The score is a time [s], and the lowest wins:

    time + 5 s · touches + effort / 5 N + 1 s · jerk

time: from the first push until the centre of mass passes the end of the corridor; touches: contacts with walls;
effort: ∫|F| dt of the push [N s]; jerk: the logarithm of the dimensionless jerk of the velocity v,
ln(T³/v_max² ∫|d²v/dt²|² dt), as Hogan and Sternad (2009) measure the smoothness of arm movements: 5.3 for the smoothest
reach, more for a movement in many pieces.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.parts.contact.surroundings import CorridorTable

TOUCH, EFFORT, JERK = 5.0, 0.2, 1.0  # s a touch, s per N s, s per unit
PRESSED = 0.5  # N, of a horizontal contact force: a touch
APART = 0.5  # s without one between two touches
LEFT = "left the corridor at {time:.2f} s"
MINIMUM = 4  # rows, of which a jerk can be formed
SCORED = ("position", "velocity", "push_force", "contact_force")  # channels


class CorridorScore(NamedTuple):
    """Time [s], number of touches, effort [N s], logarithm of the dimensionless jerk; see the module."""

    time: float
    touches: int
    effort: float
    jerk: float

    @property
    def total(self) -> float:
        """The score [s]."""
        return self.time + TOUCH * self.touches + EFFORT * self.effort + JERK * self.jerk


class CorridorRun(NamedTuple):
    """A run from the first push on [s]: whether it has reached the end, when it left the corridor, its score so far."""

    start: float
    finished: bool
    left: float | None
    score: CorridorScore


def score_of(flight: Flight) -> CorridorScore:
    """The score of a flight through its corridor.

    Raises:
        InputError: it has no corridor, nobody pushed, or it left the corridor or did not reach its end.
    """
    corridor = CorridorTable.model_validate(flight.mission.get("corridor", {}))
    if not corridor.centreline:
        raise InputError(f"{flight.name}: has no [corridor], so it has no score")
    run = corridor_run(corridor, flight.time, {name: flight[name] for name in SCORED})
    if run is None:
        raise InputError(f"{flight.name}: nobody pushed")
    if not run.finished:
        raise InputError(f"{flight.name}: the end of the corridor was not reached")
    if run.left is not None:
        raise InputError(f"{flight.name}: {LEFT.format(time=run.left)}")
    return run.score


def corridor_run(corridor: CorridorTable, time: Array, channels: Mapping[str, Array]) -> CorridorRun | None:
    """The run of the channels `SCORED` (n, 3) at times [s]; None if nobody pushed."""
    pushed = np.flatnonzero(np.linalg.norm(channels["push_force"], axis=1) > 0.0)
    if not len(pushed) or pushed[0] + MINIMUM > len(time):
        return None
    first = int(pushed[0])
    past = np.flatnonzero(_beyond(corridor, channels["position"][first + 1 :]))
    span = slice(first, first + 2 + int(past[0]) if len(past) else None)
    time, position, velocity, push, contact = time[span], *(channels[name][span] for name in SCORED)
    outside = np.flatnonzero(_outside(corridor, position))
    score = CorridorScore(
        float(time[-1] - time[0]),
        count_touches(time, contact),
        float(np.trapezoid(np.linalg.norm(push, axis=1), time)),
        log_dimensionless_jerk(time, velocity),
    )
    return CorridorRun(float(time[0]), len(past) > 0, float(time[outside[0]]) if len(outside) else None, score)


def count_touches(time: Array, force: Array) -> int:
    """Number of contacts with walls, by the horizontal part of the contact force (n, 3) [N]."""
    pressed = time[np.linalg.norm(force[:, :2], axis=1) > PRESSED]
    return int(np.sum(np.diff(pressed) > APART)) + 1 if len(pressed) else 0


def log_dimensionless_jerk(time: Array, velocity: Array) -> float:
    """ln(T³/v_max² ∫|d²v/dt²|² dt) of a velocity (n, 3) at evenly spaced times [s]."""
    step, span = time[1] - time[0], time[-1] - time[0]
    jerk = np.diff(velocity, 2, axis=0) / step**2
    largest = np.linalg.norm(velocity, axis=1).max()
    return float(np.log(span**3 / largest**2 * np.sum(jerk**2) * step))


def _beyond(corridor: CorridorTable, position: Array) -> Array:
    """Whether positions (n, 3) are past the end of the corridor (n,)."""
    before, end = np.array(corridor.centreline[-2:])
    return np.asarray((position[:, :2] - end) @ (end - before) > 0.0)


def _outside(corridor: CorridorTable, position: Array) -> Array:
    """Whether positions (n, 3) before its end are beside the corridor or above its walls (n,)."""
    line = np.array(corridor.centreline)
    starts, along = line[:-1], np.diff(line, axis=0)
    offset = position[:, None, :2] - starts  # (n, stretches, 2)
    share = np.clip(np.sum(offset * along, axis=2) / np.sum(along**2, axis=1), 0.0, 1.0)
    beside = np.linalg.norm(offset - share[..., None] * along, axis=2).min(axis=1)
    behind = np.sum((position[:, :2] - line[0]) * along[0], axis=1) < 0.0  # before its entrance is no wall
    return np.asarray(((beside > 0.5 * corridor.width) & ~behind) | (position[:, 2] > corridor.height))
