"""A hundred thousand hostile messages, over real sockets, to a real flight: it flies on."""

import json
import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hostile import hostile, rude
from live_page import Running, put_page
from patience import until
from sessions import GUIDED, THRESHOLD

import tandemlift as tl
from tandemlift.apps.live import viewers
from tandemlift.apps.live.dispatch import Dispatcher
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.server import PageServer
from tandemlift.apps.live.session.frames import read_frames
from tandemlift.apps.live.session.page_messages import read_message
from tandemlift.apps.live.session.session import Session

SOCKETS, HOSTILE, RUDE = 5, 15_000, 6_000  # sockets, and messages through each of them
AT_ONCE = 250
MISSION = GUIDED | {"admittance.threshold": THRESHOLD}


class Noting(Session):
    """A flight that notes every message which reaches it."""

    def apply(self, message):
        self.heard.append(message)
        return super().apply(message)


class CountingDispatcher(Dispatcher):
    """Counts the messages that come out of the sockets."""

    count = 0

    @property
    def waiting(self):
        """Whether changes are still to be made."""
        return bool(self._tasks)

    def receive(self, viewer, text):
        self.count += 1
        super().receive(viewer, text)


@pytest.fixture
def flown(tmp_path, monkeypatch):
    """A flight in hover, and its server."""
    monkeypatch.setattr(viewers, "MAX_MESSAGES", math.inf)  # else the first two thousand in a second are the last
    flight = Noting(tl.load_mission("hover", MISSION), out=tmp_path / "out")
    flight.prepare()
    flight.heard = []
    for _ in range(round(8.0 / flight._flight.dt)):
        flight._flight.advance()
    monkeypatch.setattr("tandemlift.apps.live.server.Dispatcher", CountingDispatcher)
    server = Running(PageServer(page_files(put_page(tmp_path / "page")), flight, port=0))
    yield flight, server
    server.stop()


def assault(server, seed):
    """Send all messages of one socket, and wait until they were heard."""
    raw = server.raw()
    texts = [*hostile(HOSTILE, seed), *rude(RUDE, seed)]
    for first in range(0, len(texts), AT_ONCE):
        part = [text.encode(errors="replace") for text in texts[first : first + AT_ONCE]]
        raw.send(part[0], opcode=2)
        raw.send(*part[1:])
        raw.skip()
    raw.send(b'{"type":"ping","seq":1,"t":271828.5}')
    raw.hear(b'"t":271828.5}')
    raw.kill()


def test_after_a_hundred_thousand_hostile_messages_it_flies_on_and_follows_a_hand(flown):
    flight, server = flown
    with server.viewer() as good, ThreadPoolExecutor(SOCKETS) as pool:
        fields = tuple(map(tuple, good.scene["fields"]))

        def seen():
            return {name: value[0] for name, value in read_frames(fields, good.frame()).items()}

        attacks = [pool.submit(assault, server, seed) for seed in range(SOCKETS)]
        while not all(attack.done() for attack in attacks):
            assert all(np.isfinite(value).all() for value in seen().values())
        for attack in attacks:
            attack.result()
        until(lambda: not server.server._dispatcher.waiting, "the end of all changes")
        assert server.server._dispatcher.count >= 100_000
        good.text("status", viewers=1, holder="none")
        _check_heard(flight.heard)
        for message in (
            {"type": "pause", "on": False},
            {"type": "speed", "factor": 1.0},
            {"type": "enable", "on": True},
        ):
            good.say(**message)
        _check_follows(good, seen)


def _check_heard(messages):
    """That what got through is as good as any message, and was not little."""
    kinds = {message.type for message in messages}
    assert {"grab", "move", "force", "release", "enable"} <= kinds
    assert len(messages) > 1000
    for message in messages[:2000]:
        data = message.model_dump()
        assert read_message(json.dumps(data if data.get("key", "") is not None else {**data, "key": "x"}))


def _check_follows(good, seen):
    """That the vehicle flies, in one flight or after a reset, and comes when it is pulled."""
    status = good.text("status")
    assert status["phase"] in ("guided", "hold", "lift", "land", "idle", "stopped", "over"), status
    then = seen()["time"]
    until(lambda: seen()["time"] > then + 0.5, "half a second of flight")
    at = seen()["position"]
    good.grab(float(at[0]) + 1.0, float(at[1]), float(at[2]))
    assert good.text("status", holder="you")["behind_ms"] is not None
    until(lambda: np.linalg.norm(seen()["push"]) > 0.5, "a push")
    good.say(type="release")
