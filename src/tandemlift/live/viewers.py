"""Those who watch, one of whom may hold the beam. A viewer that is behind misses frames; nobody waits for it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from pydantic_core import to_json
from websockets.asyncio.server import ServerConnection, broadcast

from tandemlift.live.messages import Force, Grab, Message, Move, Refusal, Release

BEHIND = 4_096  # bytes not yet taken by the network, beyond which a viewer is behind
LOST = 1_000_000  # bytes, beyond which it is cut off: it reads nothing at all
SILENT = 2.0  # s, after which a page that holds the beam is taken for hung
MOST_MESSAGES = 2_000  # a second; a page sends about a hundred
FAREWELL = 1.0  # s, for pages to say good-bye
MOST_REFUSALS = 20  # a second that are told
ECHO = 0.003  # s, in which the flight has heeded a hand
FRESH = 0.012  # s, in which who was shown a frame of its own needs no other


def text_of(what: Mapping[str, Any]) -> str:
    """A JSON text; numbers that JSON does not have become null."""
    return to_json(what, inf_nan_mode="null").decode()


class Viewer:
    """One page's connection.

    Attributes:
        dropped: frames that it was too slow for.
        heard: when it said something last, by the monotonic clock [s].
        echoed: when it was shown a frame of its own last, likewise.
    """

    def __init__(self, connection: ServerConnection) -> None:
        self.connection = connection
        self.dropped, self.heard = 0, time.monotonic()
        self._second, self._messages, self._refusals = 0, 0, 0
        self._echoing, self.echoed = False, 0.0

    @property
    def behind(self) -> bool:
        """Whether what it was sent before is still on its way out of this process."""
        return self.connection.transport.get_write_buffer_size() > BEHIND

    def show(self, frame: bytes) -> None:
        """Send a frame, unless it is behind."""
        if self.behind:
            self.dropped += 1
        else:
            broadcast([self.connection], frame)

    def echo(self, frame: Callable[[], bytes]) -> None:
        """Show what came of its hand soon; the next frame for all may be a sixtieth of a second away."""
        if not self._echoing:
            self._echoing = True
            asyncio.get_running_loop().call_later(ECHO, self._show_echo, frame)

    def _show_echo(self, frame: Callable[[], bytes]) -> None:
        self._echoing, self.echoed = False, time.monotonic()
        self.show(frame())

    def tell(self, what: Mapping[str, Any] | str) -> None:
        """Send a text, or cut off a viewer that does not read."""
        if self.connection.transport.get_write_buffer_size() > LOST:
            self.connection.transport.abort()
        else:
            broadcast([self.connection], what if isinstance(what, str) else text_of(what))

    def refuse(self, refusal: Refusal) -> None:
        """Say why something is not done; not more often in a second than anybody reads."""
        self._begin_second()
        self._refusals += 1
        if self._refusals <= MOST_REFUSALS and not self.behind:
            self.tell({"type": "refused", "what": refusal.what, "reason": str(refusal)})

    def is_flooding(self) -> bool:
        """Count a message; whether there are more of them in a second than a page sends."""
        self._begin_second()
        self.heard = time.monotonic()
        self._messages += 1
        return self._messages > MOST_MESSAGES

    def _begin_second(self) -> None:
        now = int(time.monotonic())
        if now != self._second:
            self._second, self._messages, self._refusals = now, 0, 0


class Viewers:
    """All viewers.

    Attributes:
        holder: who holds the beam, or None; by a spring (`pulls`), by a force (`pushes`), or by both.
    """

    def __init__(self) -> None:
        self._all: set[Viewer] = set()
        self.holder: Viewer | None = None
        self.pulls = self.pushes = False

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[Viewer]:
        return iter(tuple(self._all))

    def join(self, viewer: Viewer) -> None:
        """Another one watches."""
        self._all.add(viewer)

    def leave(self, viewer: Viewer) -> bool:
        """One is gone; whether nobody holds the beam now."""
        self._all.discard(viewer)
        held = self.holder is viewer
        if held:
            self.let_go()
        return held or self.holder is None

    def let_go(self) -> None:
        """Nobody holds the beam any more."""
        self.holder, self.pulls, self.pushes = None, False, False

    def is_hung(self) -> bool:
        """Whether who holds the beam has been silent for too long: pages of a living browser ping."""
        return self.holder is not None and time.monotonic() - self.holder.heard > SILENT

    def show(self, frame: bytes) -> None:
        """Send a frame to all who can take it."""
        now = time.monotonic()
        for viewer in self:
            if now - viewer.echoed > FRESH:
                viewer.show(frame)

    def tell(self, what: Mapping[str, Any]) -> None:
        """Send a text to all."""
        text = text_of(what)
        for viewer in self:
            viewer.tell(text)

    def tell_status(self, status: Mapping[str, Any]) -> None:
        """Send the status to all, each with who holds the beam as it sees it."""
        common = {"type": "status", **status, "viewers": len(self)}
        others = "none" if self.holder is None else "other"
        text = text_of({**common, "holder": others})
        for viewer in self:
            viewer.tell(text_of({**common, "holder": "you"}) if viewer is self.holder else text)

    def admits(self, viewer: Viewer, message: Message) -> bool:
        """Whether a message may go on to the flight: of the holder all, of others what does not touch the beam.

        Raises:
            Refusal: it wants the beam, and somebody else holds it.
        """
        if isinstance(message, (Move, Release)) or (isinstance(message, Force) and not any(message.force)):
            return self.holder is viewer
        if isinstance(message, (Grab, Force)) and self.holder not in (None, viewer):
            raise Refusal(message.type, "somebody else holds the beam: wait until they let go")
        return True

    def note(self, viewer: Viewer, message: Message) -> None:
        """Who holds the beam after a message that was heeded."""
        if isinstance(message, Release):
            self.let_go()
        elif isinstance(message, Grab):
            self.holder, self.pulls = viewer, True
        elif isinstance(message, Force):
            self.pushes = any(message.force)
            self.holder = viewer if self.pulls or self.pushes else None


async def dismiss(connection: ServerConnection) -> None:
    """Close the connection of a page that sends too much; it may not even read why."""
    try:
        async with asyncio.timeout(FAREWELL):
            await connection.close(1008, "too many messages")
    except TimeoutError:
        connection.transport.abort()
