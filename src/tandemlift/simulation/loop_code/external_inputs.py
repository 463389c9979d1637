"""The external inputs of a flight: pushes, gusts, random numbers, walls and the legs of a person's path.

Pushes and gusts depend on time alone. The force of the person is evaluated SPAN steps ahead at every half step, so that
a push that is over costs nothing and the number of pushes is data. For a flight alone, the standard normals of SPAN
steps are drawn at once, several in a vector.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.types import leaves
from tandemlift.core.vector import ZERO
from tandemlift.parts.mechanics.push import SUPPORT, GaussianPush
from tandemlift.parts.mechanics.wind import Gust
from tandemlift.simulation.loop.step import StepNoise

LANES = 8
SPAN = 16  # steps
HALVES = 2 * SPAN + 1
GAUSSIAN = GaussianPush(ZERO, 0.0, 0.0, ZERO)
GUST = Gust(ZERO, 0.0, 0.0, 0.0)


class InputTables(NamedTuple):
    """Arrays with a row for each push, gust, wall, and leg of a person's path."""

    pushes: Any
    gusts: Any
    walls: Any
    legs: Any


def draw_count(noise: StepNoise) -> int:
    """Number of draws, of four standard normals each, that fill a value like `noise`."""
    return -(-leaves(noise) // 4)


def is_active(p: GaussianPush, opens: Any, closes: Any) -> Any:
    """Whether a push is other than zero somewhere between two times [s]."""
    around = SUPPORT / p.per_sigma
    return (p.time + around > opens) & (p.time - around < closes)
