"""Detection of oscillations: consecutive half periods of similar length, in a band, whose amplitude does not decay.

A half period begins when a signal passes a level on the other side of zero. The signal's mean is thus assumed zero, and
oscillations smaller than the level, or on one side of zero, are ignored. Peaks are compared with their running mean: if
an oscillation decays by more than a third in two half periods, the count restarts.
"""

from __future__ import annotations

from typing import Any, Generic, NamedTuple, TypeVar

from tandemlift.core.algebra import absolute, greatest, maximum, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number
from tandemlift.core.vector import componentwise, times

T = TypeVar("T")

SIMILAR_PEAK = 0.6  # of the mean peak, which a peak must reach
SIMILAR_TIME = 2.0  # largest ratio of a half period to the previous one, either way


@componentwise
class Swings(NamedTuple, Generic[T]):
    """A value for each motion that may oscillate: body rates p, q, r, and the error of the vertical speed."""

    roll: T
    pitch: T
    yaw: T
    vertical: T


class OscillationLimits(NamedTuple):
    """Levels of the signals [rad/s, m/s]; shortest and longest half period [s]; half periods that are needed."""

    levels: Swings[Number]
    shortest: Number
    longest: Number
    halves: Number


class HalfPeriods(NamedTuple):
    """Memory of a signal: the present half period and those before it, and the longest oscillation until now.

    `side` of the half period (1, −1, before the first 0), its start `since` [s] and its `peak`; mean peak `usual`, the
    last half period `lasted` [s], how many in a row are alike (`count`), and the start of the first of them, `began`
    [s]. The longest oscillation: `first` and `last` [s], `halves`, `amplitude`.
    """

    side: Number
    since: Number
    peak: Number
    usual: Number
    lasted: Number
    count: Any
    began: Number
    first: Number
    last: Number
    halves: Number
    amplitude: Number


class Oscillation(NamedTuple):
    """Memory: 1 while any signal is beyond its level, else 0; with it 0, nothing changes. And that of each signal."""

    now: Number
    swings: Swings[HalfPeriods]


STILL = HalfPeriods(*[0.0] * len(HalfPeriods._fields))
NO_OSCILLATION = Oscillation(0.0, Swings(STILL, STILL, STILL, STILL))


@law
def half_period(k: OscillationLimits, m: HalfPeriods, x: Number, level: Number, t: Number) -> HalfPeriods:
    """The memory of a signal after its value x at time t [s]."""
    side = where(x > 0.0, 1.0, -1.0)
    out = beyond(x, level)
    turned = out * where(side == m.side, 0.0, 1.0)
    lasted = t - m.since
    in_band = where(lasted < k.shortest, 0.0, where(lasted > k.longest, 0.0, absolute(m.side)))
    same_time = where(lasted * SIMILAR_TIME < m.lasted, 0.0, where(lasted > m.lasted * SIMILAR_TIME, 0.0, 1.0))
    alike = in_band * same_time * where(m.peak < m.usual * SIMILAR_PEAK, 0.0, 1.0) * where(m.count > 0.0, 1.0, 0.0)
    count = where(turned > 0.0, where(alike > 0.0, m.count + 1.0, in_band), m.count)
    began = where(turned > alike, m.since, m.began)
    usual = where(turned > 0.0, where(alike > 0.0, 0.5 * (m.usual + m.peak), m.peak), m.usual)
    found = turned * where(count < k.halves, 0.0, where(t - began < m.last - m.first, 0.0, 1.0))
    return HalfPeriods(
        side=where(turned > 0.0, side, m.side),
        since=where(turned > 0.0, t, m.since),
        peak=where(turned > 0.0, absolute(x), where(out > 0.0, maximum(m.peak, absolute(x)), m.peak)),
        usual=usual,
        lasted=where(turned > 0.0, lasted, m.lasted),
        count=count,
        began=began,
        first=where(found > 0.0, began, m.first),
        last=where(found > 0.0, t, m.last),
        halves=where(found > 0.0, count, m.halves),
        amplitude=where(found > 0.0, usual, m.amplitude),
    )


@elementwise
def beyond(x: Number, level: Number) -> Number:
    """1 where a signal is beyond its level, else 0."""
    return where(absolute(x) < level, 0.0, 1.0)


@law
def oscillation_step(
    k: OscillationLimits, m: Oscillation, signals: Swings[Number], flying: Number, t: Number
) -> Oscillation:
    """The memory after the signals at time t [s]; they count while `flying` is 1."""
    x = times(signals, flying)
    swings = [half_period(k, *of_one, t) for of_one in zip(m.swings, x, k.levels, strict=True)]
    return Oscillation(greatest(beyond(x, k.levels)), Swings(*swings))
