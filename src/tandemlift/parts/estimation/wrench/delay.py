"""A pure delay T as a second-order Padé all-pass, exact for an input held over a step.

    y = u − (12/T) ż,    z̈ + (6/T) ż + (12/T²) z = u.

Its gain is 1 at every frequency, its phase that of the delay to (ω T)⁵/720 rad: a low-pass of the same delay would lose
gain where the pilot's loops cross. The poles are −a ± j b with a = 3/T, b = √3/T.
"""

from __future__ import annotations

from typing import Generic, NamedTuple

from tandemlift.core.algebra import cos, exp, sin, sqrt
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.parts.mechanics.low_pass import V, flush_denormals


class Delay(NamedTuple):
    """The transition of (z − T² u/12, ż) over one step; T²/12 [s²] and 12/T [1/s]."""

    value_from_value: Number
    value_from_rate: Number
    rate_from_value: Number
    rate_from_rate: Number
    rest: Number
    feed: Number


class DelayState(NamedTuple, Generic[V]):
    """Memory of a delay, of a number or a vector of unit U: z [U s²] and ż [U s]."""

    value: V
    rate: V


@law
def delayed(k: Delay, memory: DelayState[V], value: V) -> tuple[V, DelayState[V]]:
    """(the delayed value at the end of a step with a constant input, the new memory)."""
    deviation = memory.value - value * k.rest
    after = DelayState(
        flush_denormals(value * k.rest + deviation * k.value_from_value + memory.rate * k.value_from_rate),
        flush_denormals(deviation * k.rate_from_value + memory.rate * k.rate_from_rate),
    )
    return value - after.rate * k.feed, after


def delay_of(time: Number, step: Number) -> Delay:
    """The delay by a time [s], run every `step` [s]."""
    a, b = 3.0 / time, sqrt(3.0) / time
    decay, c, s = exp(-a * step), cos(b * step), sin(b * step)
    return Delay(
        value_from_value=decay * (c + sqrt(3.0) * s),
        value_from_rate=decay * s / b,
        rate_from_value=-decay * s * (a * a + b * b) / b,
        rate_from_rate=decay * (c - sqrt(3.0) * s),
        rest=time * time / 12.0,
        feed=12.0 / time,
    )
