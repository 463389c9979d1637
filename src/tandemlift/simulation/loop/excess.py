"""The excess over a limit: total and longest duration, and the worst value with its time and place."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, where
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3


class Excess(NamedTuple):
    """Memory: 1 while the limit is exceeded, else 0; with it 0 before and after a step, nothing changes.

    `since`: start of the present stretch [s]. `steps` in all. `stretch` [s]: the longest, and its `start` [s]. `worst`
    value, with its time `at` [s] and `place` [m].
    """

    now: Number
    since: Number
    steps: Number
    stretch: Number
    start: Number
    worst: Number
    at: Number
    place: Vec3


NO_EXCESS = Excess(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, ZERO)


@law(absent="m")
def exceed(m: Excess, over: Number, value: Number, place: Vec3, t: Number, dt: Number) -> Excess:
    """The memory after a step.

    Args:
        m: the memory before.
        over: 1 if the limit is exceeded, else 0.
        value: the compared value, larger if it is worse.
        place: of the vehicle [m, world axes].
        t: time at the start of the step [s].
        dt: length of the step [s].
    """
    since = where(over > m.now, t, m.since)
    stretch = t - since + dt
    longer, worse = over * where(stretch > m.stretch, 1.0, 0.0), over * where(value > m.worst, 1.0, 0.0)
    return Excess(
        now=over,
        since=since,
        steps=m.steps + over,
        stretch=where(longer > 0.0, stretch, m.stretch),
        start=where(longer > 0.0, since, m.start),
        worst=where(worse > 0.0, value, m.worst),
        at=where(worse > 0.0, t, m.at),
        place=chosen(worse, place, m.place),
    )
