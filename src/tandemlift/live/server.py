"""The server of the live page: files over HTTP and a WebSocket at /ws, on one port of this machine.

The flight goes on in a thread of its own and never waits for a page. A page that goes away lets go of the beam.
"""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Callable, Mapping
from http import HTTPStatus
from typing import Any, Protocol, Self

from websockets.asyncio.server import Server as Sockets
from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from tandemlift.common.errors import InputError
from tandemlift.live.frames import RATE
from tandemlift.live.guard import HOST, PORT, Asked, Guard, listen
from tandemlift.live.messages import (
    MAX_SIZE,
    Kill,
    Message,
    Move,
    Ping,
    Refusal,
    Reset,
    Restore,
    Save,
    Set,
    Tare,
    about,
    read_message,
)
from tandemlift.live.pages import kind_of
from tandemlift.live.viewers import FAREWELL, Viewer, Viewers, dismiss

STATUS_EVERY = RATE // 4  # frames
MAX_VIEWERS = 16
MAX_WAITING = 16  # changes that are yet to be made
SEND_BUFFER = 16_384  # bytes that the system may hold back for a page; more would be old news
SLOW = (Set, Restore, Tare, Kill, Reset, Save)  # may compile or write

Answer = dict[str, Any] | list[dict[str, Any]] | None  # one text, several, or none

log = logging.getLogger(__name__)
quiet = logging.getLogger(f"{__name__}.sockets")  # of what strangers send; heard only by those who ask
quiet.addHandler(logging.NullHandler())
quiet.propagate = False


class LiveFlight(Protocol):
    """A flight that goes on while people watch; its methods may be called from any thread.

    There is a scene, a frame and a status from the beginning, also while it is still being prepared.

    Attributes:
        generation: grows with every reset, after which `scene` is a new one.
    """

    generation: int

    @property
    def scene(self) -> dict[str, Any]:
        """What a viewer must know, as `scene.scene_of` makes it."""

    def start(self) -> None:
        """Begin to fly, in a thread of its own, where it is prepared first."""

    def stop(self) -> None:
        """End that thread, at once."""

    def frame(self) -> bytes:
        """The latest state, as the scene's `fields` say."""

    def status(self) -> dict[str, Any]:
        """Phase, alarm, pace and so on, for people."""

    def apply(self, message: Message, seq: int) -> Answer:
        """Heed a message; what to answer to its sender, or to all if it is of type "changed".

        Raises:
            InputError: it cannot be done; the text says why.
        """

    def release(self) -> None:
        """Nobody holds the beam any more."""


class Server:
    """Serves a page, and a flight if there is one.

    Args:
        files: content by path, as `page_files` gives it.
        flight: what is flown live; None to serve files only.
        host: to bind to; if it is not this machine's own, the address holds a random token.
        port: to bind to, 0 for any that is free.
    """

    def __init__(
        self, files: Mapping[str, bytes], flight: LiveFlight | None = None, host: str = HOST, port: int = PORT
    ) -> None:
        self._files, self._flight, self._host, self._port = files, flight, host, port
        self.viewers = Viewers()
        self._somebody = asyncio.Event()
        self._turns, self._tasks = (asyncio.Lock(), asyncio.Lock()), set[asyncio.Task[None]]()
        self._generation = 0
        self._guard: Guard
        self._sockets: Sockets

    @property
    def address(self) -> str:
        """To open in a browser, once it serves."""
        return self._guard.address

    async def __aenter__(self) -> Self:
        """Listen, and begin the flight.

        Raises:
            InputError: it cannot listen there.
        """
        listening = listen(self._host, self._port)
        self._guard = Guard(self._host, listening.getsockname()[1])
        self._sockets = await serve(
            self._attend,
            sock=listening,
            process_request=self._respond,
            process_response=self._protect,
            server_header=None,
            compression=None,
            max_size=MAX_SIZE,
            ping_interval=3.0,
            ping_timeout=6.0,
            logger=quiet,
        )
        if self._flight:
            self._generation = self._flight.generation
            await asyncio.to_thread(self._flight.start)
        return self

    async def __aexit__(self, *_: object) -> None:
        """Say good-bye, and end the flight."""
        for task in self._tasks:
            task.cancel()
        self._sockets.close()
        try:
            async with asyncio.timeout(FAREWELL):
                await self._sockets.wait_closed()
        except TimeoutError:
            for viewer in self.viewers:
                viewer.connection.transport.abort()
        if self._flight:
            await asyncio.to_thread(self._flight.stop)

    async def show(self) -> None:
        """Send frames and the status to all viewers until cancelled."""
        clock, tick = asyncio.get_running_loop().time, 0
        due = clock()
        while True:
            if self._flight is None or not self.viewers:
                self._somebody.clear()
                await self._somebody.wait()
                due = clock()
            self._show_once(tick)
            tick += 1
            due = max(due + 1.0 / RATE, clock() - 1.0 / RATE)
            await asyncio.sleep(due - clock())

    def _show_once(self, tick: int) -> None:
        flight = self._flight
        assert flight is not None
        if flight.generation != self._generation:
            self._generation = flight.generation
            self._let_go()
            self.viewers.tell({"type": "scene", **flight.scene})
        self.viewers.show(flight.frame())
        if self.viewers.is_hung():
            self._let_go()
        if tick % STATUS_EVERY == 0:
            self.viewers.tell_status(flight.status())

    def _let_go(self) -> None:
        assert self._flight is not None
        self.viewers.let_go()
        self._flight.release()

    # HTTP

    def _respond(self, connection: ServerConnection, request: Request) -> Response | None:
        """The answer to a request; None to go on with the handshake of a WebSocket."""
        asked = Asked.of(request)
        refusal = self._guard.refusal(asked)
        if refusal:
            return connection.respond(*refusal)
        if asked.socket and self._flight:
            full = len(self.viewers) >= MAX_VIEWERS
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "too many viewers\n") if full else None
        if asked.path not in self._files:
            return connection.respond(HTTPStatus.NOT_FOUND, "not found\n")
        return _file(asked.path, self._files[asked.path], self._guard.cookie(asked))

    def _protect(self, connection: ServerConnection, request: Request, response: Response) -> None:
        """Put the headers that keep others out into an answer."""
        for name, value in self._guard.headers(Asked.of(request)).items():
            response.headers[name] = value

    # WebSocket

    async def _attend(self, connection: ServerConnection) -> None:
        """Serve a viewer until it is gone."""
        assert self._flight is not None
        connection.transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        viewer = Viewer(connection)
        viewer.tell({"type": "scene", **self._flight.scene})
        self.viewers.join(viewer)
        self.viewers.tell_status(self._flight.status())
        self._somebody.set()
        flooding = False
        try:
            async for text in connection:
                self._hear(viewer, text)
                if flooding := viewer.is_flooding():
                    break
        except ConnectionClosed:
            pass
        finally:
            if self.viewers.leave(viewer):
                self._let_go()
        if flooding:
            await dismiss(connection)

    def _hear(self, viewer: Viewer, text: str | bytes) -> None:
        """Heed a text of a viewer, or say why not."""
        try:
            message = read_message(text)
            if isinstance(message, Ping):
                viewer.tell({"type": "pong", "t": message.t})
            elif isinstance(message, SLOW):
                self._start_change(viewer, message)
            elif self.viewers.admits(viewer, message):
                self._answer(viewer, self._applied(message))
                self.viewers.note(viewer, message)
                if isinstance(message, Move) and self._flight:
                    viewer.echo(self._flight.frame)
        except Refusal as refusal:
            viewer.refuse(refusal)

    def _applied(self, message: Message) -> Answer:
        """What the flight answers.

        Raises:
            Refusal: it cannot heed the message.
        """
        assert self._flight is not None
        try:
            return self._flight.apply(message, message.seq)
        except InputError as error:
            raise Refusal(about(message), str(error)) from error
        except Exception as error:
            log.exception("%s failed", about(message))
            raise Refusal(about(message), f"an error in tandemlift: {error!r}"[:300]) from error

    def _answer(self, viewer: Viewer, answer: Answer) -> None:
        for text in [answer] if isinstance(answer, dict) else answer or ():
            if text["type"] in ("changed", "scene"):
                self.viewers.tell(text)
            else:
                viewer.tell(text)

    def _start_change(self, viewer: Viewer, message: Message) -> None:
        """Make a change that may take long in another thread, one after another; the hand does not wait for it."""
        if len(self._tasks) >= MAX_WAITING:
            raise Refusal(about(message), f"{MAX_WAITING} changes are still to be made")
        task = asyncio.create_task(self._change(viewer, message))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _change(self, viewer: Viewer, message: Message) -> None:
        async with self._turns[isinstance(message, Save)]:  # nothing waits for what is saved
            try:
                self._answer(viewer, await asyncio.to_thread(self._applied, message))
            except Refusal as refusal:
                viewer.refuse(refusal)


async def serve_until_stopped(server: Server, opened: Callable[[str], None]) -> None:
    """Serve until cancelled; `opened` is told the address once there is something to see."""
    async with server:
        opened(server.address)
        await server.show()


def _file(path: str, content: bytes, cookie: str | None) -> Response:
    """The answer that gives a file, and a cookie if there is one to set."""
    headers = Headers([("Content-Type", kind_of(path)), ("Content-Length", str(len(content))), ("Connection", "close")])
    if cookie:
        headers["Set-Cookie"] = cookie
    return Response(HTTPStatus.OK.value, HTTPStatus.OK.phrase, headers, content)
