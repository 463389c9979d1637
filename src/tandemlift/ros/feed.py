"""Samples of a flight on their way from its thread to the one that publishes them; the flight never waits."""

from __future__ import annotations

import threading
from collections import deque
from typing import NamedTuple

import numpy as np

from tandemlift.flight import Flight
from tandemlift.flown import channels_of
from tandemlift.live.recorded import RecordedFlight
from tandemlift.vehicle import Array

MOST = 1000  # samples that may wait; more are forgotten, the oldest first


class Taken(NamedTuple):
    """Steps (T,) and, for each, its sample (T, n)."""

    steps: list[int]
    rows: Array


class Feed:
    """Every so manieth sample of a flight.

    Args:
        every: steps from one to the next.
    """

    def __init__(self, every: int) -> None:
        self._every = every
        self._waiting: deque[tuple[int, Array]] = deque(maxlen=MOST)
        self._some = threading.Event()

    def note(self, flight: RecordedFlight) -> None:
        """Note the sample of the last step, if it is one of these."""
        step = flight.step - 1
        if step % self._every == 0:
            self._waiting.append((step, flight.sample.copy()))
            self._some.set()

    def take(self, patience: float) -> Taken | None:
        """All that wait, after so long [s] at most; None if there are none."""
        self._some.wait(patience)
        self._some.clear()
        taken = [self._waiting.popleft() for _ in range(len(self._waiting))]
        return Taken([step for step, _ in taken], np.array([row for _, row in taken])) if taken else None


def as_flight(taken: Taken, flight: RecordedFlight, tables: dict) -> Flight:
    """Samples as a flight, by which topics are made; `tables`: of its mission."""
    time = np.array(taken.steps) * flight.dt
    return Flight(time, dict(channels_of(flight.layout, taken.rows)), tables, {})
