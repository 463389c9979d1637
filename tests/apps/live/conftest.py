"""Servers of these tests have the tests' own patience."""

import pytest
from patient_server import make_patient


@pytest.fixture(autouse=True)
def _patient(monkeypatch):
    make_patient(monkeypatch.setattr)
