"""A flight with events, which is exported to files of many kinds."""

import pytest
from exported import eventful


@pytest.fixture(scope="package")
def flight():
    return eventful()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("exported")
