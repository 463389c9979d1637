"""Handles a page's messages: reads them, checks who holds the beam, applies them to the flight, and answers."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence
from time import thread_time
from typing import TYPE_CHECKING

from tandemlift.apps.live.session import page_messages as page
from tandemlift.apps.live.session.page_messages import Refusal
from tandemlift.apps.live.session.server_messages import Answer, PongMessage
from tandemlift.apps.live.viewers import Viewer, Viewers
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.apps.live.session.session import Session

MAX_WAITING = 16  # changes that wait for their turn
SLOW = (
    page.SetMessage,
    page.RestoreMessage,
    page.TareMessage,
    page.KillMessage,
    page.ResetMessage,
    page.RewindMessage,
    page.FlyMessage,
    page.CompareMessage,
    page.SaveMessage,
)  # may compile or write

log = logging.getLogger(__name__)


class Dispatcher:
    """Passes messages of viewers to a flight, and its answers to viewers.

    Args:
        flight: the flight.
        viewers: all who watch, and who of them holds the beam.
    """

    def __init__(self, flight: Session, viewers: Viewers) -> None:
        self._flight, self._viewers = flight, viewers
        self._changing, self._saving = asyncio.Lock(), asyncio.Lock()
        self._tasks = set[asyncio.Task[None]]()

    def receive(self, viewer: Viewer, text: str | bytes) -> None:
        """Handle a text of a viewer, or send the reason of its refusal."""
        try:
            message = page.read_message(text)
            if isinstance(message, page.GrabMessage):
                viewer.last_grab = message.seq
            if isinstance(message, page.PingMessage):
                viewer.send(PongMessage(type="pong", t=message.t))
            elif isinstance(message, page.TurnMessage):
                if self._viewers.take_turn(viewer, message):
                    self._viewers.let_go()
                    self._flight.release()
                self._viewers.send_status(self._flight.status())
            elif not self._viewers.admits(viewer, message):
                pass
            elif isinstance(message, SLOW):
                self._start_change(viewer, message)
            else:
                self._answer(viewer, self._apply(message))
                self._viewers.note(viewer, message)
                if isinstance(message, page.MoveMessage):
                    viewer.echo(self._flight.frame)
        except Refusal as refusal:
            viewer.refuse(refusal)

    def cancel(self) -> None:
        """Give up the changes that wait."""
        for task in self._tasks:
            task.cancel()

    def _apply(self, message: page.PageMessage) -> Sequence[Answer]:
        """The answer of the flight.

        Raises:
            Refusal: it cannot apply the message.
        """
        try:
            return self._flight.apply(message)
        except InputError as error:
            raise Refusal(page.subject_of(message), str(error)) from error
        except Exception as error:
            log.exception("%s failed", page.subject_of(message))
            raise Refusal(page.subject_of(message), f"an error in tandemlift: {error!r}"[:300]) from error

    def _answer(self, viewer: Viewer, answers: Sequence[Answer]) -> None:
        for answer in answers:
            if answer["type"] in ("changed", "scene"):
                self._viewers.send(answer)
            elif answer["type"] == "refused":
                viewer.refuse(Refusal(answer["what"], answer["reason"]))
            else:
                viewer.send(answer)

    def _start_change(self, viewer: Viewer, message: page.PageMessage) -> None:
        """Make a change that may take long in another thread, one after another; the hand does not wait for it."""
        if len(self._tasks) >= MAX_WAITING:
            raise Refusal(page.subject_of(message), f"{MAX_WAITING} changes are waiting already")
        task = asyncio.create_task(self._change(viewer, message))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _change(self, viewer: Viewer, message: page.PageMessage) -> None:
        async with self._saving if isinstance(message, page.SaveMessage) else self._changing:
            try:
                self._answer(viewer, await asyncio.to_thread(self._apply_or_count, viewer, message))
            except Refusal as refusal:
                viewer.refuse(refusal)

    def _apply_or_count(self, viewer: Viewer, message: page.PageMessage) -> Sequence[Answer]:
        """The answer of the flight; the work of a refusal is the viewer's, as of a file that is no mission."""
        began = thread_time()
        try:
            return self._apply(message)
        except Refusal:
            viewer.work += thread_time() - began
            raise
