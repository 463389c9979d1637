"""Pushes that come as messages: a wrench in a frame becomes a force at a point of the vehicle, until the next one.

A push that the pilot does not follow is reported with reason and remedy.

A dead-man's switch lets go 0.5 s of the flight after the last message. It is in the flight's own thread: it works
whatever becomes of the middleware.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from tandemlift.apps.export.coordinate_frames import ALIGNED, BASE, WORLD, fixed, to_body, to_world
from tandemlift.apps.live.session.page_messages import AskMessage, ForceMessage, TareMessage
from tandemlift.apps.live.session.session import Session
from tandemlift.apps.ros.diagnostics import Notify
from tandemlift.apps.ros.middleware import Answer
from tandemlift.core.errors import InputError
from tandemlift.core.phases import PHASE_NAMES
from tandemlift.core.types import Array
from tandemlift.simulation.recorded_flight import RecordedFlight

COMES_TO = {"lift": "lift", "land": "land", "stop": "stopped"}  # the phase that a request leads to
POSSIBLE = {  # from which
    "lift": ("idle",),
    "land": ("lift", "guided", "hold", "contact", "limited"),
    "stop": PHASE_NAMES,
}
REQUESTS = {
    "lift": "takes off from the ground",
    "land": "lands",
    "stop": "stops all rotors at once, until the node is restarted",
    "tare": "tares the force sensors: their mean over `estimator.tare_duration`, from a second later on, becomes their "
    "bias; in the air, with nobody pushing; only for a mission with `estimator.tare_start` whose pilot reads sensors",
}
PATIENCE, NAP = 1.0, 0.02  # s, for the pilot to do it, and between looks

What = Literal["lift", "land", "stop"]


class RequestServices:
    """Passes requests to a session's pilot.

    Args:
        session: that of the pilot.
        notify: called with what is refused.
        nap: waits for that long [s].
    """

    def __init__(self, session: Session, notify: Notify, nap: Callable[[float], None] = time.sleep) -> None:
        self._session, self._notify, self._nap = session, notify, nap

    def answer(self, what: str) -> Answer:
        """Make one of `REQUESTS`; return whether it is done or has begun, and a message."""
        try:
            if what == "tare":
                answers = self._session.apply(TareMessage(seq=0))
                return True, next(answer["detail"] for answer in answers if answer["type"] == "done")
            return self._ask(what)
        except InputError as error:
            self._notify(str(error))
            return False, str(error)

    def _ask(self, what: str) -> Answer:
        if self._phase() in POSSIBLE[what]:
            self._session.apply(AskMessage.model_validate({"seq": 0, "what": what}))
            for _ in range(round(PATIENCE / NAP)):
                if self._phase() == COMES_TO[what]:
                    return True, COMES_TO[what]
                self._nap(NAP)
        raise InputError(self._refusal(what))

    def _phase(self) -> str:
        return self._session.status()["phase"]

    def _refusal(self, what: str) -> str:
        """The reason why the pilot does not do it, and the remedy."""
        refusal = getattr(self._session.refusals, what, None)
        return str(refusal) if refusal else f"{what}: the pilot stays in phase {self._phase()}; ask again"


PUSH_TIMEOUT = 0.5  # s of the flight, for which a push acts without another message
FELT, AGAIN = 0.4, 1.0  # s of the flight, from the begin of a push to a look at whether it is followed, and to the next
MIN_FORCE = 1e-6  # N, below which there is no push
SLIP = 1e-6  # fraction of a torque that may be about the force's own direction
ABSURD = 1e6  # N, N m


class Pushes:
    """The push of who publishes.

    Args:
        session: whose flight is pushed.
        notify: called with what is refused and what is limited.
    """

    def __init__(self, session: Session, notify: Notify) -> None:
        self._session, self._notify = session, notify
        self._until = self._look = math.inf  # steps at which it ends, and at which it is looked at
        self._turn = threading.Lock()  # of several who push; the flight's thread never takes it
        vehicle = session.flight.now.hover.vehicle
        self._origins = {WORLD: np.zeros(3), ALIGNED: np.zeros(3), BASE: np.zeros(3), **dict(fixed(vehicle))}
        guards = np.array([q.guard_radius for q in vehicle.quadrotors])
        self._reach = float(np.max(np.linalg.norm(vehicle.lever_arms, axis=1) + guards))

    def handle(self, message: Any) -> None:
        """Apply the push of a `geometry_msgs/WrenchStamped`, or notify why not; it replaces any push before."""
        with self._turn:
            try:
                force, point = self._read(message)
                self._push(force, point)
                now, dt = self._session.flight.step, self._session.flight.dt
                self._until = now + PUSH_TIMEOUT / dt if any(force) else math.inf
                if not any(force):
                    self._look = math.inf
                elif self._look == math.inf:
                    self._look = now + FELT / dt
            except InputError as error:
                self.let_go()
                self._notify(f"push refused: {error}")

    def watch(self, flight: RecordedFlight) -> None:
        """After every step: end the push if no message has come for too long; report it if it is not followed."""
        if flight.step >= self._until:
            self.let_go()
            self._notify(f"push over: no message for {PUSH_TIMEOUT:g} s")
        if flight.step >= self._look:
            self._look = flight.step + AGAIN / flight.dt
            if flight.refusals.push:
                self._notify(str(flight.refusals.push))

    def let_go(self) -> None:
        """End the push."""
        self._until = self._look = math.inf
        self._push(np.zeros(3), np.zeros(3))

    def _push(self, force: Array, point: Array) -> None:
        (x, y, z), (along, left, up) = force.tolist(), point.tolist()
        self._session.apply(ForceMessage(seq=0, force=(x, y, z), point=(along, left, up)))

    def _read(self, message: Any) -> tuple[Array, Array]:
        """Force [N, world axes] and where it acts [m, body axes] of a message.

        Raises:
            InputError: it is in no frame of the vehicle, not finite, or nothing that a hand at a point can do.
        """
        frame = message.header.frame_id.lstrip("/")
        if frame not in self._origins:
            raise InputError(f"frame_id = {frame[:80]!r}: must be one of {', '.join(self._origins)}")
        force, torque = (np.array([[v.x, v.y, v.z]], float) for v in (message.wrench.force, message.wrench.torque))
        if not (np.abs(np.hstack([force, torque])) <= ABSURD).all():
            raise InputError(f"the wrench must be finite, and each of its numbers at most {ABSURD:g}")
        attitude = self._session.channels()["attitude"]
        world, body = force, (force, torque)
        if frame in (WORLD, ALIGNED):
            body = to_body(attitude, force), to_body(attitude, torque)
        else:
            world = to_world(attitude, force)
        return self._bounded(world[0]), self._point(frame, body[0][0], body[1][0])

    def _bounded(self, force: Array) -> Array:
        """A force of the same direction that the flight's hand has at most."""
        most, size = self._session.flight.now.person.max_force, float(np.linalg.norm(force))
        if size <= most:
            return force if size >= MIN_FORCE else np.zeros(3)
        self._notify(f"push cut: {size:.3g} N is more than person.max_force = {most:g} N")
        return force * (most / size)

    def _point(self, frame: str, force: Array, torque: Array) -> Array:
        """The point at which a force has a torque about a frame's origin [m, body axes].

        Raises:
            InputError: there is no such point on the vehicle.
        """
        size, turning = float(np.linalg.norm(force)), float(np.linalg.norm(torque))
        if not turning:
            return self._origins[frame]
        if size < MIN_FORCE or abs(force @ torque) > SLIP * size * turning:
            raise InputError("a torque that no force at a point has: its part along the force must be zero")
        point = self._origins[frame] + np.cross(force, torque) / size**2
        if np.linalg.norm(point) > self._reach:
            raise InputError(f"a torque that acts {np.linalg.norm(point):.3g} m off: at most {self._reach:.3g} m")
        return point
