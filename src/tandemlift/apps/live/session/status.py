"""The status of a flight, also before its first step: its state in words, its pace, and the refusals that apply now."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from tandemlift.apps.live.session import server_messages as server
from tandemlift.core.findings import Finding
from tandemlift.core.phases import PHASE_NAMES
from tandemlift.core.refusals import ALARM_TEXTS, Refusals, refusals_for
from tandemlift.core.types import Array
from tandemlift.flight.record import Ending

if TYPE_CHECKING:
    from tandemlift.apps.live.session.pacing import Pacer
    from tandemlift.simulation.recorded_flight import RecordedFlight

FINDINGS_EVERY = 1.0  # s
NO_REFUSALS = server.StatusRefusals(lift="", land="", push="")


class Preparation:
    """The progress of a flight's preparation.

    Attributes:
        step: the present task.
        failure: the reason why the mission cannot be flown, or "".
    """

    def __init__(self) -> None:
        self.step, self.failure, self._began = "putting the flight together", "", time.perf_counter()

    def status(self) -> server.FlightStatus:
        """The status of a flight that has not begun."""
        seconds = round(time.perf_counter() - self._began, 1)
        return server.FlightStatus(
            phase="failed" if self.failure else server.PREPARING,
            alarm="",
            enabled=True,
            paused=False,
            speed=1.0,
            factor=0.0,
            behind_ms=0.0,
            recorded_s=0.0,
            failed_rotors=[],
            tare_left_s=0.0,
            refusals=NO_REFUSALS,
            ending=None,
            preparing={"step": self.step, "seconds": seconds, "failure": self.failure},
        )

    @property
    def refusal(self) -> str:
        """The reason for which every message is refused."""
        return f"the flight cannot be flown: {self.failure}" if self.failure else "the flight is still being prepared"


class FlightFindings:
    """The findings of a flight so far, formed anew once a second: that takes some milliseconds."""

    def __init__(self) -> None:
        self._of: RecordedFlight | None = None
        self._numbers: Array | None = None
        self._due, self._found = 0, list[server.StatusFinding]()

    def look(self, flight: RecordedFlight) -> None:
        """Take the numbers of a flight if they are due; while it stands still."""
        if flight is not self._of or flight.step >= self._due:
            self._of, self._due = flight, flight.step + round(FINDINGS_EVERY / flight.dt)
            self._numbers = flight.numbers()

    def added_to(self, status: server.FlightStatus) -> server.FlightStatus:
        """The status with the findings at the last update, and the score so far; the flight may continue meanwhile."""
        from tandemlift.apps.live.session.challenge import score_so_far

        status["findings"] = self._formed()
        if self._of and (score := score_so_far(self._of)):
            status["score"] = score
        return status

    def _formed(self) -> list[server.StatusFinding]:
        flight, numbers = self._of, self._numbers
        if flight and numbers is not None:
            self._numbers = None
            self._found = told(flight.findings(numbers))
        return self._found


def told(findings: Iterable[Finding]) -> list[server.StatusFinding]:
    """Findings in the form of a page's message."""
    return [server.StatusFinding(kind=f.kind, time=f.time, text=f.text) for f in findings]


def phase_of(flight: RecordedFlight, number: int, failed: bool) -> str:
    """The phase of a flight by its number, or its ending; `failed`: by an error."""
    if failed:
        return "failed"
    if flight.ending:
        return phase_after(flight.ending)
    return "over" if flight.over else PHASE_NAMES[number]


def phase_after(ending: Ending) -> str:
    """The phase of a flight that was stopped before its end."""
    return ending.outcome if ending.outcome in server.LOST else "failed"


def refusals_now(flight: RecordedFlight, failed: bool) -> Refusals:
    """The refusals that would apply now; `failed`: whether the flight has ended by an error."""
    if failed:
        return refusals_for("error")
    if flight.over:
        return refusals_for("stopped_early" if flight.lost and not flight.interruption else "over")
    return flight.refusals


def scene_ending(ending: Ending | None, place: Iterable[float]) -> server.SceneEnding | None:
    """Reason and place [m, world] of a flight stopped before its end, for a page; None if it was not."""
    if ending is None:
        return None
    at = [float(x) for x in place]
    known = at if all(map(math.isfinite, at)) else None
    return server.SceneEnding(outcome=phase_after(ending), text=str(ending), time=ending.time, place=known)


def in_sentences(refusals: Refusals) -> server.StatusRefusals:
    """Refusals in the form of a page's message."""
    lift, land, push = (str(refusal or "") for refusal in refusals)
    return server.StatusRefusals(lift=lift, land=land, push=push)


def status_of(
    flight: RecordedFlight, pacer: Pacer, values: Mapping[str, Any], vehicle: server.SceneVehicle, failed: bool
) -> server.FlightStatus:
    """The status of a flight, without its findings; `values`: of the fields of its latest frame."""
    from tandemlift.apps.live.session.checks import failed_rotors, tare_left

    most, pacer.most_behind = pacer.most_behind, 0.0
    return server.FlightStatus(
        phase=phase_of(flight, int(values["phase"][0]), failed),
        alarm=ALARM_TEXTS[int(values["alarm"][0])] if "alarm" in values else "",
        enabled=bool(flight.hand.enabled),
        paused=pacer.paused,
        speed=pacer.speed,
        factor=round(pacer.factor, 3),
        behind_ms=round(1e3 * most, 2),
        recorded_s=round(flight.step * flight.dt, 3),
        failed_rotors=failed_rotors(flight),
        tare_left_s=round(tare_left(flight, vehicle), 3),
        refusals=in_sentences(refusals_now(flight, failed)),
        ending=scene_ending(flight.ending, flight.ending_place),
    )
