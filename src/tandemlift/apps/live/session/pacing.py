"""Real time: the number of steps due by the clock, and the thread that takes them."""

from __future__ import annotations

import gc
import sys
import threading
import time
from collections import deque
from collections.abc import Callable

MOST_BEHIND = 0.1  # s of flight; what is due beyond is dropped, and the flight is late for good
WINDOW = 1.0  # s, over which the pace is measured
BATCH = 25  # steps between two looks at the clock
PAUSE = 0.002  # s, between looks at the clock while no full batch is due
YIELD = 1e-4  # s, left to other threads after a full batch
SWITCH_INTERVAL = 2e-4  # s, for which another thread may keep the interpreter from the flight
NEVER = 10**9  # collections of young garbage for each of the old


class Pacer:
    """Computes the number of due steps.

    Args:
        dt: of a step [s].

    Attributes:
        speed: requested flight time over wall time.
        paused: whether time stands still.
        behind: flight time that is due [s].
        most_behind: the largest due time since this was last set to 0 [s].
        forgotten: flight time that was due and will never be flown [s].
        began: the time of day from which on time is counted [ns]; None before.
    """

    def __init__(self, dt: float) -> None:
        self.dt, self.speed, self.paused, self.behind = dt, 1.0, False, 0.0
        self.most_behind, self.forgotten = 0.0, 0.0
        self.began: int | None = None
        self._then = time.perf_counter()
        self._flown: deque[tuple[float, int]] = deque()

    def begin(self) -> None:
        """Count time from now on."""
        self.behind, self._then, self.began = 0.0, time.perf_counter(), time.time_ns()

    def due(self) -> int:
        """Steps to be flown now."""
        now = time.perf_counter()
        passed, self._then = now - self._then, now
        if self.paused:
            self.behind = 0.0
            return 0
        due = self.behind + passed * self.speed
        self.behind = min(due, MOST_BEHIND)
        self.forgotten += due - self.behind
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
        """Flight time over wall time, during the last second."""
        if len(self._flown) < 2:
            return 0.0
        span = time.perf_counter() - self._flown[0][0]
        return sum(steps for _, steps in list(self._flown)[1:]) * self.dt / max(span, 1e-3)


class RealTimeThread:
    """A thread that prepares a flight, then takes its steps as they are due.

    Args:
        pacer: computes the due steps.
        lock: held while steps are taken.
        prepare: whether the flight can be flown; called once, in the thread.
        fly: takes at most that many steps, and returns their number.
    """

    def __init__(
        self, pacer: Pacer, lock: threading.RLock, prepare: Callable[[], bool], fly: Callable[[int], int]
    ) -> None:
        self._pacer, self._lock, self._prepare, self._fly = pacer, lock, prepare, fly
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="flight", daemon=True)

    def start(self) -> None:
        """Prepare the flight, and fly."""
        self._thread.start()

    def stop(self, *, wait: bool) -> None:
        """End the thread; if `wait`, return when it has ended."""
        self._stopping.set()
        if wait and self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        interval = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_INTERVAL)
        try:
            if self._prepare():
                with WITHOUT_FULL_COLLECTIONS:
                    self._keep_pace()
        finally:
            sys.setswitchinterval(interval)

    def _keep_pace(self) -> None:
        self._pacer.begin()
        while not self._stopping.is_set():
            with self._lock:
                steps = self._fly(min(self._pacer.due(), BATCH))
                self._pacer.flew(steps)
            time.sleep(PAUSE if steps < BATCH else YIELD)


class WithoutFullCollections:
    """Within, full garbage collections are left out, which would stop a flight for 10 to 100 ms.

    Several flights may be within at once; the collector is as before when the last one has left.
    """

    def __init__(self) -> None:
        self._lock, self._within, self._before = threading.Lock(), 0, gc.get_threshold()

    def __enter__(self) -> None:
        with self._lock:
            if not self._within:
                self._before = gc.get_threshold()
                gc.collect()
                gc.set_threshold(*self._before[:2], NEVER)
            self._within += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._within -= 1
            if not self._within:
                gc.set_threshold(*self._before)


WITHOUT_FULL_COLLECTIONS = WithoutFullCollections()
