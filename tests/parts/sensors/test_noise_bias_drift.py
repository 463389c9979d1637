"""One sensor: noise, drift, bias, misalignment, saturation and quantisation, against their definitions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import array, numbers, random_vec3, seeds, vectors
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Vec3, spread, vec3
from tandemlift.parts.sensors.noise_bias_drift import SensorGrade, displayed, read, sensor_model

SETS = spread(np.zeros((2, 3)))


@given(vectors())
def test_a_perfect_sensor_reads_every_bit(v):
    assert read(sensor_model(SensorGrade(), 1e-3), ZERO, v, Vec3(1.3, -4.0, 0.2)) == v
    of_sets = Vec3(*spread([v, (v.z, v.x, v.y)]))
    assert read(sensor_model(SensorGrade(), 1e-3, 2), SETS, of_sets, of_sets) == of_sets


@pytest.mark.parametrize(("noise", "drift"), [(0.05, 3.0), (0.0, 0.4), (0.2, 0.0)])
def test_noise_and_drift_from_one_normal_are_as_noise_and_an_independent_walk(noise, drift):
    """All that two Gaussian processes can differ in is the covariance of their increments, here from the response to a
    single normal: 2σ² + w² at once, −σ² from one to the next, nothing beyond."""
    interval = 2e-3
    k = sensor_model(SensorGrade(noise=noise, drift=drift), interval)
    readings, walk = [], ZERO
    for n in (0.0, 1.0, 0.0, 0.0, 0.0, 0.0):
        readings.append(read(k, walk, ZERO, Vec3(n, 0.0, 0.0)).x)
        walk = walk + Vec3(n, 0.0, 0.0) * k.errors.walk
    change = np.diff(readings)
    found = [change[i:] @ change[: len(change) - i] for i in range(4)]
    w = drift * math.sqrt(interval)
    assert found == pytest.approx([2.0 * noise**2 + w**2, -(noise**2), 0.0, 0.0], abs=1e-15)


@given(seeds)
def test_misalignment_turns_the_sensors_axes(seed):
    rng = np.random.default_rng(seed)
    v, turn = random_vec3(rng), 0.1 * rng.standard_normal(3)
    found = read(sensor_model(SensorGrade(misalignment=turn), 1e-3), ZERO, v, ZERO)
    assert array(found) == pytest.approx(Rotation.from_rotvec(turn).inv().apply(array(v)), abs=1e-14)


def test_every_quadrotor_has_a_sensor_of_its_own():
    rng = np.random.default_rng(3)
    bias, turn, truth = rng.standard_normal((3, 3, 3))
    grade = SensorGrade(bias=bias, misalignment=0.1 * turn, resolution=0.01, limit=1.5)
    together = read(sensor_model(grade, 1e-3, 3), spread(np.zeros((3, 3))), spread(truth), spread(np.zeros((3, 3))))
    for i in range(3):
        alone = sensor_model(grade._replace(bias=bias[i], misalignment=0.1 * turn[i]), 1e-3)
        assert [c[i] for c in together] == list(read(alone, ZERO, vec3(truth[i]), ZERO))


@given(numbers(1e9), st.floats(0.0, 1.0, exclude_min=True, allow_subnormal=False))
def test_whole_steps_are_rounded_half_to_even(x, step):
    per_step = 1.0 / step
    if math.isfinite(per_step) and abs(x * per_step) < 2.0**51:
        assert displayed(x, math.inf, step, per_step) == np.round(x * per_step) * step


def test_half_steps_go_to_even_wherever_the_law_runs(jax, casadi):
    """A compiler that cancelled the sum and the difference in the rounding would give x back."""
    s = casadi.SX.sym("x")
    by_jax = jax.jit(lambda x: displayed(x, math.inf, 1.0, 1.0))
    by_casadi = casadi.Function("law", [s], [displayed(s, math.inf, 1.0, 1.0)])
    for x in (-2.5, -1.5, -0.5, 0.5, 1.5, 2.5):
        for read_out in (lambda x: displayed(x, math.inf, 1.0, 1.0), by_jax, by_casadi):
            assert float(read_out(x)) == np.round(x)


@given(numbers(100.0))
def test_nothing_is_read_beyond_the_range(x):
    k = sensor_model(SensorGrade(limit=7.0, noise=0.1), 1e-3)
    assert read(k, ZERO, Vec3(x, -x, 0.0), ZERO) == Vec3(min(max(x, -7.0), 7.0), min(max(-x, -7.0), 7.0), 0.0)
