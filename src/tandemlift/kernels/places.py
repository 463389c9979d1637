"""Where the parts of a flight stand in its flat array, and the delay lines between them."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.jit import leaves
from tandemlift.kernels.outside import inlined


class Span(NamedTuple):
    """A stretch of leaves: where it begins, and how long it is."""

    at: int
    size: int


class Lines(NamedTuple):
    """What is delayed in a flight: the readings of the unit on board, those of the motion, the rotors' commands.

    Each is a stretch of the flight; in a row of the delay line they stand one after the other.
    """

    unit: Span
    motion: Span
    command: Span

    @property
    def size(self) -> int:
        """Numbers in a row."""
        return self.unit.size + self.motion.size + self.command.size

    def numbers(self, lanes: int) -> tuple[int, ...]:
        """The stretches in an array of so many lanes: at and size of each, constants of a compiled loop."""
        return tuple(n * lanes for span in self for n in span)


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


def lines_of(flying: Any) -> Lines:
    """What is delayed in flights like this one."""
    return Lines(
        place(flying, "moving", "readings", "unit"),
        place(flying, "moving", "readings", "motion"),
        place(flying, "moving", "rotors", "arriving"),
    )


@inlined
def _shift(a, row, arriving, at, size, column):
    row[column : column + size] = a[at : at + size]
    a[at : at + size] = arriving[column : column + size]


@inlined
def carry(a, ring, delays, k, at):
    """After step k, put what is delayed into row k of the line, and what arrives for step k + 1 in its place.

    `delays`: steps of unit, motion and command. A reading is known one step later at the soonest; a command without
    delay acts at once.
    """
    depth = ring.shape[0]
    row, second, third = ring[k % depth], at[1], at[1] + at[3]
    if delays[0] > 0:
        _shift(a, row, ring[(k - delays[0]) % depth], at[0], at[1], 0)
    if delays[1] > 0:
        _shift(a, row, ring[(k - delays[1]) % depth], at[2], at[3], second)
    if delays[2] > 0:
        _shift(a, row, ring[(k + 1 - delays[2]) % depth], at[4], at[5], third)
