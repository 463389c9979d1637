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

import math
from typing import NamedTuple

from numpy.typing import ArrayLike

from tandemlift.core.algebra import exp, maximum, where
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number, number
from tandemlift.core.vector import ZERO, Quat, Vec3, apply, apply_transposed, cross, vec3
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.mechanics.rigid_body import UP, State
from tandemlift.parts.mechanics.rotation import normalised, rotated_by, rotation_between, rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
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


class Innovation(NamedTuple):
    """Measured minus estimated: rotation [rad, body axes], velocity [m/s] and position [m] in world axes."""

    turn: Vec3
    velocity: Vec3
    position: Vec3


@law
def propagated(k: Navigator, m: NavigationState, imu: ImuReading) -> NavigationState:
    """The estimate propagated to the IMU's sample, if that is fresh."""
    T = k.interval * imu.fresh * m.started
    rates = (m.measured_rates + imu.rates) * 0.5 - m.gyroscope_bias
    attitude = rotated_by(m.attitude, rates * T)
    new = apply(rotation_from_quaternion(attitude), imu.specific_force - m.accelerometer_bias) - UP * GRAVITY
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
def innovation(k: Navigator, m: NavigationState, motion: MotionReading) -> Innovation:
    """The innovation of a motion sample: its values less the estimate at its time, `age` before."""
    s, ago = centre_of_mass(k, m), k.age
    return Innovation(
        rotation_between(s.attitude, motion.attitude) + s.rates * ago,
        motion.velocity - (s.velocity - m.acceleration * ago),
        motion.position - (s.position - s.velocity * ago + m.acceleration * (0.5 * ago * ago)),
    )


@law
def corrected(k: Navigator, m: NavigationState, motion: MotionReading) -> NavigationState:
    """The estimate after a motion sample, if that is fresh."""
    off, fresh = innovation(k, m, motion), motion.fresh
    velocity_body = apply_transposed(rotation_from_quaternion(m.attitude), off.velocity)
    return m._replace(
        position=m.position + off.position * (k.position * fresh),
        velocity=m.velocity + off.velocity * (k.velocity * fresh),
        attitude=normalised(rotated_by(m.attitude, off.turn * (k.attitude * fresh))),
        gyroscope_bias=m.gyroscope_bias - off.turn * (k.gyroscope * fresh),
        accelerometer_bias=m.accelerometer_bias - velocity_body * (k.accelerometer * fresh),
    )


@law
def navigate(k: Navigator, memory: NavigationState, readings: Readings) -> tuple[State, NavigationState]:
    """(State of the system's centre of mass at the IMU's last sample, the new memory)."""
    after = corrected(k, propagated(k, memory, readings.imu), readings.motion)
    return centre_of_mass(k, after), after


def navigator(
    centre: ArrayLike,
    step: float,
    imu_period: int = 1,
    motion_period: int = 1,
    position_bandwidth: float = 6.0,
    velocity_bandwidth: float | None = None,
    attitude_bandwidth: float = 4.0,
    rates_bandwidth: float = math.inf,
    age: float = 0.0,
) -> Navigator:
    """The observer with these bandwidths.

    Args:
        centre: the system's centre of mass from the payload's [m], body axes.
        step: at which the observer runs [s].
        imu_period: of the IMU, in steps.
        motion_period: of the motion measurement, in steps; best a multiple of the IMU's.
        position_bandwidth: of the correction of position [rad/s].
        velocity_bandwidth: of velocity and the accelerometer's bias [rad/s]; position's if not given.
        attitude_bandwidth: of attitude and the gyroscope's bias [rad/s].
        rates_bandwidth: of a first-order low-pass on the estimated rates [rad/s]; none if infinite.
        age: by how much the motion measurement's delay exceeds the IMU's [s].
    """
    T, interval = step * motion_period, step * imu_period
    pole_of_velocity = exp(-(position_bandwidth if velocity_bandwidth is None else velocity_bandwidth) * T)
    pole_of_attitude = exp(-attitude_bandwidth * T)
    return Navigator(
        interval=interval,
        centre=vec3(centre),
        age=number(age),
        attitude=1.0 - pole_of_attitude**2,
        velocity=1.0 - pole_of_velocity**2,
        position=1.0 - exp(-position_bandwidth * T),
        gyroscope=(1.0 - pole_of_attitude) ** 2 / T,
        accelerometer=(1.0 - pole_of_velocity) ** 2 / T,
        rates=1.0 - exp(-rates_bandwidth * interval),
    )


def navigator_from(e: EstimatorTable, s: SensorsTable, vehicle: Vehicle, step: float) -> Navigator:
    """The observer of a vehicle with these sensors, run every `step` [s]."""
    return navigator(
        vehicle.center_of_mass,
        step,
        steps_of(s.interval, step),
        steps_of(s.motion.interval, step),
        position_bandwidth=e.position_bandwidth,
        attitude_bandwidth=e.attitude_bandwidth,
        age=s.motion.delay - s.delay,
    )


def start_navigation(navigator: Navigator, state: State) -> NavigationState:
    """The memory before the first step: the estimate is `state`, without bias.

    Args:
        navigator: the observer.
        state: of the system's centre of mass.
    """
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
