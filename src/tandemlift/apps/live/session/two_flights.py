"""A session with a ghost: a second flight under the same hand, with the settings as they were when it was kept.

Both take every step together; each is bit-identical to one that flies alone with its settings and the same hand.
"""

from __future__ import annotations

from typing import cast

from tandemlift.apps.live.session import page_messages as page
from tandemlift.apps.live.session.checks import check_repeatable
from tandemlift.apps.live.session.hand_control import hands_off
from tandemlift.apps.live.session.interactive_mission import with_whole_rotors
from tandemlift.apps.live.session.parameters import scene_at
from tandemlift.apps.live.session.server_messages import Answer, FlightScene, FlightStatus
from tandemlift.apps.live.session.session import Session
from tandemlift.simulation.recorded_flight import RecordedFlight


class TwoFlights(Session):
    """A session beside whose flight a ghost may fly."""

    _ghost: RecordedFlight | None = None
    _next_ghost: RecordedFlight | None = None  # of the flight that continues next
    _begun = _swaps = 0  # ghosts, and changes of places

    def prepare(self) -> None:
        """Compile the flight, and take its first step; once."""
        if not self.is_ready:
            self.watchers.append(self._fly_along)
        super().prepare()

    def _fly_along(self, flight: RecordedFlight) -> None:
        """Let the ghost take the step that the flight has taken, with the same hand, unless it has ended before."""
        ghost = self._ghost
        if ghost is None or ghost.over or ghost.step != flight.step - 1:
            return
        if ghost.hand != flight.hand:
            ghost.hold(flight.hand)
        ghost.advance()

    def apply(self, message: page.PageMessage) -> list[Answer]:
        """Apply a message; return the answers.

        Raises:
            InputError: it cannot be done; the text says why.
        """
        if isinstance(message, page.CompareMessage) and self.is_ready:
            self._compare(message)
            self.generation += 1
            return []
        if not isinstance(message, (page.ResetMessage, page.RewindMessage, page.FlyMessage)):
            return super().apply(message)
        with self.turn:
            self._next_ghost = self._ghost_after(message)  # without the lock, which frames need
            return super().apply(message)

    def _ghost_after(self, message: page.PageMessage) -> RecordedFlight | None:
        """The ghost after a message by which another flight is in progress."""
        ghost = self._ghost
        if ghost is None or isinstance(message, page.FlyMessage):
            return None
        if isinstance(message, page.RewindMessage):
            self.pacer.paused = True
            return self._flown_again(ghost, min(round(message.time / ghost.dt) + 1, self._flight.step))
        again = RecordedFlight(with_whole_rotors(ghost.now, self._mission), self._engine)
        again.hold()
        again.advance()
        return again

    def _continue(self, flight: RecordedFlight) -> None:
        """Let a flight be the one in progress, and its ghost with it."""
        super()._continue(flight)
        self._ghost = self._next_ghost

    def _compare(self, message: page.CompareMessage) -> None:
        check_repeatable(self._engine, "compare")
        with self.turn:
            if message.what == "keep":
                past = self._flight
                again = self._flown_again(past, past.step)
                with self._lock:
                    again.repeat(past, past.step, pending=True)  # what was flown meanwhile
                    self._ghost, self._begun = again, self._begun + 1
            elif message.what == "end":
                self._ghost = None
            elif self._ghost is not None:
                with self._lock:
                    for one in (self._flight, self._ghost):
                        hands_off(one)
                    self._next_ghost = self._flight
                    self._continue(self._ghost)
                    self._swaps += 1

    # displayed values

    def frame(self) -> bytes:
        """The latest frame, and that of the ghost after it."""
        with self._lock:
            own, ghost = super().frame(), self._ghost
            return own if ghost is None else own + self._frames.frame(self._frames.values(*ghost.moment))

    @property
    def scene(self) -> FlightScene:
        """The scene with the present parameters, and the ghost's."""
        own, ghost = super().scene, self._ghost
        if ghost is None:
            return own
        seen = scene_at(self._frames.scene, ghost.now, self._mission)
        parts = {name: seen[name] for name in ("mission", "controller", "parameters")}
        return cast("FlightScene", {**own, "ghost": {**parts, "begun": self._begun, "swaps": self._swaps}})

    def status(self) -> FlightStatus:
        """The state of the flight in words, and how its ghost has ended."""
        own, ghost = super().status(), self._ghost
        return own if ghost is None else cast("FlightStatus", {**own, "ghost": str(ghost.ending or "")})
