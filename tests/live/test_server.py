"""The live page's server, over real sockets: whom it serves, who holds the beam, what a page cannot do to others."""

import contextlib
import itertools
import threading
from types import SimpleNamespace

import numpy as np
import pytest
from live_page import PAGE, Running, put_page
from patience import PATIENCE, until
from standin import StandIn
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tandemlift.common.errors import InputError
from tandemlift.live import viewers
from tandemlift.live.frames import read_frames
from tandemlift.live.guard import listen
from tandemlift.live.pages import page_files
from tandemlift.live.server import Server

MASS = {"type": "set", "key": "admittance.mass", "value": [2.0]}


@pytest.fixture
def clock(monkeypatch):
    """The time by which the server judges its viewers, which stands still; [s], in a list."""
    now = [1000.0]
    monkeypatch.setattr(viewers, "time", SimpleNamespace(monotonic=lambda: now[0]))
    return now


@pytest.fixture
def start(tmp_path):
    """Serve a stand-in, or what is given, until the test ends."""
    files, running = page_files(put_page(tmp_path / "site" / "page")), []

    def go(flight=None, **options) -> Running:
        running.append(Running(Server(files, flight, **{"port": 0, **options})))
        return running[-1]

    yield go
    for server in running:
        server.stop()


@pytest.fixture
def live(start):
    """A server with a stand-in, as `.flight`."""
    flight = StandIn()
    server = start(flight)
    server.flight = flight
    return server


def at_target(viewer, server, target):
    """Wait for a frame in which the body is where it is pulled."""
    until(lambda: np.allclose(read_frames(server.flight.fields, viewer.frame())["position"], target, atol=0.01))


# What is served, and to whom


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


# What a viewer is told


def test_a_viewer_is_told_the_scene_then_frames_then_the_status(live):
    with live.viewer() as viewer:
        assert viewer.scene == {"type": "scene", **live.flight.scene}
        frame = read_frames(live.flight.fields, viewer.frame())
        assert frame["attitude"].tolist() == [[1.0, 0.0, 0.0, 0.0]]
        status = viewer.text("status")
        assert (status["viewers"], status["holder"], status["phase"]) == (1, "none", "guided")


def test_time_goes_on_from_frame_to_frame(live):
    times = []
    with live.viewer() as viewer:

        def goes_on():
            times.append(read_frames(live.flight.fields, viewer.frame())["time"].item())
            return len(times) >= 30 and times[-1] > times[0]

        until(goes_on)
    assert all(a <= b for a, b in itertools.pairwise(times))


def test_who_moves_the_beam_is_shown_what_came_of_it_before_the_next_frame_for_all(live, monkeypatch):
    monkeypatch.setattr("tandemlift.live.server.RATE", 0.5 / PATIENCE)
    with live.viewer() as viewer:
        assert viewer.frame()
        viewer.grab(1.0, 0.0, 0.0)
        viewer.say(type="move", target=[2.0, 0.0, 0.0])
        assert read_frames(live.flight.fields, viewer.frame())["hand_target"].tolist() == [[2.0, 0.0, 0.0]]


def test_a_ping_is_echoed(live):
    with live.viewer() as viewer:
        viewer.say(type="ping", t=12.5)
        assert viewer.text("pong") == {"type": "pong", "t": 12.5}


def test_a_change_is_told_to_all_and_a_refusal_to_the_one_who_asked(live):
    with live.viewer() as one, live.viewer() as two:
        one.say(type="set", key="plant.mass_scale", value=2.0)
        refused = one.text("refused")
        assert refused["what"] == "set plant.mass_scale"
        assert "cannot be changed in flight" in refused["reason"]
        one.say(**MASS)
        assert one.text("changed")["value"] == [2.0]
        assert two.text("changed") == {"type": "changed", "key": "admittance.mass", "value": [2.0], "duration": 0.5}


def test_all_that_is_restored_is_told_to_all(live):
    with live.viewer() as one, live.viewer() as two:
        one.say(type="restore")
        for viewer in (one, two):
            assert [viewer.text("changed")["key"] for _ in range(2)] == ["admittance.mass", "admittance.damping"]


def test_an_answer_goes_to_the_one_who_asked(live):
    with live.viewer() as one:
        one.say(type="save", name="mine")
        assert one.text("done")["detail"] == "mine"


def test_a_bad_message_is_refused_with_key_value_and_what_is_allowed(live):
    with live.viewer() as viewer:
        viewer.say(type="speed", factor=3)
        assert viewer.text("refused") == {
            "type": "refused",
            "what": "speed",
            "reason": "speed.factor = 3: must be a number ≥ 0.1 and ≤ 1",
        }


def test_after_a_reset_all_are_told_the_scene_again_and_nobody_holds(live):
    with live.viewer() as one, live.viewer() as two:
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        two.say(type="reset")
        assert one.text("scene")["mission"] == two.text("scene")["mission"] == "hover"
        one.text("status", holder="none")
        until(lambda: not live.flight.held)


def test_an_error_of_the_flight_is_told_and_serving_goes_on(live, monkeypatch, caplog):
    monkeypatch.setattr(live.flight, "_heeded", lambda message: 1 / 0)
    with live.viewer() as viewer:
        viewer.grab(0.0, 0.0, 0.0)
        assert "ZeroDivisionError" in viewer.text("refused")["reason"]
        assert viewer.frame()
    assert "grab failed" in caplog.text


# The hand


def test_the_body_follows_the_hand_and_the_frame_tells_the_message_that_it_follows(live):
    with live.viewer() as viewer:
        viewer.grab(1.0, 0.0, 0.0)
        at_target(viewer, live, [1.0, 0.0, 0.0])
        viewer.say(type="move", target=[1.0, 0.5, 0.0])
        at_target(viewer, live, [1.0, 0.5, 0.0])
        frame = read_frames(live.flight.fields, viewer.frame())
        assert (frame["seq"].item(), frame["held"].item()) == (viewer.seq, 1.0)
        viewer.say(type="release")
        until(lambda: not live.flight.held)
        viewer.text("status", holder="none")


def test_of_two_viewers_one_holds(live):
    with live.viewer() as one, live.viewer() as two:
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        two.text("status", holder="other")
        for _ in range(2):
            two.grab(-1.0, 0.0, 0.0)
            assert two.text("refused") == {
                "type": "refused",
                "what": "grab",
                "reason": "somebody else holds the beam: wait until they let go",
            }
        two.say(type="force", force=[1.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        assert two.text("refused")["what"] == "force"
        two.say(type="move", target=[-1.0, 0.0, 0.0])
        two.say(type="release")
        two.say(type="force", force=[0.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        at_target(one, live, [1.0, 0.0, 0.0])
        assert [m.type for m in live.flight.heard] == ["grab"]
        one.say(type="release")
        two.text("status", holder="none")
        two.grab(-1.0, 0.0, 0.0)
        two.text("status", holder="you")
        at_target(one, live, [-1.0, 0.0, 0.0])


def test_a_force_holds_until_it_is_zero(live):
    with live.viewer() as one, live.viewer() as two:
        one.say(type="force", force=[0.0, 0.0, 2.0], point=[0.0, 1.0, 0.0])
        two.text("status", holder="other")
        one.say(type="force", force=[0.0, 0.0, 0.0], point=[0.0, 1.0, 0.0])
        two.text("status", holder="none")
        assert not live.flight.held


def test_a_push_that_ends_while_the_beam_is_pulled_does_not_let_go_of_it(live):
    with live.viewer() as one:
        one.say(type="force", force=[1.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        one.grab(1.0, 0.0, 0.0)
        one.say(type="force", force=[0.0, 0.0, 0.0], point=[0.0, 0.0, 0.0])
        one.say(type="ping", t=1.0)
        one.text("pong", t=1.0)
        assert live.flight.held
        one.say(type="release")
        until(lambda: not live.flight.held)


def test_a_page_that_is_killed_lets_go(live):
    with live.viewer() as other:
        raw = live.raw()
        raw.send(b'{"type":"grab","seq":1,"point":[0,0,0],"target":[1,0,0],"at":"centre"}')
        other.text("status", holder="other", viewers=2)
        assert live.flight.held
        raw.kill()
        other.text("status", holder="none", viewers=1)
        assert not live.flight.held
        assert live.flight.released == 1


def test_a_page_that_is_closed_lets_go(live):
    with live.viewer() as viewer:
        viewer.grab(1.0, 0.0, 0.0)
        until(lambda: live.flight.held)
    until(lambda: not live.flight.held)


def test_a_page_that_hangs_lets_go_and_one_that_pings_does_not(live, clock):
    with live.viewer() as one:
        one.grab(1.0, 0.0, 0.0)
        one.text("status", holder="you")
        for t in (1.0, 2.0, 3.0):
            clock[0] += 0.9 * viewers.SILENT
            one.say(type="ping", t=t)
            one.text("pong", t=t)
            assert one.text("status")["holder"] == "you"
        assert live.flight.held
        clock[0] += 1.1 * viewers.SILENT
        one.text("status", holder="none")
        assert not live.flight.held
        one.say(type="ping", t=4.0)  # its socket lives on
        assert one.text("pong", t=4.0)


def test_a_viewer_who_does_not_hold_may_go_without_letting_go(live):
    with live.viewer() as holder:
        holder.grab(1.0, 0.0, 0.0)
        holder.text("status", holder="you")
        live.raw().kill()
        holder.text("status", viewers=1)
        at_target(holder, live, [1.0, 0.0, 0.0])
        assert live.flight.released == 0


def test_the_hand_does_not_wait_for_a_change_that_takes_long(start):
    go = threading.Event()
    flight = StandIn(wait=go)
    server = start(flight)
    with server.viewer() as viewer, server.viewer() as other:
        viewer.say(**MASS)
        viewer.grab(1.0, 0.0, 0.0)
        until(lambda: flight.held)
        other.text("status", holder="other")
        assert [m.type for m in flight.heard] == ["grab"]
        go.set()
        other.text("changed", key="admittance.mass")


def test_changes_that_wait_are_made_in_order_and_not_too_many(start):
    go = threading.Event()
    flight = StandIn(wait=go)
    server = start(flight)
    with server.viewer() as viewer:
        for i in range(20):
            viewer.say(**{**MASS, "value": [float(i)]})
        assert "16 changes are still to be made" in viewer.text("refused")["reason"]
        go.set()
        for i in range(16):
            assert viewer.text("changed")["value"] == [float(i)]


# What one page cannot do to the others


def test_a_page_that_does_not_read_misses_frames_and_the_others_none(start, monkeypatch):
    class Large(StandIn):
        def frame(self):
            return super().frame() * 100

    monkeypatch.setattr("tandemlift.live.server.RATE", 0.5 / PATIENCE)  # it shows what the test has it show
    server = start(Large())
    raw = server.raw()
    with server.viewer() as viewer:

        def somebody_misses_a_frame():
            server.soon(server.server._show_once, 1)
            return viewer.frame() and any(v.dropped for v in server.server.viewers)

        until(somebody_misses_a_frame)
        assert sum(v.dropped == 0 for v in server.server.viewers) == 1
    raw.kill()


def test_a_page_that_floods_is_cut_off_and_lets_go(live, clock):
    raw = live.raw()
    raw.send(b'{"type":"grab","seq":1,"point":[0,0,0],"target":[1,0,0],"at":"centre"}')
    until(lambda: live.flight.held)
    with contextlib.suppress(ConnectionError):
        raw.send(*[b"{}"] * 50_000)
    assert raw.closed() in (0, 1008)
    until(lambda: not live.flight.held)
    raw.kill()


def test_a_message_of_more_than_64_kB_hangs_up(live):
    with live.viewer() as other:
        raw = live.raw()
        raw.send(b" " * 65_537)
        assert raw.closed() == 1009
        raw.kill()
        assert other.frame()


@pytest.mark.parametrize(
    "data", [b"\x81\x05hello", b"\xff" * 64, b"\x83\x80\0\0\0\0", b"\x81\x85\0\0\0\0\xff\xfe\xfd\xfc\xfb"]
)
def test_what_is_no_frame_hangs_up(live, data):
    with live.viewer() as other:
        raw = live.raw()
        raw.socket.sendall(data)
        assert raw.closed() in (1002, 1007)
        raw.kill()
        assert other.frame()


def test_there_are_not_too_many_viewers(live, monkeypatch):
    monkeypatch.setattr("tandemlift.live.server.MAX_VIEWERS", 1)
    with live.viewer():
        with pytest.raises(InvalidStatus) as refused, live.viewer():
            pass
        assert refused.value.response.status_code == 503


def test_stopping_says_goodbye_and_ends_the_flight(tmp_path, monkeypatch):
    monkeypatch.setattr("tandemlift.live.server.FAREWELL", PATIENCE)
    flight = StandIn()
    server = Running(Server(page_files(put_page(tmp_path / "page")), flight, port=0))
    with server.viewer() as viewer:
        server.stop()
        with contextlib.suppress(ConnectionClosed):
            while viewer.frame():
                pass
        assert viewer.connection.close_code == 1001
    steps = flight.steps
    assert not flight._thread.is_alive()
    assert flight.steps == steps


def test_refusals_are_not_told_more_often_than_anybody_reads(live, clock):
    with live.viewer() as viewer:
        for _ in range(100):
            viewer.connection.send("{}")
        viewer.say(type="ping", t=0.0)
        kinds = itertools.takewhile(lambda kind: kind != "pong", (text["type"] for text in viewer.texts()))
        assert list(kinds).count("refused") == viewers.MOST_REFUSALS
