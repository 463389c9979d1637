"""Samples of a flight on their way from its thread to the one that publishes them, and their stamps.

The flight never waits. A stamp is the time of day, in even steps of the flight.
"""

from __future__ import annotations

import threading
from collections import deque
from typing import Any, NamedTuple

import numpy as np

from tandemlift import Flight
from tandemlift.apps.export.messages import SECOND
from tandemlift.apps.live.session.session import Session
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.simulation.recorded_flight import RecordedFlight
from tandemlift.simulation.results import recorded_channels

MAX_SAMPLES = 1000  # samples that may wait; more are forgotten, the oldest first


class Clock:
    """The time of day at which every step of a session's flight is due.

    It is the time of the flight on top of when its thread began to fly, so that samples are evenly apart to the
    nanosecond; after a delay that the flight will not make good, by that much later.

    Args:
        session: whose flight it is; not yet started.
    """

    def __init__(self, session: Session) -> None:
        self._pacer, self._dt, self._first = session.pacer, session.flight.dt, session.flight.step

    @property
    def runs(self) -> bool:
        """Whether the flight has begun."""
        return self._pacer.began is not None

    @property
    def late(self) -> float:
        """By how much the flight is late for good [s]."""
        return self._pacer.forgotten

    def stamp(self, step: int, late: float) -> int:
        """The time of day [ns] of a step that was flown when the flight was so late [s]; it has begun."""
        assert self._pacer.began is not None
        return self._pacer.began + round(((step - self._first) * self._dt + late) * SECOND)


class SampleBatch(NamedTuple):
    """Steps (T,) and, for each, its stamp [ns] and its sample (T, n)."""

    steps: list[int]
    stamps: list[int]
    rows: Array


class SampleQueue:
    """The samples of every so many steps of a flight.

    Args:
        every: steps from one sample to the next.
        clock: of the flight.
    """

    def __init__(self, every: int, clock: Clock) -> None:
        self._every, self._clock = every, clock
        self._waiting: deque[tuple[int, float, Array]] = deque(maxlen=MAX_SAMPLES)
        self._some = threading.Event()

    def note(self, flight: RecordedFlight) -> None:
        """Note the sample of the last step, if it is one of these."""
        step = flight.step - 1
        if step % self._every == 0:
            self._waiting.append((step, self._clock.late, flight.sample.copy()))
            self._some.set()

    def take(self, patience: float) -> SampleBatch | None:
        """All that wait, after so long [s] at most; None if there are none, or the flight has not begun."""
        self._some.wait(patience)
        self._some.clear()
        if not self._clock.runs:
            return None
        taken = [self._waiting.popleft() for _ in range(len(self._waiting))]
        if not taken:
            return None
        steps, late, rows = zip(*taken, strict=True)
        return SampleBatch(list(steps), list(map(self._clock.stamp, steps, late)), np.array(rows))


def as_flight(taken: SampleBatch, flight: RecordedFlight, tables: dict[str, Any]) -> Flight:
    """Samples as a flight, by which topics are made; `tables`: of its mission."""
    at = np.array(taken.steps) * flight.dt
    return Flight(at, recorded_channels(flight.layout, taken.rows, tables, at), tables, {})


def steps_between_samples(rate: float, dt: float) -> int:
    """Steps from a sample to the next, at a rate [Hz].

    Raises:
        InputError: steps are not that often, or it is not positive.
    """
    if not 0.1 <= rate <= 1.0 / dt + 1e-6:
        raise InputError(f"--rate {rate:g}: must be from 0.1 to {1.0 / dt:g} Hz, which is every step")
    return max(1, round(1.0 / (rate * dt)))
