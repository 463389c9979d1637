"""An error-state extended Kalman filter: pose, twist and wrench from motion capture, gyroscope and the model.

The error state is (δp, δv, δθ, δω, F, τ), 18 numbers, with F and τ random walks:

    δṗ = δv,  m δv̇ = δF,        δθ̇ = δω,  J δω̇ = δτ.

Motion capture measures p, v and the attitude, the gyroscope ω; there is no accelerometer in it. The nominal state moves
by the whole model, with the estimated attitude and its gyroscopic moment. Of the Jacobian the terms are left out that
couple axes: of the tilt on the force, f δθ, and of the rates on each other, J⁻¹(…)δω. Then the covariance falls into
six blocks of three, which are kept as numbers of one law for each three axes. An attitude that is wrong by δ is thus a
force of f δ. (J. Solà, Quaternion kinematics for the error-state Kalman filter, arXiv 1711.02508, 2017.) Measurements
are uncorrelated, so each updates a block by itself, in turn, which is the same as all at once.

Assumption: wind and model error are in the wrench.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, maximum
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.estimation.wrench.observation import ExternalWrench, NominalBody, Observation, observe
from tandemlift.parts.mechanics.rigid_body import UP, apply_inertia, gyroscopic
from tandemlift.parts.mechanics.rotation import body_z_axis, normalised, rotated_by, rotation_between

ONES = Vec3(1.0, 1.0, 1.0)
UNKNOWN = 1.0  # (m/s²)² and (rad/s²)²: variance of the loads at the start


class BlockCovariance(NamedTuple):
    """The covariance of value, rate and load along three axes: its six different elements, each of the three axes."""

    value: Vec3
    value_rate: Vec3
    value_load: Vec3
    rate: Vec3
    rate_load: Vec3
    load: Vec3


class Correction(NamedTuple):
    """Corrections of value, rate and load by a measurement, along three axes."""

    value: Vec3
    rate: Vec3
    load: Vec3


class ExtendedKalmanFilter(NamedTuple):
    """The vehicle; variances: of the loads' change in one second, and of a measurement.

    Loads are accelerations: `force_change` [m²/s⁴ per s] and `moment_change` [rad²/s⁴ per s]. Measurements: `position`
    [m²], `velocity` [m²/s²], `attitude` [rad²], `rates` [rad²/s²].
    """

    body: NominalBody
    force_change: Vec3
    moment_change: Vec3
    position: Number
    velocity: Number
    attitude: Number
    rates: Number


class FilterState(NamedTuple):
    """Memory: the nominal state as predicted, the loads [m/s², world axes; rad/s², body axes] and both covariances.

    `started` is 1 after the first sample of motion capture, at which the state begins, else 0.
    """

    position: Vec3
    velocity: Vec3
    attitude: Quat
    rates: Vec3
    acceleration: Vec3
    turning: Vec3
    translation: BlockCovariance
    rotation: BlockCovariance
    started: Number


@law
def predicted(P: BlockCovariance, change: Vec3, dt: Number) -> BlockCovariance:
    """F P Fᵀ + Q after dt [s]: value' = rate, rate' = load, the load a random walk with this variance after 1 s."""
    half = 0.5 * dt * dt
    value = P.value + P.value_rate * dt + P.value_load * half  # F P, row by row
    value_rate = P.value_rate + P.rate * dt + P.rate_load * half
    value_load = P.value_load + P.rate_load * dt + P.load * half
    rate, rate_load = P.rate + P.rate_load * dt, P.rate_load + P.load * dt
    return BlockCovariance(
        value=value + value_rate * dt + value_load * half,
        value_rate=value_rate + value_load * dt,
        value_load=value_load,
        rate=rate + rate_load * dt,
        rate_load=rate_load,
        load=P.load + change * dt,
    )


@law
def by_value(P: BlockCovariance, off: Vec3, variance: Number, fresh: Number) -> tuple[Correction, BlockCovariance]:
    """(corrections, the covariance) after a measurement of the value, `off` from the prediction, if `fresh` (1)."""
    scale = ONES * fresh / (P.value + ONES * variance)
    gain = Correction(P.value * scale, P.value_rate * scale, P.value_load * scale)
    return corrections(gain, off), reduced(P, gain, P.value, P.value_rate, P.value_load)


@law
def by_rate(P: BlockCovariance, off: Vec3, variance: Number, fresh: Number) -> tuple[Correction, BlockCovariance]:
    """The same after a measurement of the rate."""
    scale = ONES * fresh / (P.rate + ONES * variance)
    gain = Correction(P.value_rate * scale, P.rate * scale, P.rate_load * scale)
    return corrections(gain, off), reduced(P, gain, P.value_rate, P.rate, P.rate_load)


@law
def corrections(gain: Correction, off: Vec3) -> Correction:
    """The gains times a difference."""
    return Correction(gain.value * off, gain.rate * off, gain.load * off)


@law
def reduced(P: BlockCovariance, gain: Correction, value: Vec3, rate: Vec3, load: Vec3) -> BlockCovariance:
    """P − K H P for a scalar measurement along each axis; (value, rate, load): the row H P."""
    return BlockCovariance(
        value=P.value - gain.value * value,
        value_rate=P.value_rate - gain.value * rate,
        value_load=P.value_load - gain.value * load,
        rate=P.rate - gain.rate * rate,
        rate_load=P.rate_load - gain.rate * load,
        load=P.load - gain.load * load,
    )


@law
def begun(m: FilterState, x: Observation) -> FilterState:
    """The memory, which is at the observed state until the first sample of motion capture."""
    s, on = x.state, m.started
    return m._replace(
        position=chosen(on, m.position, s.position),
        velocity=chosen(on, m.velocity, s.velocity),
        attitude=chosen(on, m.attitude, s.attitude),
        rates=chosen(on, m.rates, s.rates),
    )


@observe.register(ExtendedKalmanFilter)
def _observe(k: ExtendedKalmanFilter, m: FilterState, x: Observation) -> tuple[ExternalWrench, FilterState]:
    m = begun(m, x)
    by_position, P = by_value(m.translation, x.position - m.position, k.position, x.fresh)
    velocity = m.velocity + by_position.rate
    by_velocity, P = by_rate(P, x.velocity - velocity, k.velocity, x.fresh)
    acceleration = m.acceleration + by_position.load + by_velocity.load
    by_attitude, S = by_value(m.rotation, rotation_between(m.attitude, x.attitude), k.attitude, x.fresh)
    rates = m.rates + by_attitude.rate
    by_gyroscope, S = by_rate(S, x.state.rates - rates, k.rates, 1.0)
    rates, turning = rates + by_gyroscope.rate, m.turning + by_attitude.load + by_gyroscope.load
    attitude = rotated_by(m.attitude, by_attitude.value + by_gyroscope.value)
    velocity = velocity + by_velocity.rate
    thrust = body_z_axis(attitude) * (x.rotors.thrust * (1.0 / k.body.mass))
    linear = thrust - UP * GRAVITY + acceleration
    known = x.rotors.moment + gyroscopic(k.body.inertia, rates)
    angular = apply_inertia(k.body.inverse_inertia, known) + turning
    dt = x.dt
    after = FilterState(
        position=m.position + by_position.value + by_velocity.value + velocity * dt + linear * (0.5 * dt * dt),
        velocity=velocity + linear * dt,
        attitude=normalised(rotated_by(attitude, rates * dt + angular * (0.5 * dt * dt))),
        rates=rates + angular * dt,
        acceleration=acceleration,
        turning=turning,
        translation=predicted(P, k.force_change, dt),
        rotation=predicted(S, k.moment_change, dt),
        started=maximum(m.started, x.fresh),
    )
    return ExternalWrench(acceleration * k.body.mass, apply_inertia(k.body.inertia, turning)), after


def start_filter(k: ExtendedKalmanFilter) -> FilterState:
    """The memory before the first sample: a state as uncertain as a measurement of it, and an unknown wrench."""
    level, one = Quat(1.0, 0.0, 0.0, 0.0), ONES
    return FilterState(
        position=ZERO,
        velocity=ZERO,
        attitude=level,
        rates=ZERO,
        acceleration=ZERO,
        turning=ZERO,
        translation=BlockCovariance(one * k.position, ZERO, ZERO, one * k.velocity, ZERO, one * UNKNOWN),
        rotation=BlockCovariance(one * k.attitude, ZERO, ZERO, one * k.rates, ZERO, one * UNKNOWN),
        started=0.0,
    )
