"""x."""

from typing import Any, NamedTuple

from tandemlift.law import law


class Walls(NamedTuple):
    """x."""

    a: Any


class Wall(NamedTuple):
    """x."""

    a: Any
    b: Any
    c: Any
    d: Any
    e: Any


NOWHERE = 0


@law
def press(walls, near, frame, s):
    return s


@law
def consider(wall, near, frame, s):
    return near
