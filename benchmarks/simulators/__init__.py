"""The simulators that `peers.py` measures, one file each, ours among them.

A file names its `ROWS` without importing the simulator, and prepares what is timed:

    one(row) -> advance          a single simulation, on one processor
    many(row, cores) -> advance  as many as are fastest, on so many processors

`advance()` simulates for about a tenth of a second and returns the number of steps, counted over all simulations.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import NamedTuple

from machine import processors

Advance = Callable[[], int]


class Row(NamedTuple):
    """A line of the table: what it is, what one step of it is, and the packages whose versions matter."""

    what: str
    step: str
    packages: tuple[str, ...]


def fastest(candidates: Iterable[Advance], seconds: float = 0.5) -> Advance:
    """The candidate with the most steps a second, each tried for a moment after warming up."""
    return max(candidates, key=lambda advance: _speed(advance, seconds))


def _speed(advance: Advance, seconds: float) -> float:
    advance()
    return burst(advance, seconds)


def burst(advance: Advance, seconds: float) -> float:
    """Steps a second over a burst of at least `seconds`: of the one processor's time, or by the clock on more."""
    clock = time.process_time if len(processors()) == 1 else time.perf_counter
    steps, began = 0, clock()
    while True:
        steps += advance()
        elapsed = clock() - began
        if elapsed >= seconds:
            return steps / elapsed
