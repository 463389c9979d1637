"""Whom the server lets in, and what it serves: over real sockets."""

import pytest
import segno
from live_page import PAGE
from standin import StandIn
from websockets.exceptions import InvalidStatus

from tandemlift.apps.live.access import listen
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.server import qr_code
from tandemlift.core.errors import InputError


def test_the_files_of_the_page_are_served_with_headers_that_keep_others_out(live):
    for path, name in {"/": "index.html", **{f"/{name}": name for name in PAGE}}.items():
        status, headers, body = live.get(path)
        assert (status, body) == (200, PAGE[name])
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["Cache-Control"] == "no-store"
        policy = headers["Content-Security-Policy"]
        assert "default-src 'self'" in policy
        assert f"connect-src 'self' ws://{live.host};" in policy
        assert "unsafe" not in policy
        assert "Server" not in headers
    assert live.get("/page.js")[1]["Content-Type"].startswith("text/javascript")
    assert live.get("/")[1]["Content-Type"].startswith("text/html")


@pytest.mark.parametrize(
    "host", ["evil.example:{port}", "127.0.0.1:1", "127.0.0.1", "", "127.0.0.1:{port}.evil.example"]
)
def test_another_host_is_refused(live, host):
    host = host.format(port=live.port)
    status, headers, _ = live.get("/", Host=host)
    assert status == 403
    assert f"ws://127.0.0.1:{live.port};" in headers["Content-Security-Policy"] or host not in headers.values()


def test_no_host_and_two_hosts_are_refused(live):
    own = f"Host: {live.host}\r\n".encode()
    for lines in (b"", own * 2, own + b"Host: evil.example\r\n"):
        assert live.send(b"GET / HTTP/1.1\r\n" + lines + b"\r\n").startswith(b"HTTP/1.1 403")


def test_localhost_is_this_machine_as_well(live):
    assert live.get("/", Host=f"localhost:{live.port}")[0] == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://{host}", "http://{host}.evil.example", ""])
def test_another_origin_is_refused(live, origin):
    origin = origin.format(host=live.host)
    upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
    key = {"Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA=="}
    assert live.get("/ws", **upgrade, **key, Origin=origin)[0] == 403
    assert live.get("/page.js", Origin=origin)[0] == 403


def test_a_socket_without_an_origin_is_refused(live):
    assert live.get("/ws")[0] == 403
    assert live.get("/ws", Origin=f"http://{live.host}")[0] == 426  # its own page, but no WebSocket


@pytest.mark.parametrize(
    "path",
    [
        *("/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "/..\\secret.txt", "/page.js/../../secret.txt"),
        *("//etc/passwd", "/etc/passwd", "file:///etc/passwd", "/page.js%00", "/.", "/page", "secret.txt", "*"),
    ],
)
def test_nothing_but_the_page_is_served(live, path):
    answer = live.send(f"GET {path} HTTP/1.1\r\nHost: {live.host}\r\n\r\n".encode())
    assert answer.startswith(b"HTTP/1.1 404")
    assert b"secret" not in answer.partition(b"\r\n\r\n")[2]


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "HEAD", "OPTIONS", "TRACE"])
def test_nothing_but_get_is_answered(live, method):
    answer = live.send(f"{method} / HTTP/1.1\r\nHost: {live.host}\r\n\r\n".encode())
    assert answer.startswith(b"HTTP/1.1 405") or answer == b""  # versions of websockets before 17 hang up


@pytest.mark.parametrize(
    "request_", [b"\x16\x03\x01\x02\x00\x01\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/9\r\n\r\n", b"\0" * 9000 + b"\r\n"]
)
def test_what_is_no_request_is_hung_up_on(live, request_):
    assert not live.send(request_).startswith(b"HTTP/1.1 2")
    assert live.get("/")[0] == 200


def test_beyond_this_machine_the_address_has_a_token(start):
    server = start(StandIn(), host="0.0.0.0")
    here = {"Host": f"127.0.0.1:{server.port}"}
    token = server.address.partition("?token=")[2]
    assert len(token) > 30
    for path in ("/", "/page.js", "/?token=", "/?token=wrong", f"/?token={token}x", "/?token=%ff"):
        assert server.get(path, **here)[0] == 403
    status, headers, _ = server.get(f"/?token={token}", **here)
    assert status == 200
    cookie, *rules = headers["Set-Cookie"].split("; ")
    assert {"HttpOnly", "SameSite=Strict"} <= set(rules)
    assert server.get("/page.js", **here, Cookie=f"other=1; {cookie}")[0] == 200
    assert server.get("/page.js", Host=f"evil.example:{server.port}", Cookie=cookie)[0] == 403
    with server.viewer(Cookie=cookie) as viewer:
        assert viewer.scene["mission"] == "hover"
    with pytest.raises(InvalidStatus), server.viewer():
        pass


def test_two_servers_have_two_tokens(start):
    tokens = {start(host="0.0.0.0").address.partition("?token=")[2] for _ in range(2)}
    assert len(tokens) == 2


def test_here_the_address_has_none(live):
    assert live.address == f"http://127.0.0.1:{live.port}/"


def test_a_port_that_is_taken_and_a_host_that_is_none_are_refused_in_words():
    with listen("127.0.0.1", 0) as taken, pytest.raises(InputError, match="taken by another program"):
        listen("127.0.0.1", taken.getsockname()[1])
    with pytest.raises(InputError, match="--port 70000: must be"):
        listen("127.0.0.1", 70000)
    with pytest.raises(InputError, match=": no such host"):
        listen("no.such.host.invalid", 0)


def test_a_page_that_is_not_there_is_told_of(tmp_path):
    with pytest.raises(InputError, match="the page is not there"):
        page_files(tmp_path)


def test_the_qr_code_is_that_of_the_address():
    address = "http://lab.example:8710/?token=abc"
    drawn = qr_code(address).splitlines()
    side = segno.make(address, error="l", micro=False).symbol_size(border=4)[0]
    assert {len(line) for line in drawn if line} >= {side}
