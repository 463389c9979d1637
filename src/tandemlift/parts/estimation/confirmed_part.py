"""The part of a measured push F̂ that the force r on the quadrotors besides thrust confirms, along one body axis.

    a push P                      F̂ = P,        r = 0;
    joints that are wrong by j_i  F̂ = −Σ j_i,   r = Σ j_i, so that F̂ + r = 0: nothing pushes the vehicle;
    wind                          F̂ = ρ r,      ρ the ratio of the drag areas of payload and quadrotors;
    an accelerometer wrong by α   F̂ = m_L α,    r = Σ m_i α, like wind with ρ = m_L / Σ m_i.

Nothing of F̂ is confirmed while F̂ + r is below 0.4 F̂, all of it above 0.6 F̂. The part of r within three times the
standard deviation of F̂ + r without a push is due to gusts on the quadrotors, and refutes nothing. Wind subtracts ρ r
less a tolerance from F̂ if ρ r is above 0.6 F̂, and nothing below 0.4 F̂, so that a long push is not misclassified as
wind when the sensors drift. A part of the size of the tolerance always remains. The tolerance is half the threshold of
a push, so the rest stays below the threshold, even after the bias of the dead band has followed an opposite error.

r is measured from its mean over the tare, and F̂ from an offset. A part that stays unconfirmed becomes their new zero:
a joint that jumps is tared again within seconds, and pushes are followed as before. The same holds for a drift of the
joints, the common part of F̂ and −r: fast without a push, slowly during one. The confirmation of a push decays
gradually, so that an opposite gust on the quadrotors does not end the push.

Limits: wind that acts on the payload alone counts as a push. A gust on the quadrotors against a push weakens it, if it
is larger than 0.4 of the push and lasts; in gusts, joints may be wrong by as much.
"""

from __future__ import annotations

from typing import Generic, NamedTuple

from tandemlift.core.algebra import absolute, clip, maximum, minimum, sqrt, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, V, low_pass_step
from tandemlift.core.types import Number

REFUTED_SHARE = 0.4  # unexplained share of a push up to which none is confirmed
CONFIRMED_SHARE = 0.6  # and from which on all is
RELEARN_TIME = 2.0  # s, in which an unconfirmed part becomes the new zero
QUIET_TIME = 1.0  # s, in which a drift of the joints does without a push
DRIFT_TIME = 20.0  # s, in which it does during one, and the mean of r follows other drifts
RISE_TIME, FALL_TIME = 0.7, 0.5  # s, in which a push counts as recently confirmed, and in which the confirmation decays
GUSTS, GUST_TIME = 3.0, 5.0  # standard deviations of F̂ + r that count as gusts; s, time constant of its mean square
DRIFT_LIMIT = 4.0  # tolerances: a larger r, such as the floor's force, is no drift
LARGE_PUSH = 3.0  # tolerances: of a larger push …
LITTLE_PUSH = 1.5  # … less than this is left where it is refuted
NEGLIGIBLE = 0.1  # of a tolerance
TINY = 1e-12  # N


class Zero(NamedTuple, Generic[V]):
    """The zeros of r (`mean`) and of the push (`offset`), and the memory of both.

    `slow`: F̂ with the low-pass of r; `square`: mean of (F̂ + r)² while there is no push; `lately`: the recently
    confirmed push. Forces [N] or moments [N·m].
    """

    mean: V
    offset: V
    slow: LowPassState[V]
    square: V
    lately: V


class Confirmed(NamedTuple, Generic[V]):
    """The unconfirmed part of a push, 1 per axis where the motion refutes it, else 0, and the new `Zero`."""

    withheld: V
    refuted: V
    zero: Zero[V]


@elementwise
def confirmed_fraction(share: Number) -> Number:
    """The confirmed fraction of a push, 0 to 1, from the fraction that has no other explanation."""
    return clip((share - REFUTED_SHARE) * (1.0 / (CONFIRMED_SHARE - REFUTED_SHARE)), 0.0, 1.0)


@elementwise
def confirmed(push: Number, rest: Number, square: Number, tolerance: Number, ratio: Number) -> Number:
    """The confirmed part of a push beside which `rest` acts on the quadrotors; `square`: see `Zero`."""
    size = absolute(push)
    along = where(push < 0.0, -rest, rest)
    against = minimum(along + GUSTS * sqrt(maximum(square, TINY)), 0.0)
    per_size = 1.0 / maximum(size, TINY)
    moving = maximum(tolerance, size * confirmed_fraction(1.0 + against * per_size))
    wind = (ratio * along - tolerance) * (1.0 - confirmed_fraction(1.0 - ratio * along * per_size))
    left = maximum(minimum(minimum(size, moving), size - maximum(wind, 0.0)), 0.0)
    return where(push < 0.0, -left, left)


@elementwise
def is_refuted(push: Number, left: Number, off: Number, tolerance: Number) -> Number:
    """1 for a push that is almost entirely refuted because the vehicle does not move along with it, else 0."""
    refuted = where(push * off < 0.0, where(absolute(left) < LITTLE_PUSH * tolerance, 1.0, 0.0), 0.0)
    return where(absolute(push) > LARGE_PUSH * tolerance, refuted, 0.0)


@elementwise
def mean_change(push: Number, left: Number, off: Number, tolerance: Number, dt: Number) -> Number:
    """The change of r's mean in a step in which the offset follows the rejected part; `off`: r less its mean.

    The mean follows the explanation of the rejected part, the error of the joints or the wind. If nothing is rejected,
    the mean follows a drift along the push; an opposite drift is a `joint_drift`.
    """
    withheld = absolute(push - left)
    along = where(push * off < 0.0, 0.0, where(absolute(off) < DRIFT_LIMIT * tolerance, 1.0, 0.0))
    drifts = where(withheld < NEGLIGIBLE * tolerance, along, 0.0)
    explained = where(push * off < 0.0, left - push, off * withheld / maximum(absolute(push), TINY))
    return off * drifts * (dt / DRIFT_TIME) + explained * (dt / RELEARN_TIME)


@elementwise
def square_change(push: Number, load: Number, square: Number, tolerance: Number, dt: Number) -> Number:
    """The change of the mean square of a load F̂ + r in a step; none during a push, and slow for outliers."""
    usual = minimum(load * load, 9.0 * square + tolerance * tolerance)
    return where(absolute(push) < tolerance, usual - square, 0.0) * (dt / GUST_TIME)


@elementwise
def joint_drift(push: Number, off: Number, tolerance: Number, dt: Number) -> Number:
    """The change of the offset in a step by joints that drift, as r less its mean shows; that changes the other way."""
    least = minimum(absolute(push), absolute(off))
    common = least * least / (least + NEGLIGIBLE * tolerance)  # its slope at rest is 0, whichever sign noise has there
    rate = dt * where(absolute(push) < tolerance, 1.0 / QUIET_TIME, 1.0 / DRIFT_TIME)
    return where(push * off < 0.0, where(push < 0.0, -common, common) * rate, 0.0)


@elementwise
def given_up_slowly(push: Number, left: Number, lately: Number) -> Number:
    """The remaining part of a push: at least the recently confirmed one."""
    kept = where(push * lately > 0.0, minimum(absolute(push), absolute(lately)), 0.0)
    more = maximum(absolute(left), kept)
    return where(push < 0.0, -more, more)


@elementwise
def lately_change(left: Number, lately: Number, dt: Number) -> Number:
    """The change in a step of the recently confirmed push."""
    grown = where(absolute(left) > absolute(lately), 1.0 / RISE_TIME, 1.0 / FALL_TIME)
    return (left - lately) * dt * where(left * lately < 0.0, 1.0 / FALL_TIME, grown)


@law
def compared(
    low_pass: LowPass, zero: Zero[V], push: V, rest: V, tolerance: V, ratio: V, tare: Number, dt: Number
) -> Confirmed[V]:
    """Compare a push with `rest`, that is r, and return its unconfirmed part.

    F̂ and r are low-passed. `tare`: share of this sample in the mean over the tare; 0 once that is over. `dt`: since the
    last sample [s]; 0 without learning, as before the end of the tare.
    """
    force, off = push - zero.offset, rest - zero.mean
    now = confirmed(force, off, zero.square, tolerance, ratio)
    left = given_up_slowly(force, now, zero.lately)
    lately = zero.lately + lately_change(now, zero.lately, dt)
    drift = joint_drift(force, off, tolerance, dt)
    mean = zero.mean + off * tare + mean_change(force, left, off, tolerance, dt) - drift
    slow = low_pass_step(low_pass, zero.slow, push)
    square = zero.square + square_change(force, slow.value - zero.offset + off, zero.square, tolerance, dt)
    offset = zero.offset + (force - left) * (dt / RELEARN_TIME) + drift
    return Confirmed(push - left, is_refuted(force, now, off, tolerance), Zero(mean, offset, slow, square, lately))
