"""Delay lines of a flight between steps: delayed values are part of the state of a linear model."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.simulation.loop_code.offsets import delayed_spans
from tandemlift.simulation.loop_code.step_output import COMMAND_LINE
from tandemlift.simulation.plan import FlightPlan


class DelayedNumber(NamedTuple):
    """A delayed number: its place in the flight, its column in the delay lines, the number of values under way.

    A number of the flight is the value that has arrived. Value j under way, from 1 on, was written j steps ago.
    """

    number: int
    column: int
    under_way: int


def delayed_numbers(p: FlightPlan) -> list[DelayedNumber]:
    """The delayed numbers of a flight, in the order of a row of the delay lines."""
    found, column = list[DelayedNumber](), 0
    for line, (at, size) in enumerate(delayed_spans(p.model)):
        steps = int(p.delays[line]) if size else 0
        under_way = max(steps - 1, 0) if line == COMMAND_LINE else steps  # a command acts in its own step
        found += [DelayedNumber(at + i, column + i, under_way) for i in range(size)]
        column += size
    return found


def values_under_way(numbers: list[DelayedNumber], ring: Array, k: int) -> list[Array]:
    """The values of each number under way before step k, the newest first; `ring`: rows × columns, row k of step k."""
    return [np.array([ring[(k - j) % len(ring), one.column] for j in range(1, one.under_way + 1)]) for one in numbers]
