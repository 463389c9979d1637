"""Detection of an elastic vehicle that shakes: the rotors' thrusts swing, and go on swinging.

The deviations of the commanded thrusts from their means over AVERAGED are squared, and averaged over rotors and over
POWER. Their frequency is that of a sine with the same mean squares of value and of change from step to step.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import where
from tandemlift.core.law import law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Vec3, dot
from tandemlift.simulation.loop.excess import NO_EXCESS, Excess, exceed

AVERAGED, POWER = 0.1, 0.5  # s: a mode of 20 rad/s passes, a push of a hand hardly


class ThrustShake(NamedTuple):
    """Memory: means of the thrusts [N], last deviations [N], mean squares of these and of their changes [N²].

    `excess` over the limit of the first, and the mean square of the changes at the worst (`change_at_worst`) [N²].
    """

    means: PerRotor
    deviations: PerRotor
    power: Number
    change: Number
    excess: Excess
    change_at_worst: Number


def start_shake(thrusts: PerRotor) -> ThrustShake:
    """The memory before the first step, with the rotors' thrusts [N]."""
    return ThrustShake(thrusts, thrusts * 0.0, 0.0, 0.0, NO_EXCESS, 0.0)


@law(absent=Absent())
def shake_step(
    m: ThrustShake, limit: Number, thrusts: PerRotor, flying: Number, place: Vec3, t: Number, dt: Number
) -> ThrustShake:
    """The memory after commanded thrusts [N] at time t [s]; `limit`: of their mean square [N²]."""
    deviations = (thrusts - m.means) * flying
    changes = deviations - m.deviations
    share, each = dt / POWER, 1.0 / len(thrusts)
    power = m.power + (dot(deviations, deviations) * each - m.power) * share
    change = m.change + (dot(changes, changes) * each - m.change) * share
    after = exceed(m.excess, where(power > limit, flying, 0.0), power, place, t, dt)
    worse = where(after.worst > m.excess.worst, change, m.change_at_worst)
    means = m.means + (thrusts - m.means) * (dt / AVERAGED)
    return ThrustShake(means, deviations, power, change, after, worse)


@law(absent="awake")
def kept_awake(m: ThrustShake, awake: Number) -> Number:
    """1 where the memory changes in every step, else `awake`."""
    return 1.0
