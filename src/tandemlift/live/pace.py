"""Keeping a flight in pace with the clock on the wall."""

from __future__ import annotations

import time
from collections import deque

MOST_BEHIND = 0.1  # s of flight; what is owed beyond is forgotten, and the flight is late for good
WINDOW = 1.0  # s, over which the pace is measured
NAP = 0.002  # s, between looks at the clock
BREATH = 1e-4  # s, for others between two batches of a flight that is behind
SWITCHING = 2e-4  # s, for which another thread may keep the interpreter from the flight
BATCH = 25  # steps without a look at who wants something


class Pace:
    """How many steps are due.

    Args:
        dt: of a step [s].

    Attributes:
        speed: time of the flight over time on the wall.
        paused: whether time stands still.
        behind: s of flight that are owed.
        most_behind: the most that were owed since this was last set to 0.
        forgotten: s of flight that were owed and will never be flown.
    """

    def __init__(self, dt: float) -> None:
        self.dt, self.speed, self.paused, self.behind = dt, 1.0, False, 0.0
        self.most_behind, self.forgotten = 0.0, 0.0
        self._then = time.perf_counter()
        self._flown: deque[tuple[float, int]] = deque()

    def begin(self) -> None:
        """Owe nothing of the time that has passed."""
        self.behind, self._then = 0.0, time.perf_counter()

    def due(self) -> int:
        """Steps to be flown now."""
        now = time.perf_counter()
        passed, self._then = now - self._then, now
        if self.paused:
            self.behind = 0.0
            return 0
        owed = self.behind + passed * self.speed
        self.behind = min(owed, MOST_BEHIND)
        self.forgotten += owed - self.behind
        self.most_behind = max(self.most_behind, self.behind)
        return int(self.behind / self.dt)

    def flew(self, steps: int) -> None:
        """Note that so many steps were flown."""
        self.behind -= steps * self.dt
        now = time.perf_counter()
        self._flown.append((now, steps))
        while self._flown and now - self._flown[0][0] > WINDOW:
            self._flown.popleft()

    @property
    def factor(self) -> float:
        """Time of the flight over time on the wall, during the last second."""
        if len(self._flown) < 2:
            return 0.0
        span = time.perf_counter() - self._flown[0][0]
        return sum(steps for _, steps in list(self._flown)[1:]) * self.dt / max(span, 1e-3)
