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


def pulse(s: float, lag: float) -> float:
    """What the hand's low-pass turns into the pulse p = 16 s² (1 − s)², 0 ≤ s ≤ 1: p + 2 lag p' + lag² p''.

    `lag`: each of its two time constants, in durations of the pulse.
    """
    r, slope = s * (1.0 - s), 1.0 - 2.0 * s
    return 16.0 * r * r + 64.0 * lag * r * slope + 32.0 * lag * lag * (slope * slope - 2.0 * r)


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
        self._moving: page.ForceMessage | None = None  # the shake or tap in progress
        self._since = 0  # the step at which it began

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
        if not (self._moving and m.frequency and self._moving.frequency == m.frequency):
            self._since = self._flight.step
        self._moving = m if any(m.force) and (m.frequency or m.duration) else None
        self._change(force=ZERO if self._moving else Vec3(*m.force), **grip)

    def release(self) -> None:
        """Let go of the beam, and push no more."""
        self._moving = None
        self._change(held=0.0, force=ZERO)

    def request(self, m: page.AskMessage) -> None:
        """Ask the pilot to lift off, to land or to stop."""
        self._change(**{m.what: 1.0})
        if m.what != "stop":
            self._requests[m.what] = self._flight.step + round(REQUEST_TIME / self._flight.dt)

    def enable(self, on: bool) -> None:
        """Let the pilot follow pushes, or not."""
        self._change(enabled=float(on))

    def _go_on(self, m: page.ForceMessage) -> None:
        """The force of a tap, one pulse, or of a shake, pulses to and fro, in the middle of the next step."""
        duration = m.duration or 0.5 / m.frequency
        n, s = divmod((self._flight.step - self._since + 0.5) * self._flight.dt / duration, 1.0)
        if m.duration and n > 0.0:
            self._moving = None
        now = pulse(s, self._flight.start.person.lag / duration) if self._moving else 0.0
        self._change(force=Vec3(*m.force) * (now if n % 2.0 == 0.0 else -now))

    def expire_requests(self) -> None:
        """Withdraw the requests that have been held for long enough, go on with a shake or tap; before every step."""
        over = [what for what, until in self._requests.items() if self._flight.step >= until]
        for what in over:
            del self._requests[what]
        if over:
            self._change(**dict.fromkeys(over, 0.0))
        if self._moving:
            self._go_on(self._moving)

    def _change(self, **changes: Any) -> None:
        self._flight.hold(self._flight.hand._replace(**changes))
