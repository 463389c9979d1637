"""Stamps: the time of day, in even steps of the flight."""

from __future__ import annotations

import time

from tandemlift.export.messages import SECOND
from tandemlift.live.session.session import Session


class Clock:
    """The time of day at which every step of a session's flight is due.

    It is the time of the flight on top of when it began, so that samples are evenly apart to the nanosecond; after a
    delay that the flight will not make good, by that much later.
    """

    def __init__(self, session: Session) -> None:
        self._session, self._dt = session, session.flight.dt
        self._began = time.time_ns() - round(session.flight.step * self._dt * SECOND)

    @property
    def late(self) -> float:
        """By how much the flight is late for good [s]."""
        return self._session.pacer.forgotten

    def stamp(self, step: int) -> int:
        """The time of day of the step that is flown now [ns]."""
        return self._began + round((step * self._dt + self.late) * SECOND)
