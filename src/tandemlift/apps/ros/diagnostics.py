"""Events, also in ROS's log, and once a second the state of the flight, as messages of `/diagnostics`."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Mapping

from tandemlift import Flight
from tandemlift.apps.export.messages import event_maker, status_maker
from tandemlift.apps.export.topics import DIAGNOSTICS
from tandemlift.apps.ros.middleware import Middleware
from tandemlift.simulation.results import changes_of

AGAIN = 1.0  # s, before the same words are repeated
MAX_EVENTS = 100  # events that wait
Notify = Callable[[str], None]


class FlightDiagnostics:
    """The events and the state of a flight, as messages.

    Args:
        middleware: publishes them.
    """

    def __init__(self, middleware: Middleware) -> None:
        self._middleware = middleware
        self._channel = middleware.advertise(DIAGNOSTICS.name, DIAGNOSTICS.kind, depth=MAX_EVENTS)
        self._event, self._status = event_maker(middleware.types), status_maker(middleware.types)
        self._waiting: deque[tuple[int, str]] = deque(maxlen=MAX_EVENTS)
        self._said: dict[str, float] = {}
        self._now = (-1, 0, 0, 0)  # phase, alarm, failed check, contact

    def add(self, what: str) -> None:
        """Queue an event, from any thread and without waiting; the same words once a second at most."""
        now = time.monotonic()
        if now - self._said.get(what, -AGAIN) >= AGAIN:
            self._said[what] = now
            self._waiting.append((time.time_ns(), what))

    def flush(self) -> None:
        """Publish the waiting events."""
        while self._waiting:
            at, what = self._waiting.popleft()
            self._channel.publish(self._event(at, what))
            self._middleware.log(what)
        if len(self._said) > MAX_EVENTS:
            self._said.clear()

    def follow(self, flight: Flight, stamps: list[int]) -> None:
        """Queue phases, alarms, failed checks and contacts as they change in samples."""
        for row, now, text in changes_of(flight, self._now):
            self._waiting.append((stamps[row], text))
            self._now = now

    def report(self, stamp: int, summary: str, well: bool, more: Mapping[str, str]) -> None:
        """Publish the state of the flight: a word for it, whether all is `well`, and more by name."""
        self._channel.publish(self._status(stamp, well, summary, more))
