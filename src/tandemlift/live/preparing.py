"""What comes before a flight's first step, and how it is told to those who wait."""

from __future__ import annotations

import gc
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

NEVER = 10**9  # as many searches for garbage among the young before one among the old


class Preparing:
    """How far a flight is.

    Attributes:
        step: what is being done.
        failure: why it cannot be flown; "" unless that is so.
    """

    def __init__(self) -> None:
        self.step, self.failure, self._began = "putting the flight together", "", time.perf_counter()

    def status(self) -> dict[str, Any]:
        """For people, as a session's own."""
        phase = "failed" if self.failure else "preparing"
        told = {"step": self.step, "seconds": round(time.perf_counter() - self._began, 1), "failure": self.failure}
        still = {"alarm": "", "enabled": True, "paused": False, "speed": 1.0, "dead": []}
        return {"phase": phase, "preparing": told, **still, "factor": 0.0, "behind_ms": 0.0, "recorded_s": 0.0}

    @property
    def refusal(self) -> str:
        """Why nothing is heeded."""
        return f"the flight cannot be flown: {self.failure}" if self.failure else "the flight is still being prepared"


@contextmanager
def without_long_pauses() -> Iterator[None]:
    """Leave out full searches for garbage, which would keep the flight waiting for 10 to 100 ms."""
    young, middle, _ = before = gc.get_threshold()
    gc.collect()
    gc.freeze()
    gc.set_threshold(young, middle, NEVER)
    try:
        yield
    finally:
        gc.set_threshold(*before)
        gc.unfreeze()
