"""Shared by the tests of the live page: a page, a server in its own thread, raw sockets, well-behaved viewers."""

from __future__ import annotations

import asyncio
import contextlib
import http.client
import json
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any
from urllib.parse import urlsplit

from patience import PATIENCE, joined, until
from websockets.client import ClientProtocol
from websockets.frames import Frame, Opcode
from websockets.protocol import State
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin
from websockets.uri import parse_uri

from tandemlift.apps.live.server import PageServer, serve_until_stopped

PAGE = {
    "index.html": b"""<!doctype html><html><head><meta charset="utf-8"><title>page</title>
<link rel="stylesheet" href="page.css"></head><body><div id="view"></div>
<script type="module" src="page.js"></script></body></html>""",
    "page.js": b'const end = "</script>", comment = "<!--"; export default [end, comment, "\xc3\xa4"];\n',
    "page.css": b'body { margin: 0; content: "</style>" }\n',
}


def put_page(folder):
    """Write a page to a folder, and beside the folder a file that must not be served."""
    folder.mkdir(parents=True)
    for name, content in PAGE.items():
        (folder / name).write_bytes(content)
    (folder.parent / "secret.txt").write_text("secret", "utf-8")
    return folder


class Running:
    """A server that serves until it is stopped."""

    def __init__(self, server: PageServer) -> None:
        self.server = server
        self._ready = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._serve()), name="server", daemon=True)
        self._thread.start()
        until(lambda: self._ready.is_set() or not self._thread.is_alive(), "a server")
        assert self._ready.is_set(), "the server ended before it served"
        self.address = server.address
        self.host = urlsplit(server.address).netloc
        self.port = int(self.host.rpartition(":")[2])

    async def _serve(self) -> None:
        self._loop, self._stop = asyncio.get_running_loop(), asyncio.Event()
        serving = asyncio.create_task(serve_until_stopped(self.server, lambda _: self._ready.set()))
        stopping = asyncio.create_task(self._stop.wait())
        await asyncio.wait([serving, stopping], return_when=asyncio.FIRST_COMPLETED)
        serving.cancel()
        stopping.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await serving

    def stop(self) -> None:
        self.soon(self._stop.set)
        joined(self._thread)

    def soon(self, do: Callable[..., object], *args: object) -> None:
        """Run a function in the server's thread."""
        self._loop.call_soon_threadsafe(do, *args)

    def get(self, path: str = "/", method: str = "GET", **headers: str) -> tuple[int, dict[str, str], bytes]:
        """Status, headers and body of an answer; `Host` is the server's own unless given."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        try:
            connection.putrequest(method, path, skip_host=True)
            for name, value in {"Host": self.host, **headers}.items():
                connection.putheader(name, value)
            connection.endheaders()
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def send(self, request: bytes) -> bytes:
        """The whole answer to the bytes of a request."""
        with socket.create_connection(("127.0.0.1", self.port), PATIENCE) as s:
            s.sendall(request)
            return b"".join(pieces(s))

    @contextlib.contextmanager
    def viewer(self, **headers: str) -> Iterator[Good]:
        """A viewer that follows the protocol."""
        with connect(
            f"ws://127.0.0.1:{self.port}/ws",
            origin=f"http://127.0.0.1:{self.port}",
            additional_headers=headers,
            compression=None,
            max_queue=None,
            open_timeout=PATIENCE,
            close_timeout=PATIENCE,
            ping_timeout=None,
        ) as connection:
            yield Good(connection)

    def raw(self) -> Raw:
        """A viewer that can violate the protocol."""
        return Raw(self.port)


def pieces(of: socket.socket) -> Iterator[bytes]:
    """The bytes from a socket until the other side closes it, which it must."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        of.settimeout(max(0.1, end - time.monotonic()))
        piece = of.recv(65_536)
        if not piece:
            return
        yield piece
    raise TimeoutError(f"the other side still talks after {PATIENCE:g} s")


class Good:
    """A viewer that follows the protocol."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection, self.seq = connection, 0
        self.scene = self.text("scene")

    def say(self, **message: Any) -> None:
        self.seq += 1
        self.connection.send(json.dumps({"seq": self.seq, **message}))

    def grab(self, *target: float) -> None:
        self.say(type="grab", point=[0.0, 0.0, 0.0], target=target, at="point")

    def heard(self) -> Iterator[str | bytes]:
        """The messages that it receives, within a test's timeout."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            yield self.connection.recv(max(0.1, end - time.monotonic()))
        raise TimeoutError(f"what was waited for was not said within {PATIENCE:g} s")

    def texts(self) -> Iterator[dict[str, Any]]:
        """The texts that it receives."""
        return (json.loads(got) for got in self.heard() if isinstance(got, str))

    def text(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """The next text of a kind with the given fields."""
        return next(t for t in self.texts() if t["type"] == kind and all(t[k] == v for k, v in wanted.items()))

    def frame(self) -> bytes:
        """The next frame."""
        return next(got for got in self.heard() if isinstance(got, bytes))


class Raw:
    """A WebSocket that reads when it is told to, and can violate the protocol."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), PATIENCE)
        address = parse_uri(f"ws://127.0.0.1:{port}/ws")
        self._protocol = ClientProtocol(address, origin=Origin(f"http://127.0.0.1:{port}"), max_size=None)
        self._protocol.send_request(self._protocol.connect())
        self.socket.sendall(b"".join(self._protocol.data_to_send()))
        while self._protocol.state is State.CONNECTING:
            piece = self.socket.recv(1)
            assert piece, f"the server hung up: {self._protocol.handshake_exc}"
            self._protocol.receive_data(piece)

    def send(self, *texts: bytes) -> None:
        self.socket.sendall(b"".join(Frame(Opcode.TEXT, text).serialize(mask=True) for text in texts))

    def hear(self, text: bytes) -> None:
        """Read until a message has arrived."""
        for piece in pieces(self.socket):
            self._protocol.receive_data(piece)
            if any(isinstance(event, Frame) and text in event.data for event in self._protocol.events_received()):
                return
        raise ConnectionError(f"the server hung up before it said {text!r}")

    def closed(self) -> int:
        """Read until the server closes; the code of its close frame, 0 without one."""
        with contextlib.suppress(ConnectionError):
            for piece in pieces(self.socket):
                self._protocol.receive_data(piece)
        return self._protocol.close_rcvd.code if self._protocol.close_rcvd else 0

    def kill(self) -> None:
        """Disconnect without a close frame, as a killed process does."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()
