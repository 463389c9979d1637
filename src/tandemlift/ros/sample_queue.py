"""Samples of a flight on their way from its thread to the one that publishes them, and their stamps.

The flight never waits. A stamp is the time of day, in even steps of the flight.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.export.messages import SECOND
from tandemlift.flight.record import Flight
from tandemlift.interactive.recorded_flight import RecordedFlight
from tandemlift.live.session.session import Session
from tandemlift.simulation.results import channels_of

MOST = 1000  # samples that may wait; more are forgotten, the oldest first


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


class SampleBatch(NamedTuple):
    """Steps (T,) and, for each, its stamp [ns] and its sample (T, n)."""

    steps: list[int]
    stamps: list[int]
    rows: Array


class SampleQueue:
    """The samples of every so many steps of a flight.

    Args:
        every: steps from one sample to the next.
        stamp: the time of day of a step that is flown now [ns].
    """

    def __init__(self, every: int, stamp: Callable[[int], int]) -> None:
        self._every, self._stamp = every, stamp
        self._waiting: deque[tuple[int, int, Array]] = deque(maxlen=MOST)
        self._some = threading.Event()

    def note(self, flight: RecordedFlight) -> None:
        """Note the sample of the last step, if it is one of these."""
        step = flight.step - 1
        if step % self._every == 0:
            self._waiting.append((step, self._stamp(step), flight.sample.copy()))
            self._some.set()

    def take(self, patience: float) -> SampleBatch | None:
        """All that wait, after so long [s] at most; None if there are none."""
        self._some.wait(patience)
        self._some.clear()
        taken = [self._waiting.popleft() for _ in range(len(self._waiting))]
        if not taken:
            return None
        steps, stamps, rows = zip(*taken, strict=True)
        return SampleBatch(list(steps), list(stamps), np.array(rows))


def as_flight(taken: SampleBatch, flight: RecordedFlight, tables: dict[str, Any]) -> Flight:
    """Samples as a flight, by which topics are made; `tables`: of its mission."""
    at = np.array(taken.steps) * flight.dt
    return Flight(at, dict(channels_of(flight.layout, taken.rows)), tables, {})


def steps_between_samples(rate: float, dt: float) -> int:
    """Steps from a sample to the next, at a rate [Hz].

    Raises:
        InputError: steps are not that often, or it is not positive.
    """
    if not 0.1 <= rate <= 1.0 / dt + 1e-6:
        raise InputError(f"--rate {rate:g}: must be from 0.1 to {1.0 / dt:g} Hz, which is every step")
    return max(1, round(1.0 / (rate * dt)))
