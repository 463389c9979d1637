"""What one page cannot do to the others."""

import contextlib
import itertools

import pytest
from patience import PATIENCE, until
from standin import StandIn
from websockets.exceptions import InvalidStatus

from tandemlift.live import viewers


def test_a_page_that_does_not_read_misses_frames_and_the_others_none(start, monkeypatch):
    class Large(StandIn):
        def frame(self):
            return super().frame() * 100

    monkeypatch.setattr("tandemlift.live.server.RATE", 0.5 / PATIENCE)  # it shows what the test has it show
    server = start(Large())
    raw = server.raw()
    with server.viewer() as viewer:

        def somebody_misses_a_frame():
            server.soon(server.server._broadcast_once, 1)
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


def test_refusals_are_not_told_more_often_than_anybody_reads(live, clock):
    with live.viewer() as viewer:
        for _ in range(100):
            viewer.connection.send("{}")
        viewer.say(type="ping", t=0.0)
        kinds = itertools.takewhile(lambda kind: kind != "pong", (text["type"] for text in viewer.texts()))
        assert list(kinds).count("refused") == viewers.MAX_REFUSALS
