"""The start of a flight: one that is disturbed can ask for more than the rest of the flight by orders of magnitude."""

from __future__ import annotations

from collections.abc import Sequence

from tandemlift.core.types import Array
from tandemlift.pictures.figures.drawing.panels import extent

START = 1.0  # s, how long a start may be
LONG = 5.0  # s, flights shorter than this are all start
DISTURBED = 1.5  # times the span of what follows, from where the start is one of its own


def _span(values: Array) -> float:
    low, high = extent(values)
    return high - low


def is_disturbed(time: Array, values: Array, least: Sequence[float]) -> bool:
    """Whether any of the values (T, n) spans far more in the first second than afterwards; `least`: (n) that count."""
    if not len(time) or time[-1] < LONG:
        return False
    late = time > START
    spans = ((_span(column), _span(column[late])) for column in values.T)
    return any(whole > DISTURBED * max(after, size) for (whole, after), size in zip(spans, least, strict=True))
