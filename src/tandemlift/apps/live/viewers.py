"""The connected pages, one of which may hold the beam. A slow page misses frames, and does not delay others."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from time import thread_time
from typing import Any, Literal

from pydantic_core import to_json
from websockets.asyncio.server import ServerConnection, broadcast

from tandemlift.apps.live.session import page_messages as page
from tandemlift.apps.live.session.frames import ECHO, ECHO_TIME
from tandemlift.apps.live.session.page_messages import SILENT, Refusal
from tandemlift.apps.live.session.server_messages import FlightStatus, RefusedMessage, TurnStatus

HAND_TIMEOUT = 30.0  # s without a message, after which the hand goes on to a page that waits


class Turns:
    """The queue of pages that take turns, of which the first has the hand since a time [s].

    While nobody has it, each page may use the flight. A page that has it and does nothing passes it on.
    """

    def __init__(self) -> None:
        self._queue: list[Viewer] = []
        self._since = 0.0

    @property
    def player(self) -> Viewer | None:
        """Who has the hand."""
        return self._queue[0] if self._queue else None

    @property
    def numbers(self) -> list[int]:
        """The numbers of the players, in the order of their turns."""
        return [player.number for player in self._queue]

    def take(self, player: Viewer, what: Literal["ask", "give"], now: float) -> None:
        """Let a player queue up (at most once), or give the hand or the place in the queue away."""
        before = self.player
        if what == "give":
            self._queue = [other for other in self._queue if other is not player]
        elif player not in self._queue:
            self._queue.append(player)
        if self.player is not before:
            self._since = now

    def pass_on(self, now: float) -> None:
        """Pass the hand on if its player does nothing while others wait."""
        if len(self._queue) > 1 and now - max(self._since, self._queue[0].last_message) > HAND_TIMEOUT:
            self.take(self._queue[0], "give", now)


LAG_BYTES = 4_096  # bytes not yet taken by the network, beyond which a viewer is behind
CUT_OFF_BYTES = 1_000_000  # bytes, beyond which it is cut off: it reads nothing at all
MAX_MESSAGES = 2_000  # a second; a page sends about a hundred
FAREWELL = 1.0  # s, for pages to close their connections
MAX_REFUSALS = 20  # that are reported in a second
REFUSAL_COST = 10  # messages that a refused one counts as: a page is refused at the rate of its pictures, at most
MAX_WORK, ALL_WORK = 0.05, 0.2  # of a processor, by a page, by all; the messages of a page take a hundredth


def text_of(what: Mapping[str, Any]) -> str:
    """A JSON text; numbers that JSON does not have become null."""
    return to_json(what, inf_nan_mode="null").decode()


class Viewer:
    """One page's connection.

    Attributes:
        number: by which all pages know it, from 1 on; 0 before it joins.
        dropped: frames that it was too slow for.
        last_message: when its last message came, by the monotonic clock [s].
        last_echo: when its last echo was sent, likewise.
        last_grab: `seq` of its last grab, 0 before there is one.
        work: time of the processor that its messages took lately [s]; passes at the rate of its share.
    """

    def __init__(self, connection: ServerConnection) -> None:
        self.connection, self.number = connection, 0
        self.dropped, self.last_message = 0, time.monotonic()
        self.last_grab = 0
        self._second, self._messages, self._refusals = 0, 0, 0
        self.work = 0.0
        self._echoing, self.last_echo = False, 0.0

    @property
    def behind(self) -> bool:
        """Whether earlier data still waits to be sent."""
        return self.connection.transport.get_write_buffer_size() > LAG_BYTES

    def send_frame(self, frame: bytes) -> None:
        """Send a frame, unless it is behind."""
        if self.behind:
            self.dropped += 1
        else:
            broadcast([self.connection], frame)

    def echo(self, frame: Callable[[], bytes]) -> None:
        """Send a frame soon, which shows the effect of a move; the next one for all may be 17 ms away."""
        if not self._echoing:
            self._echoing = True
            asyncio.get_running_loop().call_later(ECHO, self._send_echo, frame)

    def _send_echo(self, frame: Callable[[], bytes]) -> None:
        self._echoing, self.last_echo = False, time.monotonic()
        self.send_frame(frame())

    def send(self, what: Mapping[str, Any] | str | bytes) -> None:
        """Send a message, or a frame that it must not miss, or cut off a viewer that does not read."""
        if self.connection.transport.get_write_buffer_size() > CUT_OFF_BYTES:
            self.connection.transport.abort()
        else:
            broadcast([self.connection], what if isinstance(what, str | bytes) else text_of(what))

    def refuse(self, refusal: Refusal) -> None:
        """Send the reason of a refused message; a few times a second at most."""
        self._begin_second()
        self._messages += REFUSAL_COST - 1
        self._refusals += 1
        if self._refusals <= MAX_REFUSALS:
            self.send(RefusedMessage(type="refused", what=refusal.what, reason=str(refusal)))

    def is_flooding(self) -> bool:
        """Count a message; whether there are too many in this second."""
        self._begin_second()
        self.last_message = time.monotonic()
        self._messages += 1
        return self._messages > MAX_MESSAGES

    @contextmanager
    def working(self) -> Iterator[None]:
        """Count the processor's time that a message takes; waiting for the flight is none."""
        began = thread_time()
        try:
            yield
        finally:
            self.work += thread_time() - began

    def _begin_second(self) -> None:
        now = int(time.monotonic())
        if now != self._second:
            self._second, self._messages, self._refusals = now, 0, 0


class Viewers:
    """All viewers.

    Attributes:
        holder: who holds the beam, or None; by a spring (`pulls`), by a force (`pushes`), or by both.
        turns: who has the hand, and who waits for it.
    """

    def __init__(self) -> None:
        self._all, self._joined, self._rested = set[Viewer](), 0, 0.0
        self.turns = Turns()
        self.holder: Viewer | None = None
        self.pulls = self.pushes = False

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[Viewer]:
        return iter(tuple(self._all))

    def join(self, viewer: Viewer) -> None:
        """Add a viewer, which gets the next number."""
        self._joined += 1
        viewer.number = self._joined
        self._all.add(viewer)

    def leave(self, viewer: Viewer) -> bool:
        """Remove a viewer; returns whether the beam is free afterwards."""
        self._all.discard(viewer)
        self.turns.take(viewer, "give", time.monotonic())
        held = self.holder is viewer
        if held:
            self.let_go()
        return held or self.holder is None

    def rest(self, viewer: Viewer) -> float:
        """The wait until a viewer's next message is read [s], so that it, and all together, leave time for the flight.

        A share of a second may be used at once. Where all together use more than theirs, each gets an equal part of it.
        """
        share, now = MAX_WORK, time.monotonic()
        if sum(one.work for one in self) > ALL_WORK:
            share = min(share, ALL_WORK / len(self))
        for one in self:
            one.work = max(one.work - share * (now - self._rested), 0.0)
        self._rested = now
        return max(viewer.work / share - 1.0, 0.0)

    def let_go(self) -> None:
        """Release the beam."""
        self.holder, self.pulls, self.pushes = None, False, False

    def is_hung(self) -> bool:
        """Whether the holder has been silent for too long; the page pings while it holds the beam."""
        return self.holder is not None and time.monotonic() - self.holder.last_message > SILENT

    def send_frame(self, frame: bytes) -> None:
        """Send a frame to all who can take it."""
        now = time.monotonic()
        for viewer in self:
            if now - viewer.last_echo > ECHO_TIME:
                viewer.send_frame(frame)

    def send(self, what: Mapping[str, Any]) -> None:
        """Send a message to all."""
        text = text_of(what)
        for viewer in self:
            viewer.send(text)

    def send_status(self, status: FlightStatus) -> None:
        """Send the status to all, each with who holds the beam as it sees it, and its last grab that this is after."""
        self.turns.pass_on(time.monotonic())
        others: Literal["none", "other"] = "none" if self.holder is None else "other"
        for viewer in self:
            holder: Literal["you", "other", "none"] = "you" if viewer is self.holder else others
            turns = TurnStatus(number=viewer.number, queue=self.turns.numbers)
            seen = {**status, "viewers": len(self), "holder": holder, "last_grab": viewer.last_grab, "turns": turns}
            viewer.send({"type": "status", **seen})

    def admits(self, viewer: Viewer, message: page.PageMessage) -> bool:
        """Whether a message is passed to the flight: all of the holder's, of others those that do not touch the beam.

        Raises:
            Refusal: another viewer has the hand; or the message needs the beam, and another viewer holds it.
        """
        if isinstance(message, (page.MoveMessage, page.ReleaseMessage)) or (
            isinstance(message, page.ForceMessage) and not any(message.force)
        ):
            return self.holder is viewer
        if self.turns.player not in (None, viewer) and not isinstance(message, page.SaveMessage):
            raise Refusal(
                message.type, f"page {self.turns.numbers[0]} has the hand: ask for it, and wait for your turn"
            )
        if isinstance(message, (page.GrabMessage, page.ForceMessage)) and self.holder not in (None, viewer):
            raise Refusal(message.type, "another page holds the beam: wait until it is released")
        return True

    def take_turn(self, viewer: Viewer, message: page.TurnMessage) -> bool:
        """Let a viewer ask for the hand or give it on; returns whether the beam is to be released."""
        self.turns.take(viewer, message.what, time.monotonic())
        return self.holder is not None and self.holder is not self.turns.player

    def note(self, viewer: Viewer, message: page.PageMessage) -> None:
        """Update the holder of the beam after an applied message."""
        if isinstance(message, page.ReleaseMessage):
            self.let_go()
        elif isinstance(message, page.GrabMessage):
            self.holder, self.pulls = viewer, True
        elif isinstance(message, page.ForceMessage):
            self.pushes = any(message.force) and not message.duration  # a tap ends by itself
            self.holder = viewer if self.pulls or self.pushes else None


async def dismiss(connection: ServerConnection) -> None:
    """Close the connection of a page that sends too much, which may not read the reason."""
    try:
        async with asyncio.timeout(FAREWELL):
            await connection.close(1008, "too many messages, or too many that are refused")
    except TimeoutError:
        connection.transport.abort()
