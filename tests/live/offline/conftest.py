"""The flight of the simplest mission, built once."""

import pytest
from own_flight import OwnFlight

from tandemlift.live.offline.page_modules import packed_flight


@pytest.fixture(scope="session")
def hover():
    return packed_flight("hover")


@pytest.fixture
def flight(hover):
    one = OwnFlight(hover)
    yield one
    one.close()
