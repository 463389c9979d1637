"""A hand that shakes: the faster a push alternates, the less of it is followed and compensated.

A push is compensated by tilt, and the admittance multiplies it by the vehicle's mass over the virtual one. A push that
alternates faster than the attitude can follow would be compensated late, and so add to itself, while it moves the
vehicle itself by F/(m ω²) only. So its fast part, what a slow low-pass leaves of it, is followed by the share
T/max(Ḟ, T), with Ḟ twice the smaller mean of its rises and falls [N/s], summed over the axes: about |Ḟ| of a push that
alternates, and none of a push that only rises, however steeply. Below T nothing is changed, to the last bit.
The low-pass takes no more of a push than the reference can follow, or a hard tap would be followed when it is over.

T is that of a sine at the attitude's crossover, whose second derivative asks for a share of the vehicle's largest
angular acceleration in hover: (2/π) share L/ω.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tandemlift.core.algebra import clip, maximum, minimum, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.types import Number, number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.mechanics.vehicle import Vehicle

MEAN_BANDWIDTH = 5.0  # rad/s, of the low-pass: a shake of 0.8 Hz is halved
NOTICE_TIME, FORGET_TIME = 0.17, 0.7  # s, time constants of the means as they grow and decay
NOISE_SHARE = 0.5  # of T: what is noise, and no rise or fall
NO_LIMIT = 1e9  # N/s, of a vehicle whose rotors cannot hover
CROSSOVER = 14.0  # rad/s, of the attitude loop


class Alternation(NamedTuple):
    """The slow low-pass, and how much of a push it takes beyond what holds the speed [N]; the rates at which the means
    grow and decay [1/s], the least rate that counts, and T [N/s].
    """

    slow: LowPass
    most: Vec3
    noticing: Number
    forgetting: Number
    least: Number
    limit: Number


class AlternationState(NamedTuple):
    """Memory: the slow part of a push [N], and the means of its rises and of its falls [N/s]."""

    slow: LowPassState[Vec3]
    rises: Vec3
    falls: Vec3


@elementwise
def averaged(mean: Number, rate: Number, least: Number, noticing: Number, forgetting: Number) -> Number:
    """The mean of a rate beyond the least, after a step: it grows or decays by a part of the difference."""
    more = maximum(rate - least, 0.0) - mean
    return mean + more * where(more > least, noticing, forgetting)


@law
def alternation_step(
    k: Alternation, memory: AlternationState, push: LowPassState[Vec3], holds: Vec3, dt: Number
) -> AlternationState:
    """The memory after a step with a push [N]; `holds` [N]: the push that holds the reference's speed."""
    growing, decaying = k.noticing * dt, k.forgetting * dt
    return AlternationState(
        low_pass_step(k.slow, memory.slow, holds + clip(push.value - holds, -k.most, k.most)),
        averaged(memory.rises, push.rate, k.least, growing, decaying),
        averaged(memory.falls, -push.rate, k.least, growing, decaying),
    )


@elementwise
def smaller(a: Number, b: Number) -> Number:
    """The smaller of two numbers."""
    return minimum(a, b)


@law
def mean_rate(m: AlternationState) -> Number:
    """Ḟ [N/s], the mean rate of a push that alternates."""
    least = smaller(m.rises, m.falls)
    return 2.0 * (least.x + least.y + least.z)


@law
def calmed(k: Alternation, m: AlternationState, push: LowPassState[Vec3]) -> LowPassState[Vec3]:
    """The push that is followed and compensated [N]: with less of its fast part where it alternates too fast."""
    left_out = 1.0 - k.limit / maximum(mean_rate(m), k.limit)
    value, rate = push.value - m.slow.value, push.rate - m.slow.rate
    return LowPassState(push.value - value * left_out, push.rate - rate * left_out)


def start_alternation(
    share: Number, most: Vec3, vehicle: Vehicle, moments: tuple[Number, Number], step: float
) -> tuple[Alternation, AlternationState]:
    """The limit of a push that alternates, and its memory before the first sample.

    Args:
        share: of the largest roll or pitch acceleration in hover, for which a push may ask.
        most: the push along each axis at which the reference's acceleration is at its limit, at rest [N].
        vehicle: as the pilot assumes it.
        moments: the largest roll and pitch moments in hover [N·m].
        step: sampling time [s].
    """
    found = (2.0 / math.pi / CROSSOVER) * share * force_curvature(vehicle, moments)
    limit = where(found > 0.0, found, NO_LIMIT)
    quiet = AlternationState(LowPassState(ZERO, ZERO), ZERO, ZERO)
    return Alternation(
        low_pass(MEAN_BANDWIDTH, step), most, 1.0 / NOTICE_TIME, 1.0 / FORGET_TIME, NOISE_SHARE * limit, limit
    ), quiet


def force_curvature(vehicle: Vehicle, moments: tuple[Number, Number]) -> Number:
    """L [N/s²], the largest second derivative of a horizontal force in hover: the weight times angular acceleration."""
    (roll, pitch), J = moments, vehicle.inertia
    return vehicle.weight * minimum(roll / number(J[0, 0]), pitch / number(J[1, 1]))
