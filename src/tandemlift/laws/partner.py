"""A person who guides the vehicle along a path by pushing it, and who sees it late."""

from typing import Any, NamedTuple

from tandemlift.law import choice, law
from tandemlift.vector import ZERO, Nothing, Vec3


class Leg(NamedTuple):
    """A straight stretch of the path: from `start` to `end` [m, world axes]."""

    start: Vec3
    end: Vec3


LEG = Leg(ZERO, ZERO)


class Partnering(NamedTuple):
    """Memory of a person: what they see, which leg of the path they are on, and where that is."""

    seen: Any
    index: Any
    leg: Leg


class Lent(NamedTuple):
    """What a step is given of a person: the push with theirs, and their new memory."""

    hand: Any
    memory: Any


@choice
def lend(partner: Any, memory: Any, hand: Any, state: Any, noise: Any, t: Any, dt: Any) -> Any:
    """What a person adds to the push of a step: `Lent`. `state` is as it is; `noise`: standard normals."""


@lend.register(Nothing)
def _nobody(partner, memory, hand, state, noise, t, dt):
    return Lent(hand, memory)


@choice
def asks_to_land(memory: Any) -> Any:
    """1 once the person asks to land, else 0."""


@asks_to_land.register(Nothing)
def _never_asks(memory):
    return 0.0


@law
def seeing(m: Partnering, seen: Any) -> Partnering:
    """A person's memory with what they see."""
    return Partnering(seen, m.index, m.leg)


@law
def on_leg(m: Partnering, leg: Leg) -> Partnering:
    """A person's memory with the leg that they are on."""
    return Partnering(m.seen, m.index, leg)
