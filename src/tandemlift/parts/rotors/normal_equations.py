"""The 4 × 4 system of the solver of thrust limits: γI + C Cᵀ over the free rotors, by L D Lᵀ.

C holds a column for each rotor, its weighted effect on the four components of a wrench. A working set has −1 or 1 for a
rotor that is held at a limit, 0 for a free one.
"""

from __future__ import annotations

import functools
import operator
from typing import NamedTuple

from tandemlift.core.algebra import absolute, where
from tandemlift.core.law import elementwise
from tandemlift.core.types import Number, PerRotor
from tandemlift.parts.rotors.allocation import Mixer

GAMMA = 1e-3  # weight γ of the distance from the pseudo-inverse's thrusts, against the weighted wrench


class WrenchVector(NamedTuple):
    """Four numbers, one for each component of a wrench."""

    thrust: Number
    roll: Number
    pitch: Number
    yaw: Number


class Factor(NamedTuple):
    """L D Lᵀ of a 4 × 4 matrix: L by columns, then 1/D."""

    rt: Number
    pt: Number
    yt: Number
    pr: Number
    yr: Number
    yp: Number
    t: Number
    r: Number
    p: Number
    y: Number


def summed_from(start: Number, parts: PerRotor) -> Number:
    """start + the values of a set, one after the other."""
    return functools.reduce(operator.add, parts, start)


def at_least(x: Number, least: Number) -> Number:
    """The larger of x and `least`; x if x is no number."""
    return where(least > x, least, x)


@elementwise
def free_rotors(active: Number) -> Number:
    """1 for a free rotor of a working set, 0 for one held at a limit."""
    return 1.0 - absolute(active)


def factored(rows: Mixer, active: PerRotor) -> Factor:
    """L D Lᵀ = γI + C Cᵀ over the free rotors. No pivot is below γ but for rounding."""
    free = free_rotors(active)
    thrust, roll, pitch, yaw = rows
    fr, fp, fy = roll * free, pitch * free, yaw * free
    tt, rr = summed_from(GAMMA, thrust * free * thrust), summed_from(GAMMA, fr * roll)
    pp, yy = summed_from(GAMMA, fp * pitch), summed_from(GAMMA, fy * yaw)
    rt, pt, yt = summed_from(0.0, fr * thrust), summed_from(0.0, fp * thrust), summed_from(0.0, fy * thrust)
    pr, yr, yp = summed_from(0.0, fp * roll), summed_from(0.0, fy * roll), summed_from(0.0, fy * pitch)
    t = 1.0 / tt
    lrt, lpt, lyt = rt * t, pt * t, yt * t
    r = 1.0 / at_least(rr - lrt * rt, GAMMA)
    pr, yr = pr - lpt * rt, yr - lyt * rt
    lpr, lyr = pr * r, yr * r
    p = 1.0 / at_least(pp - lpt * pt - lpr * pr, GAMMA)
    yp = yp - lyt * pt - lyr * pr
    lyp = yp * p
    y = 1.0 / at_least(yy - lyt * yt - lyr * yr - lyp * yp, GAMMA)
    return Factor(lrt, lpt, lyt, lpr, lyr, lyp, t, r, p, y)


def solved(k: Factor, b: WrenchVector) -> WrenchVector:
    """(L D Lᵀ)⁻¹ b."""
    u0 = b.thrust
    u1 = b.roll - k.rt * u0
    u2 = b.pitch - k.pt * u0 - k.pr * u1
    u3 = b.yaw - k.yt * u0 - k.yr * u1 - k.yp * u2
    x3 = u3 * k.y
    x2 = u2 * k.p - k.yp * x3
    x1 = u1 * k.r - k.pr * x2 - k.yr * x3
    x0 = u0 * k.t - k.rt * x1 - k.pt * x2 - k.yt * x3
    return WrenchVector(x0, x1, x2, x3)
