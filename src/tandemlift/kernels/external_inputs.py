"""What a flight is given from outside at each step, formed ahead of it or beside it: pushes, gusts, chance, walls.

Pushes and gusts depend on time alone. The force of the person is evaluated SPAN steps ahead at every half step, so that
a push that is over costs nothing and their number is data. Standard normals of a flight alone are formed for as many
steps, several in a vector.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.vector import ZERO
from tandemlift.laws.mechanics.push import SUPPORT, GaussianPush
from tandemlift.laws.mechanics.wind import Gust
from tandemlift.trace import leaves

LANES = 8
SPAN = 16  # steps
HALVES = 2 * SPAN + 1
GAUSSIAN = GaussianPush(ZERO, 0.0, 0.0, ZERO)
GUST = Gust(ZERO, 0.0, 0.0, 0.0)


class InputTables(NamedTuple):
    """Data of any number: an array each of pushes, gusts, walls and legs of a person's path, a row each."""

    pushes: Any
    gusts: Any
    walls: Any
    legs: Any


def draws(noise: Any) -> int:
    """How many draws of four standard normals fill a value like `noise`."""
    return -(-leaves(noise) // 4)


def active(p, opens, closes):
    """Whether a push is other than zero somewhere between two times [s]."""
    around = SUPPORT / p.per_sigma
    return (p.time + around > opens) & (p.time - around < closes)
