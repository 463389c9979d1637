"""Offsets of a flight's parts in its flat array, and the parts that are delayed."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.types import leaves
from tandemlift.core.vector import Absent


class LeafSpan(NamedTuple):
    """A span of leaves: the first one, and their number."""

    at: int
    size: int


NONE = LeafSpan(0, 0)


class DelayedSpans(tuple[LeafSpan, ...]):
    """The delayed parts of a flight, in the order of `simulation.loop.delays.DelayLines`; additional sensors one by
    one.

    Each is a span of the flight's numbers, empty without delay. A row of the delay lines holds them one after another.
    """

    @property
    def size(self) -> int:
        """Numbers in a row."""
        return sum(span.size for span in self)


def leaf_offset(value: Any, *path: str) -> LeafSpan:
    """The span of a part of a nested value; an empty one where the path ends in `Absent`."""
    at = 0
    for name in path:
        if name not in value._fields:
            return LeafSpan(0, 0)
        i = value._fields.index(name)
        at += sum(map(leaves, value[:i]))
        value = value[i]
    return LeafSpan(at, leaves(value))


def delayed_spans(model: Any) -> DelayedSpans:
    """The delayed parts of flights like this one."""
    late = model.delays
    if isinstance(late, Absent):
        return DelayedSpans()
    paths: list[tuple[str, ...]] = [
        ("readings", "imu"),
        ("readings", "motion"),
        ("rotors", "arriving"),
        ("person", "view"),
    ]
    paths += [("readings", "additional", name) for name in late.additional._fields]
    return DelayedSpans(
        NONE if isinstance(delay, Absent) else leaf_offset(model, "flight_state", *path)
        for delay, path in zip((*late[:-1], *late.additional), paths, strict=True)
    )
