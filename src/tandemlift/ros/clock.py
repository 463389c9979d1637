"""Stamps: the time of day, in even steps of the flight."""

from __future__ import annotations

import time

from tandemlift.export.messages import SECOND

LATE = SECOND // 4  # ns, by which a sample may be late before stamps go on from now


class Clock:
    """The time of day of every step of a flight that is flown in real time.

    A stamp is the time of the flight on top of when it began, so that samples are evenly apart to the nanosecond. A
    flight that was late for good goes on from the present time.

    Args:
        dt: of a step [s].
        step: the one that is flown now.
    """

    def __init__(self, dt: float, step: int) -> None:
        self._dt, self._began = dt, time.time_ns() - round(step * dt * SECOND)

    def stamp(self, step: int) -> int:
        """The time of day of a step [ns]."""
        return self._began + round(step * self._dt * SECOND)

    def catch_up(self, step: int) -> float:
        """Note that a step has just been flown; by how much stamps jump ahead from here on [s], mostly not at all."""
        late = time.time_ns() - self.stamp(step)
        if late < LATE:
            return 0.0
        self._began += late
        return late / SECOND
