"""The server's listening socket and access control: only pages that it served may connect.

Another site in the same browser must not reach a server on this machine: so the Host header is on a list (against DNS
rebinding), the Origin of a WebSocket is the server's own (against cross-site hijacking), and the pages may load nothing
from elsewhere. Where other machines can connect, the address holds a random token, which is kept as a cookie.
"""

from __future__ import annotations

import errno
import ipaddress
import secrets
import socket
from http import HTTPStatus
from typing import NamedTuple
from urllib.parse import parse_qs, urlsplit

from websockets.http11 import Request

from tandemlift.core.errors import InputError

HOST, PORT = "127.0.0.1", 8710
LOCAL = ("127.0.0.1", "localhost", "[::1]")
POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; media-src 'self' blob:; connect-src 'self' ws://{host}; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",  # the address may hold the token
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


def listen(host: str, port: int) -> socket.socket:
    """A socket that listens; at port 0, at any that is free.

    Raises:
        InputError: it cannot.
    """
    if not 0 <= port <= 65_535:
        raise InputError(f"--port {port}: must be a whole number from 0 to 65535")
    try:
        named = {"localhost": "127.0.0.1"}.get(host, host)
        family, _, _, _, address = socket.getaddrinfo(named, port, type=socket.SOCK_STREAM)[0]
        return socket.create_server(address[:2], family=family)
    except (socket.gaierror, UnicodeError):
        raise InputError(f"--host {host}: no such host; {HOST} is this machine alone") from None
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise InputError(f"--port {port}: taken by another program; --port 0 takes one that is free") from None
        raise InputError(f"--host {host} --port {port}: cannot listen there: {error.strerror or error}") from None


class RequestHead(NamedTuple):
    """The parts of a request that access depends on; headers with all their values."""

    method: str
    target: str
    host: list[str]
    origin: list[str]
    cookie: list[str]

    @classmethod
    def of(cls, request: Request) -> RequestHead:
        """The head of a request."""
        method = getattr(request, "method", "GET")  # websockets < 15 has none: it accepts GET only
        return cls(method, request.path, *map(request.headers.get_all, ("Host", "Origin", "Cookie")))

    @property
    def path(self) -> str:
        """Without the query."""
        return self.target.partition("?")[0]

    @property
    def socket(self) -> bool:
        """Whether it is for the WebSocket."""
        return self.path == "/ws"


def is_local(host: str) -> bool:
    """Whether a host to bind to can be reached from this machine alone."""
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class AccessControl:
    """The access rules of a server that is bound to a host and a port.

    Attributes:
        token: what an address must hold, "" if none is needed.
        address: to open in a browser.
    """

    def __init__(self, host: str, port: int) -> None:
        self.token = "" if is_local(host) else secrets.token_urlsafe(24)
        self._port, self._anywhere = port, host in ("0.0.0.0", "::")
        shown = f"[{host}]" if ":" in host else host
        names = [socket.gethostname(), f"{socket.gethostname()}.local"] if self._anywhere else [shown]
        self._names = {name.lower() for name in (*LOCAL, *names)}
        query = f"?token={self.token}" if self.token else ""
        self.address = f"http://{names[0]}:{port}/{query}"

    def refusal(self, head: RequestHead) -> tuple[HTTPStatus, str] | None:
        """Status and reason if a request is refused."""
        if len(head.host) != 1 or not self._is_ours(head.host[0]):
            return HTTPStatus.FORBIDDEN, "wrong host name: use the address that the server printed\n"
        if head.origin != [f"http://{head.host[0]}"] and (head.socket or head.origin):
            return (
                HTTPStatus.FORBIDDEN,
                "the request comes from another origin: only this server's own pages may connect\n",
            )
        if head.method != "GET":
            return HTTPStatus.METHOD_NOT_ALLOWED, "only GET is allowed\n"
        if self.token and not self._knows_token(head):
            return HTTPStatus.FORBIDDEN, "the token is missing or wrong: use the address that the server printed\n"
        return None

    def headers(self, head: RequestHead) -> dict[str, str]:
        """The security headers of every response."""
        host = next(filter(self._is_ours, head.host), LOCAL[0])
        return {**HEADERS, "Content-Security-Policy": POLICY.format(host=host)}

    def cookie(self, head: RequestHead) -> str | None:
        """The header that makes a browser keep the token that its address holds."""
        if not self.token or "token" not in parse_qs(urlsplit(head.target).query):
            return None
        return f"{self._cookie_name}={self.token}; Path=/; HttpOnly; SameSite=Strict"

    @property
    def _cookie_name(self) -> str:
        return f"tandemlift-{self._port}"  # cookies do not distinguish ports

    def _is_ours(self, host: str) -> bool:
        name, colon, port = host.rpartition(":")
        if not colon or "]" in port:  # a name alone, for port 80
            name, port = host, "80"
        if port != str(self._port):
            return False
        return name.lower() in self._names or (self._anywhere and _is_number(name))

    def _knows_token(self, head: RequestHead) -> bool:
        given = parse_qs(urlsplit(head.target).query).get("token", [])
        for cookie in head.cookie:
            pairs = (part.strip().partition("=") for part in cookie.split(";"))
            given += [value for name, _, value in pairs if name == self._cookie_name]
        return any(secrets.compare_digest(value.encode(), self.token.encode()) for value in given)


def _is_number(name: str) -> bool:
    """Whether a name is an IP address, which no foreign name server can point elsewhere."""
    try:
        ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True
