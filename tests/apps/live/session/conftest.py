"""A session in which the tests take the steps."""

import pytest
from sessions import GUIDED, THRESHOLD

import tandemlift as tl
from tandemlift.apps.live.session.session import Session


@pytest.fixture
def session(tmp_path):
    one = Session(tl.load_mission("hover", GUIDED | {"admittance.threshold": THRESHOLD}), out=tmp_path)
    one.prepare()
    yield one
    one.stop()
