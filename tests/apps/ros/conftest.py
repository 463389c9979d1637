"""Flights that are told to a middleware of dictionaries."""

import pytest
from ros_trial import GUIDED, Trial

import tandemlift as tl


@pytest.fixture
def trial(tmp_path):
    one = Trial(tl.load_mission("hover", GUIDED), tmp_path)
    yield one
    one.front.stop()


@pytest.fixture(scope="module")
def one_trial(tmp_path_factory):
    """One for all tests of a file."""
    one = Trial(tl.load_mission("hover", GUIDED), tmp_path_factory.mktemp("flown"))
    yield one
    one.front.stop()
