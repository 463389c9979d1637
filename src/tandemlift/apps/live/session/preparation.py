"""The preparation of a flight before its first step, and its status for the page."""

from __future__ import annotations

import time

from tandemlift.apps.live.session.status import NO_REFUSALS
from tandemlift.apps.live.wire.quantities import PREPARING
from tandemlift.apps.live.wire.server_messages import FlightStatus


class Preparation:
    """The progress of a flight's preparation.

    Attributes:
        step: the present task.
        failure: the reason why the mission cannot be flown, or "".
    """

    def __init__(self) -> None:
        self.step, self.failure, self._began = "putting the flight together", "", time.perf_counter()

    def status(self) -> FlightStatus:
        """The status of a flight that has not begun."""
        seconds = round(time.perf_counter() - self._began, 1)
        return FlightStatus(
            phase="failed" if self.failure else PREPARING,
            alarm="",
            enabled=True,
            paused=False,
            speed=1.0,
            factor=0.0,
            behind_ms=0.0,
            recorded_s=0.0,
            failed_rotors=[],
            refusals=NO_REFUSALS,
            ending=None,
            preparing={"step": self.step, "seconds": seconds, "failure": self.failure},
        )

    @property
    def refusal(self) -> str:
        """The reason for which every message is refused."""
        return f"the flight cannot be flown: {self.failure}" if self.failure else "the flight is still being prepared"
