"""What one page cannot do to the others."""

import contextlib
import itertools
import threading
from types import SimpleNamespace

import pytest
from patience import PATIENCE, until
from standin import StandIn
from websockets.exceptions import InvalidStatus

from tandemlift.apps.live import viewers
from tandemlift.apps.live.session import page_messages
from tandemlift.core.errors import InputError


def test_a_page_that_does_not_read_misses_frames_and_the_others_none(start, monkeypatch):
    class Large(StandIn):
        def frame(self):  # never the same twice: a flight that stands still is told rarely
            return super().frame() * 100 + next(shown).to_bytes(8)

    shown = itertools.count()
    monkeypatch.setattr("tandemlift.apps.live.server.RATE", 0.5 / PATIENCE)  # it shows what the test has it show
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


BAD = {
    "that breaks the schema": b'{"type":"grab","seq":2,"point":[0,1,0],"target":[1,2e9,3],"at":"x"}',
    "that is a long list": b'{"type":"set","seq":2,"key":"a","value":[' + b'"",' * 1300 + b'""]}',
    "of a beam that another holds": b'{"type":"grab","seq":2,"point":[0,1,0],"target":[1,2,3],"at":"point"}',
    "that the flight refuses": b'{"type":"force","seq":2,"force":[0,0,0],"point":[0,0,0]}',
    "that the flight answers with a refusal": b'{"type":"ask","seq":2,"what":"lift"}',
}


def refuses(message):
    """As a flight that refuses all but to be grabbed."""
    if message.type == "grab":
        return []
    if message.type == "ask":
        return [{"type": "refused", "what": "ask", "reason": "the vehicle is in the air"}]
    raise InputError("hands off")


@pytest.mark.parametrize("bad", BAD.values(), ids=BAD)
def test_a_page_whose_messages_are_refused_is_cut_off_long_before_it_floods(live, clock, monkeypatch, bad):
    monkeypatch.setattr(live.flight, "_applied", refuses)
    enough = viewers.MAX_MESSAGES // viewers.REFUSAL_COST
    with live.viewer() as other:
        if b'"grab"' in bad and b"2e9" not in bad:
            other.grab(0.0, 0.0, 0.0)
            other.text("status", holder="you")
        raw = live.raw()
        if b'"force"' in bad:
            raw.send(b'{"type":"grab","seq":1,"point":[0,0,0],"target":[1,0,0],"at":"centre"}')
        raw.send(*[bad] * (enough - 1), b'{"type":"ping","seq":3,"t":271828.5}')
        raw.hear(b'"t":271828.5}')  # as many as that are answered
        with contextlib.suppress(ConnectionError):
            raw.send(bad, bad)
        assert raw.closed() == 1008
        raw.kill()
        assert other.frame()


def test_messages_that_wait_in_one_page_do_not_delay_those_of_another(live, monkeypatch):
    asleep, awake, sent, order = threading.Event(), threading.Event(), 50, []
    one, two = live.raw(), live.raw()
    until(lambda: len(live.server.viewers) == 2)
    receive = live.server._dispatcher.receive
    monkeypatch.setattr(
        live.server._dispatcher, "receive", lambda viewer, text: (order.append(viewer), receive(viewer, text))
    )
    live.soon(lambda: (asleep.set(), awake.wait(PATIENCE)))
    assert asleep.wait(PATIENCE)
    for raw in (one, two):
        raw.send(*[b'{"type":"ping","seq":1,"t":0}'] * sent)
    awake.set()
    until(lambda: len(order) == 2 * sent)
    first, last = order[0], [i for i, viewer in enumerate(order) if viewer is order[0]][-1]
    assert sum(viewer is not first for viewer in order[:last]) > sent // 2
    one.kill()
    two.kill()


def test_a_page_whose_messages_take_long_waits_until_its_share_of_the_time_has_passed(clock, monkeypatch):
    worked = iter(0.6 * viewers.MAX_WORK * n for n in (0, 1, 1, 2, 2, 3))
    monkeypatch.setattr(viewers, "thread_time", lambda: next(worked))
    all_viewers, viewer, rests = viewers.Viewers(), viewers.Viewer(None), []
    all_viewers.join(viewer)
    all_viewers.rest(viewer)
    for now in (1000.0, 1000.0, 1000.2 + 1.0):
        clock[0] = now
        with viewer.working():
            pass
        rests.append(all_viewers.rest(viewer))
    assert rests == pytest.approx([0.0, 0.2, 0.0])  # of 1.2 shares, 0.2 have to pass


LISTS = b'{"type":"fly","seq":1,"toml":[' + b"[]," * 20_000 + b"[]]}"  # 58 ms to parse, if it were
TABLES = b'{"type":"fly","seq":1,"mission":"a","toml":"' + b"[a]\\n" * 12_000 + b'"}'


def test_of_ten_pages_that_send_files_of_many_parts_none_is_parsed(live, clock, monkeypatch):
    parsed, read = [], page_messages._ANY.validate_json
    monkeypatch.setattr(page_messages, "_ANY", SimpleNamespace(validate_json=lambda t: (parsed.append(t), read(t))[1]))
    pages, each = [live.raw() for _ in range(10)], 5
    for raw in pages:
        raw.send(*[LISTS, TABLES] * each, b'{"type":"ping","seq":2,"t":271828.5}')
    for raw in pages:
        raw.hear(b'"t":271828.5}')
        raw.kill()
    assert [text[:14] for text in parsed] == ['{"type":"ping"'] * len(pages)
    assert live.flight.heard == []


def test_ten_pages_together_get_no_more_of_the_processor_than_all_may_have(live, clock, monkeypatch):
    cost, rest, done = 0.005, viewers.Viewers.rest, []
    ticks = itertools.count()  # each message takes two looks at the clock, and so `cost`
    monkeypatch.setattr(viewers, "thread_time", lambda: cost * next(ticks))
    monkeypatch.setattr(viewers.Viewers, "rest", lambda all_, one: 2.0 * PATIENCE if rest(all_, one) else 0.0)
    receive = live.server._dispatcher.receive
    monkeypatch.setattr(live.server._dispatcher, "receive", lambda one, text: (done.append(one), receive(one, text)))
    pages = [live.raw() for _ in range(10)]
    until(lambda: len(live.server.viewers) == 10)
    for raw in pages:
        raw.send(*[b'{"type":"ping","seq":1,"t":0}'] * 100)
    until(lambda: len(set(done)) == 10 and all(one.work * 10 > viewers.ALL_WORK for one in live.server.viewers))
    accepted = [done.count(one) for one in live.server.viewers]
    for raw in pages:
        raw.kill()
    over = 2 * cost  # of each page: the message that brought it there, and the first of all, before which none counts
    assert sum(accepted) * cost <= viewers.ALL_WORK + viewers.MAX_WORK + 10 * over
    assert max(accepted) * cost <= viewers.MAX_WORK + over


def test_a_page_that_was_cut_off_keeps_its_place_for_a_while(live, clock, monkeypatch):
    over, forget = [], live.server._forget_dismissed
    monkeypatch.setattr("tandemlift.apps.live.server.MAX_VIEWERS", 1)
    monkeypatch.setattr("tandemlift.apps.live.server.DISMISSED", 0.1)
    monkeypatch.setattr(live.server, "_forget_dismissed", lambda: over.append(True))
    raw = live.raw()
    with contextlib.suppress(ConnectionError):
        raw.send(*[b"{}"] * viewers.MAX_MESSAGES)
    until(lambda: over, "the end of its time")  # which lasts until the test says so
    with pytest.raises(InvalidStatus), live.viewer():
        pass
    raw.kill()
    live.soon(forget)
    until(lambda: not live.server._dismissed)
    with live.viewer() as again:
        assert again.frame()


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
    monkeypatch.setattr("tandemlift.apps.live.server.MAX_VIEWERS", 1)
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
