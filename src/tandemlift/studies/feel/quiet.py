"""Missions without their warnings: what may fly badly is flown, and judged by how it flew."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from tandemlift.common.errors import FlightWarning


@contextmanager
def quietly() -> Iterator[None]:
    """Load and check missions without warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)
        yield
