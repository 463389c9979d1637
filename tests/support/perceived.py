"""Sensors and estimators on a flight's true motion in one compiled loop; shared by the tests of both estimators."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np
from machine_code import Loop
from newton_euler import paper_parts, vehicle_of

from tandemlift.core.types import leaves, unflat
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.navigation import (
    NavigationState,
    Navigator,
    navigate,
    navigator_from,
    start_navigation,
)
from tandemlift.parts.estimation.push_estimate import PushEstimate, PushEstimator, estimate, push_estimator, start_push
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.noise_bias_drift import (
    AttitudeNoise,
    ChannelModel,
    NoError,
    SensorGrade,
    WhiteNoise,
    sensor_model,
)
from tandemlift.parts.sensors.readings import (
    DeviceModel,
    ImuChannels,
    MotionChannels,
    Readings,
    Sensors,
    readings_of,
    sense,
    start_sensing,
    zero_noise,
)
from tandemlift.parts.sensors.sensors_table import SensorsTable

STEP = 1e-3
SETS = Vec3(*[each(2)(0.0, 0.0)] * 3)
STATE = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
FELT = PerfectReadings(ZERO, SETS, SETS, ZERO)
PERFECT = SensorGrade()


def sensors(
    count: int,
    step: float,
    force: SensorGrade = PERFECT,
    torque: SensorGrade = PERFECT,
    accelerometer: SensorGrade = PERFECT,
    gyroscope: SensorGrade = PERFECT,
    position_noise: float = 0.0,
    velocity_noise: float = 0.0,
    attitude_noise: float = 0.0,
    imu_period: int = 1,
    motion_period: int = 1,
) -> Sensors:
    """Sensors of given grades, whose biases are not drawn; by default perfect and sampled every step."""
    interval = step * imu_period
    unit = ImuChannels[ChannelModel](
        sensor_model(accelerometer, interval),
        sensor_model(gyroscope, interval),
        sensor_model(force, interval, count),
        sensor_model(torque, interval, count),
        NoError(),
    )
    noise = WhiteNoise(position_noise), WhiteNoise(velocity_noise), AttitudeNoise(attitude_noise)
    motion: Any = MotionChannels(*noise)
    return Sensors(DeviceModel(unit, float(imu_period)), DeviceModel(motion, float(motion_period)))


DEVICES = sensors(2, STEP)
HISS = zero_noise(DEVICES)
PUSHES = push_estimator(EstimatorTable(), vehicle_of(paper_parts()), STEP)
OBSERVER = navigator_from(EstimatorTable(), SensorsTable(), ZERO, STEP)


class Happening(NamedTuple):
    """The true values of a step."""

    state: State
    felt: PerfectReadings


class Onboard(NamedTuple):
    """Sensors and estimators with their memories."""

    sensors: Sensors
    pushes: PushEstimator
    observer: Navigator
    sensing: Any
    push_memory: Any
    navigation: NavigationState


class Given(NamedTuple):
    """The inputs of a step."""

    truth: Happening
    hiss: Any
    time: Any


class Seen(NamedTuple):
    """The outputs of a step."""

    push: PushEstimate
    state: State
    readings: Readings
    navigation: NavigationState


def onboard(
    first: Happening,
    devices: Sensors = DEVICES,
    pushes: PushEstimator = PUSHES,
    observer: Navigator = OBSERVER,
    believed: State | None = None,
) -> Onboard:
    """Sensors and estimators before the first step; the observer starts at `believed`, or at the true state."""
    start = first.state if believed is None else believed
    sensing = start_sensing(devices, first.state, first.felt, start.attitude)
    memories = sensing, start_push(pushes, readings_of(sensing).imu), start_navigation(observer, start)
    return Onboard(devices, pushes, observer, *memories)


def step_of(fixed: Any, x: Onboard, given: Given) -> Any:
    """(Outputs, next Onboard) of a step, without delay."""
    truth = given.truth
    readings, sensing = sense(x.sensors, x.sensing, truth.state, truth.felt, truth.state.attitude, given.hiss)
    push, push_memory = estimate(x.pushes, x.push_memory, readings.imu, given.time)
    state, navigation = navigate(x.observer, x.navigation, readings)
    after = x._replace(sensing=sensing, push_memory=push_memory, navigation=navigation)
    return Seen(push, state, readings, navigation), after


LIKE = Happening(STATE, FELT)
ONBOARD, GIVEN = onboard(LIKE), Given(LIKE, HISS, 0.0)
SEEN, _ = step_of(Absent(), ONBOARD, GIVEN)


@functools.cache
def loop() -> Loop:
    """All steps of a flight, in machine code."""
    return Loop(step_of, Absent(), ONBOARD, GIVEN)


def perceived(x: Onboard, truth: np.ndarray, seed: int = 0, step_size: float = STEP) -> Any:
    """`Seen` with arrays over the steps of `truth` (steps × numbers of a `Happening`)."""
    normals = np.random.default_rng(seed).standard_normal((len(truth), leaves(HISS)))
    times = step_size * np.arange(len(truth))[:, None]
    columns = iter(loop()(Absent(), x, np.hstack([truth, normals, times])).T)

    def gathered(like: Any) -> Any:
        return type(like)(*map(gathered, like)) if isinstance(like, tuple) else next(columns)

    return gathered(SEEN)


def rows(v: Any) -> np.ndarray:
    """A vector or quaternion of arrays as an array (steps × components)."""
    return np.array(v).T


def happening(row: np.ndarray) -> Happening:
    """The true values of a step from its row of numbers."""
    return unflat(row, LIKE)
