"""The virtual hand of the page that holds the beam, and the requests of the person, on one flight."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tandemlift.apps.live.session import page_messages as page
from tandemlift.apps.live.session.checks import check_touch
from tandemlift.apps.live.session.server_messages import SceneVehicle
from tandemlift.core.vector import ZERO, Quat, Vec3, apply
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.simulation.recorded_flight import RecordedFlight

REQUEST_TIME = 0.2  # s, for which a request to lift or to land is held


def grip_offset(attitude: Quat, point: Vec3) -> Vec3:
    """The vector from a cursor's grip to the centre of mass [m, world]; `point`: the grip, in body axes."""
    return -apply(rotation_from_quaternion(attitude), point)


def hands_off(flight: RecordedFlight) -> None:
    """Let go on a flight that takes the place of another: no hand holds there, and no request is made."""
    flight.hold(flight.hand._replace(held=0.0, force=ZERO, lift=0.0, land=0.0))


class HandControl:
    """Moves the hand of a flight. Callers hold the flight's lock.

    Args:
        flight: that of the hand.
        vehicle: which points may be touched.

    Attributes:
        seq: number of the last message that was for the hand.
    """

    def __init__(self, flight: RecordedFlight, vehicle: SceneVehicle) -> None:
        self._flight, self._vehicle, self.seq = flight, vehicle, 0
        self._offset = ZERO  # m, added to targets
        self._requests: dict[str, int] = {}  # last step of each

    def take(self, m: page.BeamMessage, attitude: Callable[[], Quat]) -> None:
        """Grab, move, push or release, as a message says; `attitude`: of the vehicle, if it is needed.

        Raises:
            InputError: the vehicle may not be touched now, or not there.
        """
        match m:
            case page.GrabMessage():
                check_touch(self._flight, self._vehicle, m.point)
                self._grab(m, attitude)
            case page.MoveMessage() if self._flight.hand.held:
                self._change(target=Vec3(*m.target) + self._offset)
            case page.ForceMessage():
                self._push(m)
            case page.ReleaseMessage():
                self.release()

    def _grab(self, m: page.GrabMessage, attitude: Callable[[], Quat]) -> None:
        """Take hold of the beam at a point, or at the centre of mass."""
        point, centre = Vec3(*m.point), m.at == "centre"
        self._offset = grip_offset(attitude(), point) if centre else ZERO
        target = Vec3(*m.target) + self._offset
        self._change(held=1.0, grip=ZERO if centre else point, target=target)

    def _push(self, m: page.ForceMessage) -> None:
        """Push with a force; a hand that holds the beam keeps its grip."""
        if any(m.force):
            check_touch(self._flight, self._vehicle, m.point)
        grip = {"grip": Vec3(*m.point)} if any(m.force) and not self._flight.hand.held else {}
        self._change(force=Vec3(*m.force), **grip)

    def release(self) -> None:
        """Let go of the beam, and push no more."""
        self._change(held=0.0, force=ZERO)

    def request(self, m: page.AskMessage) -> None:
        """Ask the pilot to lift off, to land or to stop."""
        self._change(**{m.what: 1.0})
        if m.what != "stop":
            self._requests[m.what] = self._flight.step + round(REQUEST_TIME / self._flight.dt)

    def enable(self, on: bool) -> None:
        """Let the pilot follow pushes, or not."""
        self._change(enabled=float(on))

    def expire_requests(self) -> None:
        """Withdraw the requests that have been held for long enough; before every step."""
        over = [what for what, until in self._requests.items() if self._flight.step >= until]
        for what in over:
            del self._requests[what]
        if over:
            self._change(**dict.fromkeys(over, 0.0))

    def _change(self, **changes: Any) -> None:
        self._flight.hold(self._flight.hand._replace(**changes))
