"""A steady-state Kalman filter: the force from the accelerometer, the moment from the gyroscope, both with the model.

The wrench is a random walk that changes by q [N/√s, N·m/√s] within a second (one standard deviation). Along each axis,

    F₊ = F + w,                    measured by  y = m (a + g e_z) − R e_z f = F + v,   v of m σ_a,
    ω₊ = ω + (M/J + d) T,  d₊ = d + w/J,        measured by the gyroscope, of σ_ω,     τ = J d.

The models do not change in time, so the gains are those of the steady covariance, in closed form. Force: with
λ = q² T/(m σ_a)², the prior variance over that of v is p = (λ + √(λ² + 4 λ))/2, the gain p/(1 + p); it converges as a
low-pass of q/(m σ_a √T). Moment: the Kalman-Bucy filter has two poles at ω_n e^{±3πj/4}, ω_n = √(q/(J σ_ω √T)), which
the gains of a step place exactly; the variance of its error is √2 q^{3/2} (J σ_ω √T)^{1/2} in the limit of short steps,
a delay of √2/ω_n. R. E. Kalman and R. S. Bucy, J. Basic Engineering 83, 1961.

Assumption: wind, model error and the accelerometer's bias are in the wrench. Attitude is the navigator's, whose error
of δ turns the thrust by f δ: the tare removes the constant part.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import cos, exp, maximum, sqrt
from tandemlift.core.law import elementwise
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.estimation.wrench.observation import (
    ExternalWrench,
    NominalBody,
    Observation,
    modelled_moment,
    observe,
    principal,
    unexplained_force,
)
from tandemlift.parts.mechanics.rigid_body import apply_inertia

LEAST_NOISE = 1e-9  # of any unit: with less the filter would follow a sample at once


class KalmanObserver(NamedTuple):
    """The vehicle; gains of the force, of the rates (0 to 1), and of the angular acceleration on the rates [1/s]."""

    body: NominalBody
    force: Vec3
    rates: Vec3
    turning: Vec3


class KalmanState(NamedTuple):
    """Memory: force [N, world axes]; rates as predicted [rad/s], angular acceleration d [rad/s²], body axes.

    `started` is 1 after the first sample, from whose rates the prediction starts, else 0.
    """

    force: Vec3
    rates: Vec3
    turning: Vec3
    started: Number


@observe.register(KalmanObserver)
def _observe(k: KalmanObserver, m: KalmanState, x: Observation) -> tuple[ExternalWrench, KalmanState]:
    force = m.force + (unexplained_force(k.body, x) - m.force) * k.force
    off = (x.state.rates - m.rates) * m.started
    turning = m.turning + off * k.turning
    rates = x.state.rates - off + off * k.rates
    known = apply_inertia(k.body.inverse_inertia, modelled_moment(k.body, x))
    after = KalmanState(force, rates + (known + turning) * x.dt, turning, 1.0)
    return ExternalWrench(force, apply_inertia(k.body.inertia, turning)), after


@elementwise
def steady_gain(change: Number, noise: Number, interval: Number) -> Number:
    """The Kalman gain of a random walk of `change` [U/√s] that is measured with `noise` [U] every `interval` [s]."""
    ratio = change / maximum(noise, LEAST_NOISE)
    squared = ratio * ratio * interval
    prior = 0.5 * (squared + sqrt(squared * squared + 4.0 * squared))
    return prior / (1.0 + prior)


@elementwise
def natural_frequency(change: Number, noise: Number, interval: Number) -> Number:
    """ω_n [rad/s] of the filter of a random walk's integral; `noise` of a measurement of the integral."""
    return sqrt(change / (maximum(noise, LEAST_NOISE) * sqrt(interval)))


def turning_gains(frequency: Number, interval: Number) -> tuple[Number, Number]:
    """(gain of the rates, gain of the angular acceleration [1/s]) with poles at ω_n e^{±3πj/4}."""
    angle = frequency * interval * sqrt(0.5)
    size = exp(-angle)
    square = size * size
    return 1.0 - square, (1.0 + square - 2.0 * size * cos(angle)) / interval


def kalman_observer(
    body: NominalBody,
    force_change: Vec3,
    moment_change: Vec3,
    accelerometer: Number,
    gyroscope: Number,
    interval: Number,
) -> tuple[KalmanObserver, KalmanState]:
    """The filter and its memory before the first sample.

    Args:
        body: the nominal vehicle.
        force_change: q of the force [N/√s]; `moment_change`, of the moment [N·m/√s].
        accelerometer: noise of a sample [m/s²]; `gyroscope`, likewise [rad/s].
        interval: between samples [s].
    """
    frequency = natural_frequency(moment_change, principal(body.inertia) * gyroscope, interval)
    rates, turning = zip(*[turning_gains(w, interval) for w in frequency], strict=True)
    gains = steady_gain(force_change, body.mass * accelerometer, interval)
    return KalmanObserver(body, gains, Vec3(*rates), Vec3(*turning)), KalmanState(ZERO, ZERO, ZERO, 0.0)
