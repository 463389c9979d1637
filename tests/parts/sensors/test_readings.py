"""The IMU and the motion measurement: what they hold, when they sample, and that zeros leave every bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from law_values import array, flat, random_attitude, random_state, random_vec3, rebuilt, seeds
from perceived import sensors
from scipy import stats
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Quat, Vec3, spread, vec3
from tandemlift.missions import load_mission
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.noise_bias_drift import SensorGrade
from tandemlift.parts.sensors.readings import (
    Readings,
    SensorNoise,
    Sensors,
    readings_of,
    sense,
    start_sensing,
    zero_noise,
)
from tandemlift.parts.sensors.start_sensors import sensors_from

STEP = 1e-3
HISS = zero_noise(sensors(2, STEP))
AT_REST = State(Vec3(1.0, 2.0, 3.0), ZERO, Quat(1.0, 0.0, 0.0, 0.0), Vec3(0.1, 0.2, -0.3))
FELT = PerfectReadings(Vec3(0.1, -0.2, 9.8), spread([[0.1, 0.2, 2.4], [0.3, -0.1, 2.5]]), spread(np.eye(3)[:2]), ZERO)
NOISY = sensors(
    2,
    STEP,
    force=SensorGrade(noise=0.05, bias=[[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]], drift=0.2),
    torque=SensorGrade(noise=0.01, drift=0.1),
    accelerometer=SensorGrade(noise=0.03, drift=0.3),
    gyroscope=SensorGrade(noise=0.002, drift=0.05),
    position_noise=0.003,
    velocity_noise=0.01,
    attitude_noise=0.02,
    imu_period=2,
    motion_period=5,
)


def random_felt(rng: np.random.Generator) -> PerfectReadings:
    force, torque = rng.standard_normal((2, 2, 3))
    return PerfectReadings(random_vec3(rng), spread(force), spread(torque), ZERO)


def hiss(rng: np.random.Generator, size: Any = None) -> SensorNoise:
    """Standard normals for a step, of one flight or of many at once."""
    shape = (27,) if size is None else (27, size)
    return rebuilt(list(rng.standard_normal(shape)), HISS)


def flown(k: Sensors, steps: int, seed: int, flights: int, unit_of: Any = lambda r: r) -> list[Any]:
    """What `unit_of` picks of the readings of every step at rest: of so many flights at once."""
    rng, memory, out = np.random.default_rng(seed), start_sensing(k, AT_REST, FELT, AT_REST.attitude), []
    for _ in range(steps):
        readings, memory = sense(k, memory, AT_REST, FELT, AT_REST.attitude, hiss(rng, flights))
        out.append(unit_of(readings))
    return out


@given(seeds)
def test_perfect_sensors_read_every_bit_of_what_is_felt(seed):
    rng = np.random.default_rng(seed)
    k, s, felt, believed = sensors(2, STEP), random_state(rng), random_felt(rng), random_attitude(rng)
    memory = start_sensing(k, AT_REST, FELT, AT_REST.attitude)
    readings, _ = sense(k, memory, s, felt, believed, hiss(rng))
    assert readings.imu == (felt.specific_force, s.rates, felt.joint_force, felt.joint_torque, believed, 1.0)
    assert readings.motion == (s.position, s.velocity, s.attitude, 1.0)


def test_before_the_first_step_stands_a_reading_with_bias_and_without_noise():
    readings = readings_of(start_sensing(NOISY, AT_REST, FELT, AT_REST.attitude))
    assert (readings.imu.fresh, readings.motion.fresh) == (0.0, 0.0)
    off = np.array(readings.imu.joint_force) - np.array(FELT.joint_force)
    assert off == pytest.approx(np.transpose([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]), abs=1e-15)
    assert readings.imu.rates == AT_REST.rates
    assert readings.motion == (AT_REST.position, AT_REST.velocity, AT_REST.attitude, 0.0)


def every_meter(readings: Readings) -> list[Any]:
    """Component y of everything that the IMU reads; of quadrotors, the second's."""
    u = readings.imu
    return [u.joint_force.y[1], u.joint_torque.y[1], u.specific_force.y, u.rates.y]


def test_the_drift_grows_as_a_random_walk_of_the_time():
    """Var = σ² t at every sample, on top of what one sample's noise has."""
    flights, samples = 1000, 100
    found = np.array(flown(NOISY, 2 * samples, 1, flights, every_meter))[::2]
    imu = NOISY.imu.channels
    meters = (imu.joint_force, imu.joint_torque, imu.specific_force, imu.rates)
    for i, (drift, k) in enumerate(zip((0.2, 0.1, 0.3, 0.05), meters, strict=True)):
        for sample in (1, 50, samples - 1):
            variance = drift**2 * (sample * 2 * STEP) + k.errors.noise**2
            square = np.sum((found[sample, i] - np.mean(found[sample, i])) ** 2) / variance
            low, high = stats.chi2.ppf([1e-4, 1.0 - 1e-4], flights - 1)
            assert low < square < high


def test_the_same_normals_serve_no_two_readings():
    """Each of the 27 normals moves one reading alone."""
    memory = start_sensing(NOISY, AT_REST, FELT, AT_REST.attitude)

    def read(normals: Any) -> np.ndarray:
        r, _ = sense(NOISY, memory, AT_REST, FELT, AT_REST.attitude, rebuilt(normals, HISS))
        return np.array(flat(r.imu)[:18] + flat(r.motion)[:6] + flat(r.motion)[7:10])

    moved = np.array([np.abs(read(row) - read(np.zeros(27))) for row in 1e-3 * np.eye(27)])
    assert np.all(np.sum(moved > 1e-9, axis=0) == 1)
    assert np.all(np.sum(moved > 1e-9, axis=1) == 1)


def test_motion_is_measured_with_the_noise_that_is_claimed():
    flights = 20000
    motion = flown(NOISY, 1, 3, flights, lambda r: r.motion)[0]
    off = Rotation.from_quat(np.array(motion.attitude).T, scalar_first=True).as_rotvec().T
    low, high = stats.chi2.ppf([1e-4, 1.0 - 1e-4], flights)
    for errors, sigma in (
        (np.array(motion.position) - array(AT_REST.position)[:, None], 0.003),
        (np.array(motion.velocity), 0.01),
        (off, 0.02),
    ):
        for row in errors:
            assert low < np.sum(row**2) / sigma**2 < high
    assert np.sum(np.array(motion.attitude) ** 2, axis=0) == pytest.approx(1.0, abs=1e-14)


def test_attitude_noise_turns_about_the_bodys_axes():
    lying = random_attitude(np.random.default_rng(8))
    s = AT_REST._replace(attitude=lying)
    k = sensors(2, STEP, attitude_noise=0.3)
    normals = HISS._replace(motion=HISS.motion._replace(attitude=vec3([0.0, 0.0, 1.0])))
    readings, _ = sense(k, start_sensing(k, s, FELT, lying), s, FELT, lying, normals)
    found, true = (Rotation.from_quat(array(q), scalar_first=True) for q in (readings.motion.attitude, lying))
    assert (true.inv() * found).as_rotvec() == pytest.approx([0.0, 0.0, 0.3], abs=1e-14)


def test_sensors_without_errors_read_the_truth_whatever_their_table_says():
    table = load_mission("iris", {"sensors.errors": "none", "sensors.joints.force_resolution": 0.0}).sensors
    k, _ = sensors_from(table, 2, STEP, np.random.default_rng(1))
    memory = start_sensing(k, AT_REST, FELT, AT_REST.attitude)
    _, memory = sense(k, memory, AT_REST, FELT, AT_REST.attitude, hiss(np.random.default_rng(2)))
    read, _ = sense(k, memory, AT_REST, FELT, AT_REST.attitude, hiss(np.random.default_rng(3)))
    assert table.joints.force_noise > 0.0
    assert np.array_equal(flat(read.imu)[:6], [*FELT.specific_force, *AT_REST.rates])
    assert np.array_equal(array(read.imu.joint_force), array(FELT.joint_force))
    assert np.array_equal(array(read.motion.position), array(AT_REST.position))
