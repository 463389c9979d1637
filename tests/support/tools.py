"""Tools outside Python that some tests need."""

import shutil

import pytest


def need(*names):
    """Skip a test without these programs (a skip is a failure where TANDEMLIFT_REQUIRE_ALL=1: tests/conftest.py)."""
    missing = [name for name in names if shutil.which(name) is None]
    if missing:
        pytest.skip(f"no {', '.join(missing)}")
