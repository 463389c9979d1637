"""The dead band of a push: above a threshold, after a dwell, until a release; and the bias learned meanwhile."""

from __future__ import annotations

from typing import Generic, NamedTuple

from tandemlift.core.algebra import absolute, clip, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.low_pass import LowPass, V
from tandemlift.core.types import Number
from tandemlift.parts.guidance.admittance import soft_threshold

QUIET_TIME = 2.0  # s without a push, after which the bias is estimated
BIAS_CLIP = 0.3  # of the threshold: the largest deviation from the mean that counts for the bias
BIAS_RATE = 0.5  # 1/s, at which the bias follows the mean, with a lag of two seconds


class DeadBand(NamedTuple, Generic[V]):
    """Threshold [N] above which a push is active, and `release` [N] below which it ends; `dwell` [s] before it starts.

    `bias_rate` [1/s]: of the mean that becomes the bias, while no push was active for `QUIET_TIME`.
    """

    threshold: V
    release: V
    dwell: Number
    bias_rate: Number


class PushFilters(NamedTuple):
    """The filters of a push before and after its dead band."""

    input: LowPass
    output: LowPass
    release_fraction: Number
    dwell: Number
    bias_time_constant: Number

    def dead_band(self, threshold: V) -> DeadBand[V]:
        """The dead band for a threshold [N or N·m]."""
        return DeadBand(threshold, threshold * self.release_fraction, self.dwell, 1.0 / self.bias_time_constant)


class DeadBandState(NamedTuple, Generic[V]):
    """Memory: 1 while a push is active, else 0; times [s] above the threshold, and without an active push; bias.

    The bias follows the `mean` with a lag, and the mean returns to it if a push begins.
    """

    active: V
    above_time: V
    inactive_time: V
    mean: V
    bias: V


@elementwise
def is_active(
    active: Number, above_time: Number, force: Number, threshold: Number, release: Number, dwell: Number
) -> Number:
    """1 while a push is active: once it was above the threshold for the dwell, until it is below the release."""
    begins = where(absolute(force) > threshold, where(above_time < dwell, 0.0, 1.0), 0.0)
    return where(active > 0.0, where(absolute(force) < release, 0.0, 1.0), begins)


@elementwise
def time_above(above_time: Number, force: Number, threshold: Number, dt: Number) -> Number:
    """The time for which a push has been above the threshold [s]."""
    return where(absolute(force) > threshold, above_time + dt, 0.0)


@elementwise
def time_inactive(inactive_time: Number, active: Number, dt: Number) -> Number:
    """The time without an active push [s]."""
    return (inactive_time + dt) * (1.0 - active)


@elementwise
def bias_input(force: Number, bound: Number, inactive_time: Number) -> Number:
    """The input of the mean: the force within a bound, once no push was active for `QUIET_TIME`."""
    return where(inactive_time < QUIET_TIME, 0.0, clip(force, -bound, bound))


@elementwise
def unless_active(active: Number, old: Number, new: Number) -> Number:
    """The old value while a push is active, else the new one."""
    return where(active > 0.0, old, new)


@law
def dead_band(k: DeadBand[V], m: DeadBandState[V], force: V, enabled: Number, dt: Number) -> tuple[V, DeadBandState[V]]:
    """(the part of an active force beyond the threshold, the new memory); while `enabled` is 0, no push is active."""
    f = force - m.bias
    above = time_above(m.above_time, f, k.threshold, dt) * enabled
    active = is_active(m.active, above, f, k.threshold, k.release, k.dwell) * enabled
    inactive = time_inactive(m.inactive_time, active, dt) * enabled
    deviation = bias_input(force - m.mean, k.threshold * BIAS_CLIP, inactive)
    # a push that begins resets the mean, so that what came before the dwell does not become bias
    mean = unless_active(active, m.bias, m.mean + deviation * (k.bias_rate * dt))
    bias = m.bias + (mean - m.bias) * (BIAS_RATE * dt)
    return soft_threshold(f, k.threshold) * active, DeadBandState(active, above, inactive, mean, bias)
