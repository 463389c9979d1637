"""Where the parts of a flight stand in its flat array, and the delay lines between them."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.vector import Nothing
from tandemlift.trace import leaves


class LeafSpan(NamedTuple):
    """A stretch of leaves: where it begins, and how long it is."""

    at: int
    size: int


NONE = LeafSpan(0, 0)


class DelayedSpans(NamedTuple):
    """What is delayed in a flight: readings of the unit on board and of the motion, the rotors' commands, what is seen.

    Each is a stretch of the flight, empty where there is no delay; in a row of the delay line they stand one after the
    other.
    """

    unit: LeafSpan
    motion: LeafSpan
    command: LeafSpan
    seen: LeafSpan

    @property
    def size(self) -> int:
        """Numbers in a row."""
        return sum(span.size for span in self)


def leaf_offset(value: Any, *path: str) -> LeafSpan:
    """The stretch of leaves of a part of a nested value; an empty one where the path ends in `Nothing`."""
    at = 0
    for name in path:
        if name not in value._fields:
            return LeafSpan(0, 0)
        i = value._fields.index(name)
        at += sum(map(leaves, value[:i]))
        value = value[i]
    return LeafSpan(at, leaves(value))


def delayed_spans(flying: Any) -> DelayedSpans:
    """What is delayed in flights like this one."""
    late, ends = (
        flying.delays,
        (("readings", "unit"), ("readings", "motion"), ("rotors", "arriving"), ("person", "view")),
    )
    if isinstance(late, Nothing):
        return DelayedSpans(NONE, NONE, NONE, NONE)
    spans = [
        NONE if isinstance(mark, Nothing) else leaf_offset(flying, "moving", *end)
        for mark, end in zip(late, ends, strict=True)
    ]
    return DelayedSpans._make(spans)
