"""The server of the live page: files over HTTP and a WebSocket at /ws, on one port of this machine.

The flight goes on in a thread of its own and never waits for a page. A page that disconnects releases the beam.
"""

from __future__ import annotations

import asyncio
import io
import logging
import os
import socket
import sys
import threading
import webbrowser
from collections.abc import Callable, Mapping
from http import HTTPStatus
from typing import Self

from tandemlift.core.errors import extra

with extra("live", "the live page"):
    import websockets  # noqa: F401  (first, so that the error names it)
    from websockets.asyncio.server import Server as SocketServer
    from websockets.asyncio.server import ServerConnection, serve
    from websockets.datastructures import Headers
    from websockets.exceptions import ConnectionClosed
    from websockets.http11 import Request, Response

from tandemlift.apps.live.access import HOST, PORT, AccessControl, RequestHead, listen
from tandemlift.apps.live.dispatch import Dispatcher
from tandemlift.apps.live.page_files import media_type_of
from tandemlift.apps.live.session.frames import RATE, STATUS_EVERY
from tandemlift.apps.live.session.page_messages import MAX_SIZE
from tandemlift.apps.live.session.server_messages import SceneMessage
from tandemlift.apps.live.session.session import Session
from tandemlift.apps.live.viewers import FAREWELL, Viewer, Viewers, dismiss

MAX_VIEWERS = 16
DISMISSED = 5.0  # s, for which a page that was disconnected for flooding keeps its place
SEND_BUFFER = 16_384  # bytes that the system may hold back for a page; more would be outdated when it arrives

strangers = logging.getLogger(f"{__name__}.sockets")  # invalid requests; logged only where a handler is attached
strangers.addHandler(logging.NullHandler())
strangers.propagate = False


class PageServer:
    """Serves a page, and a flight if there is one.

    Args:
        files: content by path, as `page_files` gives it.
        flight: the live flight; None to serve files only.
        host: to bind to; if it is not this machine's own, the address holds a random token.
        port: to bind to, 0 for any that is free.
    """

    def __init__(
        self, files: Mapping[str, bytes], flight: Session | None = None, host: str = HOST, port: int = PORT
    ) -> None:
        self._files, self._flight, self._host, self._port = files, flight, host, port
        self.viewers = Viewers()
        self._dispatcher = Dispatcher(flight, self.viewers) if flight else None
        self._watched = asyncio.Event()  # set once there is a viewer
        self._generation = self._dismissed = 0
        self._frame = b""  # the last one
        self._access: AccessControl
        self._sockets: SocketServer

    @property
    def address(self) -> str:
        """The address to open in a browser, once the server listens."""
        return self._access.address

    async def __aenter__(self) -> Self:
        """Listen, and begin the flight.

        Raises:
            InputError: it cannot listen there.
        """
        listening = listen(self._host, self._port)
        self._access = AccessControl(self._host, listening.getsockname()[1])
        self._sockets = await serve(
            self._serve_viewer,
            sock=listening,
            process_request=self._respond,
            process_response=self._protect,
            server_header=None,
            compression=None,
            max_size=MAX_SIZE,
            ping_interval=3.0,
            ping_timeout=6.0,
            logger=strangers,
        )
        if self._flight:
            self._generation = self._flight.generation
            await asyncio.to_thread(self._flight.start)
        return self

    async def __aexit__(self, *_: object) -> None:
        """Close all connections, and end the flight."""
        if self._dispatcher:
            self._dispatcher.cancel()
        self._sockets.close()
        try:
            async with asyncio.timeout(FAREWELL):
                await self._sockets.wait_closed()
        except TimeoutError:
            for viewer in self.viewers:
                viewer.connection.transport.abort()
        if self._flight:
            await asyncio.to_thread(self._flight.stop)

    async def broadcast(self) -> None:
        """Send frames and the status to all viewers until cancelled."""
        clock, tick = asyncio.get_running_loop().time, 0
        due = clock()
        while True:
            if self._flight is None or not self.viewers:
                self._watched.clear()
                await self._watched.wait()
                due = clock()
            self._broadcast_once(tick)
            tick += 1
            due = max(due + 1.0 / RATE, clock() - 1.0 / RATE)
            await asyncio.sleep(due - clock())

    def _broadcast_once(self, tick: int) -> None:
        flight = self._flight
        assert flight is not None
        if flight.generation != self._generation:
            self._generation = flight.generation
            self._let_go()
            self.viewers.send(SceneMessage(type="scene", **flight.scene))
        frame, before = flight.frame(), self._frame
        if frame != before or tick % STATUS_EVERY == 0:  # a flight that stands still is told rarely
            self.viewers.send_frame(frame)
        self._frame = frame
        if self.viewers.is_hung():
            self._let_go()
        if tick % STATUS_EVERY == 0:
            self.viewers.send_status(flight.status())

    def _let_go(self) -> None:
        assert self._flight is not None
        self.viewers.let_go()
        self._flight.release()

    # HTTP

    def _respond(self, connection: ServerConnection, request: Request) -> Response | None:
        """The response to a request; None to go on with the handshake of a WebSocket."""
        head = RequestHead.of(request)
        refusal = self._access.refusal(head)
        if refusal:
            return connection.respond(*refusal)
        if head.socket and self._flight:
            full = len(self.viewers) + self._dismissed >= MAX_VIEWERS
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "too many viewers\n") if full else None
        if head.path not in self._files:
            return connection.respond(HTTPStatus.NOT_FOUND, "not found\n")
        return _file(head.path, self._files[head.path], self._access.cookie(head))

    def _protect(self, connection: ServerConnection, request: Request, response: Response) -> None:
        """Put the security headers into a response."""
        for name, value in self._access.headers(RequestHead.of(request)).items():
            response.headers[name] = value

    # WebSocket

    async def _serve_viewer(self, connection: ServerConnection) -> None:
        """Serve a viewer until it disconnects."""
        assert self._flight is not None
        assert self._dispatcher is not None
        connection.transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        viewer = Viewer(connection)
        viewer.send(SceneMessage(type="scene", **self._flight.scene))
        for frame in self._flight.past():
            viewer.send(frame)
        self.viewers.join(viewer)
        self.viewers.send_status(self._flight.status())
        self._watched.set()
        flooding = False
        try:
            async for text in connection:
                with viewer.working():
                    self._dispatcher.receive(viewer, text)
                if flooding := viewer.is_flooding():
                    break
                await asyncio.sleep(
                    self.viewers.rest(viewer)
                )  # also when 0: messages that wait do not delay other pages
        except ConnectionClosed:
            pass
        finally:
            if self.viewers.leave(viewer):
                self._let_go()
        if flooding:
            self._dismissed += 1
            asyncio.get_running_loop().call_later(DISMISSED, self._forget_dismissed)
            await dismiss(connection)

    def _forget_dismissed(self) -> None:
        self._dismissed -= 1


async def serve_until_stopped(server: PageServer, opened: Callable[[str], None]) -> None:
    """Serve until cancelled; `opened` is called with the address once pages can be opened."""
    async with server:
        opened(server.address)
        await server.broadcast()


def serve_until_interrupt(server: PageServer, what: str, say: Callable[..., None], *, browser: bool) -> None:
    """Serve a page until Ctrl-C; `say` what it shows and its address, and optionally open it in a browser."""

    def opened(address: str) -> None:
        say(f"{what}: {address}")
        say("  Ctrl-C ends it")
        sys.stdout.flush()
        if "token=" in address:
            say(qr_code(address), nl=False)
            print("warning: any machine that can reach this one and knows this address can push", file=sys.stderr)
        if browser:
            open_in_browser(address)

    try:
        asyncio.run(serve_until_stopped(server, opened))
    except KeyboardInterrupt:
        say("stopped")


def open_in_browser(address: str) -> None:
    """Open an address in a graphical browser, if one can open; a text browser would take over the terminal."""
    if sys.platform in ("win32", "darwin") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()


def qr_code(address: str) -> str:
    """The QR code of an address as text for a terminal."""
    with extra("live", "the QR code of an address"):
        import segno
    text = io.StringIO()
    segno.make(address, error="l", micro=False).terminal(text, compact=True)
    return text.getvalue()


def _file(path: str, content: bytes, cookie: str | None) -> Response:
    """The response with a file, and a cookie if there is one to set."""
    headers = Headers(
        [("Content-Type", media_type_of(path)), ("Content-Length", str(len(content))), ("Connection", "close")]
    )
    if cookie:
        headers["Set-Cookie"] = cookie
    return Response(HTTPStatus.OK.value, HTTPStatus.OK.phrase, headers, content)
