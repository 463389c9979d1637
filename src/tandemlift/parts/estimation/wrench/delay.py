"""The delay of the rotors: the known one, and its error as estimated in flight.

A pure delay T is a second-order Padé all-pass, exact for an input held over a step:

    y = u − (12/T) ż,    z̈ + (6/T) ż + (12/T²) z = u.

Its gain is 1 at every frequency, its phase that of the delay to (ω T)⁵/720 rad: a low-pass of the same delay would lose
gain where the pilot's loops cross. The poles are −a ± j b with a = 3/T, b = √3/T.

Rotors that are later than modelled by δ give f(t − δ) ≈ f − δ ḟ. So the force that the accelerometer shows beside the
modelled thrust, e = m a_z − f, has −δ ḟ in it. Faster than a hand changes, the pilot's own noise moves the thrust all
the time, so δ is found by least squares, with e and f through a low-pass of ω:

    δ̂ = −Σ ė f̈ / (Σ f̈² + c),    sums with a time constant T_δ; c is the variance of ė by noise over that of δ before.

Its standard deviation is σ_e/(σ_f̈ √n), the Cramér-Rao bound of n samples: 0.1 ms in `iris` after 4 s. An error of the
lag is one of the delay, too. A thrust that is wrong by a factor is not: its part in e is orthogonal to ḟ.
"""

from __future__ import annotations

from typing import Generic, NamedTuple

from tandemlift.core.algebra import clip, cos, exp, sin, sqrt
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.mechanics.low_pass import LowPass, LowPassState, V, flush_denormals, low_pass, low_pass_step
from tandemlift.parts.mechanics.rigid_body import Wrench

BAND = 60.0  # rad/s, ω: above a hand's pushes, below the delay of the rotors
MEMORY, LARGEST = 10.0, 0.01  # s, T_δ and the largest |δ̂|
PRIOR = 0.003  # s, standard deviation of δ before the first sample


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


class RotorDelay(NamedTuple):
    """The known delay; for δ, the vehicle's mass [kg], the low-pass, c [N²/s⁴], the sums' factor of a sample."""

    known: Delay
    mass: Number
    low_pass: LowPass
    prior: Number
    keep: Number


class RotorDelayState(NamedTuple):
    """Memory: of the known delay; e and f [N], low-passed; −Σ ė f̈ and Σ f̈² [N²/s⁴]; the last wrench so delayed."""

    thrust: DelayState[Number]
    moment: DelayState[Vec3]
    rest: LowPassState[Number]
    smooth: LowPassState[Number]
    product: Number
    square: Number
    before: Wrench


@law
def late_wrench(
    k: RotorDelay, m: RotorDelayState, made: Wrench, vertical: Number, free: Number, dt: Number
) -> tuple[Wrench, RotorDelayState]:
    """(the wrench of the rotors, later by the known delay and δ̂, the new memory).

    `vertical`: specific force along body z [m/s²]; `free`: 1 while no floor carries the vehicle, else 0.
    """
    f, thrust = delayed(k.known, m.thrust, made.thrust)
    M, moment = delayed(k.known, m.moment, made.moment)
    rest, smooth = low_pass_step(k.low_pass, m.rest, vertical * k.mass - f), low_pass_step(k.low_pass, m.smooth, f)
    curvature = ((f - smooth.value) * BAND - smooth.rate * 2.0) * BAND
    product = m.product * k.keep - rest.rate * curvature * free
    square = m.square * k.keep + curvature * curvature * free
    error = clip(product / (square + k.prior), -LARGEST, LARGEST) / dt
    later = Wrench(f - (f - m.before.thrust) * error, M - (M - m.before.moment) * error)
    return later, RotorDelayState(thrust, moment, rest, smooth, product, square, Wrench(f, M))


def rotor_delay(time: Number, mass: Number, noise: Number, interval: Number) -> tuple[RotorDelay, RotorDelayState]:
    """The delay by a known time [s] and its memory; `noise`: of the accelerometer at a sample [m/s²]."""
    still, sigma = LowPassState(0.0, 0.0), mass * noise / PRIOR
    prior = sigma * sigma * BAND**3 * (0.25 * interval)  # the variance of ė by noise is σ² ω³ T/4
    k = RotorDelay(delay_of(time, interval), mass, low_pass(BAND, interval), prior, exp(-interval / MEMORY))
    none = DelayState(0.0, 0.0), DelayState(ZERO, ZERO)
    return k, RotorDelayState(*none, still, still, 0.0, 0.0, Wrench(0.0, ZERO))
