"""Where the parts of a flight stand in its flat array, and the delay lines between them."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.jit import leaves
from tandemlift.kernels.outside import inlined
from tandemlift.vector import Nothing


class Span(NamedTuple):
    """A stretch of leaves: where it begins, and how long it is."""

    at: int
    size: int


NONE = Span(0, 0)


class Stretches(NamedTuple):
    """What is delayed in a flight: readings of the unit on board and of the motion, the rotors' commands, what is seen.

    Each is a stretch of the flight, empty where there is no delay; in a row of the delay line they stand one after the
    other.
    """

    unit: Span
    motion: Span
    command: Span
    seen: Span

    @property
    def size(self) -> int:
        """Numbers in a row."""
        return sum(span.size for span in self)

    def numbers(self, lanes: int) -> tuple[int, ...]:
        """At and size of each in a block of so many lanes: constants of a compiled loop."""
        return tuple(n * lanes for span in self for n in span)

    def packed(self) -> tuple[int, ...]:
        """At and size of each in a row of one flight's line."""
        unit, motion, command, seen = (span.size for span in self)
        return 0, unit, unit, motion, unit + motion, command, unit + motion + command, seen


def place(value: Any, *path: str) -> Span:
    """The stretch of leaves of a part of a nested value; an empty one where the path ends in `Nothing`."""
    at = 0
    for name in path:
        if name not in value._fields:
            return Span(0, 0)
        i = value._fields.index(name)
        at += sum(map(leaves, value[:i]))
        value = value[i]
    return Span(at, leaves(value))


def stretches_of(flying: Any) -> Stretches:
    """What is delayed in flights like this one."""
    late, ends = (
        flying.delays,
        (("readings", "unit"), ("readings", "motion"), ("rotors", "arriving"), ("partner", "seen")),
    )
    if isinstance(late, Nothing):
        return Stretches(NONE, NONE, NONE, NONE)
    spans = [
        NONE if isinstance(mark, Nothing) else place(flying, "moving", *end)
        for mark, end in zip(late, ends, strict=True)
    ]
    return Stretches._make(spans)


@inlined
def _shift(a, ring, into, out, at, size, column):
    for i in range(size):
        ring[into, column + i] = a[at + i]
    for i in range(size):
        a[at + i] = ring[out, column + i]


@inlined
def carry(a, ring, delays, k, at):
    """After step k, put what is delayed into a row of the line, and what arrives for step k + 1 in its place.

    `delays`: steps of unit, motion, command and sight. A reading is known one step later at the soonest, and so is what
    is seen; a command without delay acts at once. The line has a power of two of rows.
    """
    rows, second, third = ring.shape[0] - 1, at[1], at[1] + at[3]
    fourth = third + at[5]
    _shift(a, ring, k & rows, (k - delays[0]) & rows, at[0], at[1], 0)
    _shift(a, ring, k & rows, (k - delays[1]) & rows, at[2], at[3], second)
    _shift(a, ring, k & rows, (k + 1 - delays[2]) & rows, at[4], at[5], third)
    _shift(a, ring, k & rows, (k - delays[3]) & rows, at[6], at[7], fourth)
