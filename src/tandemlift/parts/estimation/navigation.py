"""The state of the vehicle from its inertial sensors, corrected by the motion measurement.

A strapdown observer: gyroscope and accelerometer propagate attitude, velocity and position of their location (the
payload's origin) from sample to sample; each motion sample corrects them with fixed gains and updates the
estimates of both sensors' bias. The error of every axis (attitude with gyroscope's bias, velocity with accelerometer's)
obeys e₊ = (1 − ℓ)(e + T b), b₊ = b − (1 − z)²/T (e + T b) from one motion sample to the next, T later: two poles at
z = exp(−ω T) for ℓ = 1 − z². Position has one.

The attitude is exact for constant rates, velocity and position for an acceleration that changes linearly. Constant
biases leave no error. The estimate is of the state at the time of the IMU's last sample; a motion sample that is older
by `age`, because its delay is longer, is compared with the state at that time. Without `age`, a relative delay δ leaves
the errors ω δ, v δ and a δ; the state is as late as the IMU is.

Method: P. D. Groves, Principles of GNSS, inertial, and multisensor integrated navigation systems, 2nd ed., chapter 5;
bias by integral action on the attitude: R. Mahony, T. Hamel and J.-M. Pflimlin, IEEE Trans. Automatic Control 53, 2008.
"""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from tandemlift.core.algebra import exp, maximum, where
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number, number
from tandemlift.core.vector import ZERO, Quat, Vec3, apply, apply_transposed, cross, vec3
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.mechanics.rigid_body import UP, State
from tandemlift.parts.mechanics.rotation import normalised, rotated_by, rotation_between, rotation_from_quaternion
from tandemlift.parts.sensors.readings import ImuReading, MotionReading, Readings
from tandemlift.parts.sensors.sensors_table import SensorsTable, steps_of


class Navigator(NamedTuple):
    """Gains of the observer.

    `interval` of the IMU's samples [s]; `centre`: the system's centre of mass from the IMU [m, body axes]; `age`: how
    much older a motion sample is than the IMU's sample in the same readings [s]. Gains on a motion sample's rotation,
    velocity and position (0 to 1), and of the biases on its rotation and velocity [1/s]. `rates`: share of a new sample
    in the smoothed rates.
    """

    interval: Number
    centre: Vec3
    age: Number
    attitude: Number
    velocity: Number
    position: Number
    gyroscope: Number
    accelerometer: Number
    rates: Number


class NavigationState(NamedTuple):
    """Memory: the estimate of the IMU's point, and the inputs of its next step.

    Position [m], velocity [m/s] and acceleration [m/s²] in world axes, attitude, rates as last measured and smoothed
    [rad/s]; bias of gyroscope [rad/s] and accelerometer [m/s²], body axes; `started` is 1 after the first sample.
    """

    position: Vec3
    velocity: Vec3
    acceleration: Vec3
    attitude: Quat
    measured_rates: Vec3
    rates: Vec3
    gyroscope_bias: Vec3
    accelerometer_bias: Vec3
    started: Number


@law
def propagated(k: Navigator, m: NavigationState, imu: ImuReading) -> NavigationState:
    """The estimate propagated to the IMU's sample, if that is fresh."""
    T = k.interval * imu.fresh * m.started
    rates = (m.measured_rates + imu.rates) * 0.5 - m.gyroscope_bias
    attitude = rotated_by(m.attitude, rates * T)
    new = apply(rotation_from_quaternion(attitude), imu.specific_force - m.accelerometer_bias) - UP * GRAVITY
    # the acceleration changes linearly over T: its integrals are (a₀ + a₁) T/2 and (2 a₀ + a₁) T²/6
    acceleration = (m.acceleration + new) * 0.5
    smoothed = m.rates + (imu.rates - m.gyroscope_bias - m.rates) * (k.rates * imu.fresh)
    return m._replace(
        position=m.position + m.velocity * T + (m.acceleration * 2.0 + new) * (T * T * (1.0 / 6.0)),
        velocity=m.velocity + acceleration * T,
        acceleration=where(imu.fresh > 0.0, new, m.acceleration),
        attitude=attitude,
        measured_rates=imu.rates,
        rates=smoothed,
        started=maximum(m.started, imu.fresh),
    )


@law
def centre_of_mass(k: Navigator, m: NavigationState) -> State:
    """The state of the system's centre of mass."""
    R = rotation_from_quaternion(m.attitude)
    return State(m.position + apply(R, k.centre), m.velocity + apply(R, cross(m.rates, k.centre)), m.attitude, m.rates)


@law
def innovation(k: Navigator, m: NavigationState, motion: MotionReading) -> tuple[Vec3, Vec3, Vec3]:
    """A motion sample less the estimate at its time, `age` before.

    Rotation [rad, body axes]; velocity [m/s] and position [m], world axes.
    """
    s, ago = centre_of_mass(k, m), k.age
    return (
        rotation_between(s.attitude, motion.attitude) + s.rates * ago,
        motion.velocity - (s.velocity - m.acceleration * ago),
        motion.position - (s.position - s.velocity * ago + m.acceleration * (0.5 * ago * ago)),
    )


@law
def corrected(k: Navigator, m: NavigationState, motion: MotionReading) -> NavigationState:
    """The estimate after a motion sample, if that is fresh."""
    (turn, velocity, position), fresh = innovation(k, m, motion), motion.fresh
    velocity_body = apply_transposed(rotation_from_quaternion(m.attitude), velocity)
    return m._replace(
        position=m.position + position * (k.position * fresh),
        velocity=m.velocity + velocity * (k.velocity * fresh),
        attitude=normalised(rotated_by(m.attitude, turn * (k.attitude * fresh))),
        gyroscope_bias=m.gyroscope_bias - turn * (k.gyroscope * fresh),
        accelerometer_bias=m.accelerometer_bias - velocity_body * (k.accelerometer * fresh),
    )


@law
def navigate(k: Navigator, memory: NavigationState, readings: Readings) -> tuple[State, NavigationState]:
    """(State of the system's centre of mass at the IMU's last sample, the new memory)."""
    after = corrected(k, propagated(k, memory, readings.imu), readings.motion)
    return centre_of_mass(k, after), after


def navigator_from(e: EstimatorTable, s: SensorsTable, centre: ArrayLike, step: float) -> Navigator:
    """The observer with these sensors, run every `step` [s]; `centre`: the system's centre of mass from the payload's.

    The interval of motion samples is best a multiple of the IMU's.
    """
    T = step * steps_of(s.motion.interval, step)
    position_pole, attitude_pole = exp(-e.position_bandwidth * T), exp(-e.attitude_bandwidth * T)
    return Navigator(
        interval=step * steps_of(s.interval, step),
        centre=vec3(centre),
        age=number(s.motion.delay - s.delay),
        attitude=1.0 - attitude_pole**2,
        velocity=1.0 - position_pole**2,
        position=1.0 - position_pole,
        gyroscope=(1.0 - attitude_pole) ** 2 / T,
        accelerometer=(1.0 - position_pole) ** 2 / T,
        rates=1.0,
    )


def start_navigation(navigator: Navigator, state: State) -> NavigationState:
    """The memory before the first step: the estimate is `state`, of the system's centre of mass, without bias."""
    R = rotation_from_quaternion(state.attitude)
    return NavigationState(
        position=state.position - apply(R, navigator.centre),
        velocity=state.velocity - apply(R, cross(state.rates, navigator.centre)),
        acceleration=ZERO,
        attitude=state.attitude,
        measured_rates=state.rates,
        rates=state.rates,
        gyroscope_bias=ZERO,
        accelerometer_bias=ZERO,
        started=0.0,
    )
