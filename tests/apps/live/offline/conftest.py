"""The flights of the simplest missions, built once."""

import pytest
from own_flight import OwnFlight
from sessions import CORRIDOR, GUIDED

from tandemlift.apps.live import pages
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.page_modules import packed_flight, packed_mission, page_mission
from tandemlift.apps.live.session.session import Session

BY_HAND = GUIDED | {"supervision.model": "on", "supervision.limits.tilt_time": 100.0, "phases.lift_duration": 1.5}
TENDER = {"supervision.limits.tilt": 0.11, "crash.tilt": 0.12, "promise.tilt": 0.1}  # a hard push is a crash


@pytest.fixture(scope="session")
def hover():
    return packed_flight("hover")


@pytest.fixture
def flight(hover):
    one = OwnFlight(hover)
    yield one
    one.close()


@pytest.fixture
def session(tmp_path):
    one = Session(page_mission("hover"), out=tmp_path)
    one.prepare()
    yield one
    one.stop()


@pytest.fixture(scope="session")
def packed_by_hand():
    return packed_mission(page_mission("hover", BY_HAND | TENDER), "guided by hand")


@pytest.fixture
def by_hand(packed_by_hand, tmp_path):
    """A session and a page's own flight of a mission that is guided by hand and supervised."""
    session, flight = Session(page_mission("hover", BY_HAND | TENDER), out=tmp_path), OwnFlight(packed_by_hand)
    session.prepare()
    yield session, flight
    flight.close()
    session.stop()


@pytest.fixture(scope="session")
def corridor():
    return packed_mission(page_mission("hover", CORRIDOR), "a low corridor")


@pytest.fixture(scope="package")
def address(hover, tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "own.html"
    file.write_text(pages.offline_html([hover], page_files()), "utf-8")
    return file.as_uri()


@pytest.fixture(scope="package")
def browser():
    from chromium import launched

    with launched() as one:
        yield one
