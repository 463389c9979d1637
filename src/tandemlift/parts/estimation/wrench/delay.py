"""The delay of the rotors: the known one, and its error as estimated in flight.

A pure delay T is a second-order Padé all-pass, exact for an input held over a step:

    y = u − T q̇,    (T²/12) q̈ + (T/2) q̇ + q = u.

Its gain is 1 at every frequency, its phase that of the delay to (ω T)⁵/720 rad: a low-pass of the same delay would lose
gain where the pilot's loops cross. The poles are (−3 ± j √3)/T. The memory is q and T q̇: under a constant input it is
(u, 0) whatever T is, so that a change of T in flight moves nothing at rest.

Rotors that are later than modelled by δ give f(t − δ) ≈ f − δ ḟ. So the force that the accelerometer shows beside the
modelled thrust, e = m a_z − f, has −δ ḟ in it. Faster than a hand changes, the pilot's own noise moves the thrust all
the time, so δ is found by least squares, with e and f through a low-pass of ω:

    δ̂ = −Σ ė f̈ / (Σ f̈² + c),    sums with a time constant T_δ; c is the variance of ė by noise over that of δ before.

Its standard deviation is σ_e/(σ_f̈ √n), the Cramér-Rao bound of n samples: 0.1 ms in `iris` after 4 s. An error of the
lag is one of the delay, too. A thrust that is wrong by a factor is not: its part in e is orthogonal to ḟ.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import clip, cos, exp, maximum, sin, sqrt
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPass, LowPassState, V, low_pass, low_pass_step
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.estimation.wrench.kalman import LEAST_NOISE
from tandemlift.parts.mechanics.rigid_body import Wrench

BAND = 60.0  # rad/s, ω: above a hand's pushes, below the delay of the rotors
MEMORY, LARGEST = 10.0, 0.01  # s, T_δ and the largest |δ̂|
PRIOR = 0.003  # s, standard deviation of δ before the first sample


@law
def delayed(k: LowPass, memory: LowPassState[V], value: V) -> tuple[V, LowPassState[V]]:
    """(the delayed value at the end of a step with a constant input, the new memory of q and T q̇)."""
    after = low_pass_step(k, memory, value)
    return value - after.rate, after


def delay_of(time: Number, step: Number) -> LowPass:
    """The transition of (q − u, T q̇) over a step [s], by which T = `time` [s] is delayed."""
    h, b = step / time, sqrt(3.0)
    decay, c, s = exp(-3.0 * h), cos(b * h), sin(b * h)
    return LowPass(decay * (c + b * s), decay * s / b, -4.0 * b * decay * s, decay * (c - b * s))


class RotorDelay(NamedTuple):
    """The known delay; for δ, the vehicle's mass [kg], the low-pass, c [N²/s⁴], the sums' factor of a sample."""

    known: LowPass
    mass: Number
    low_pass: LowPass
    prior: Number
    keep: Number


class RotorDelayState(NamedTuple):
    """Memory: of the known delay; e and f [N], low-passed; −Σ ė f̈ and Σ f̈² [N²/s⁴]; the last wrench so delayed."""

    thrust: LowPassState[Number]
    moment: LowPassState[Vec3]
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
    still, sigma = LowPassState(0.0, 0.0), mass * maximum(noise, LEAST_NOISE) / PRIOR
    prior = sigma * sigma * BAND**3 * (0.25 * interval)  # the variance of ė by noise is σ² ω³ T/4
    k = RotorDelay(delay_of(time, interval), mass, low_pass(BAND, interval), prior, exp(-interval / MEMORY))
    return k, RotorDelayState(still, LowPassState(ZERO, ZERO), still, still, 0.0, 0.0, Wrench(0.0, ZERO))
