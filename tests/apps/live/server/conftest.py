"""Servers with a stand-in for a flight."""

from types import SimpleNamespace

import pytest
from live_page import Running, put_page
from standin import StandIn

from tandemlift.apps.live import viewers
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.server import PageServer


@pytest.fixture
def clock(monkeypatch):
    """The time by which the server judges its viewers, which stands still, as their work does; [s], in a list."""
    now = [1000.0]
    monkeypatch.setattr(viewers, "time", SimpleNamespace(monotonic=lambda: now[0]))
    monkeypatch.setattr(viewers, "thread_time", lambda: 0.0)
    return now


@pytest.fixture
def start(tmp_path):
    """Serve a stand-in, or what is given, until the test ends."""
    files, running = page_files(put_page(tmp_path / "site" / "page")), []

    def go(flight=None, **options) -> Running:
        running.append(Running(PageServer(files, flight, **{"port": 0, **options})))
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
