"""Sensors at rates of their own: noise by its Allan deviation, the joints' clock, first samples, and bad input."""

from __future__ import annotations

import numpy as np
import pytest
from law_values import rebuilt

import tandemlift as tl
from tandemlift.core.vector import ZERO, Quat, spread
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.readings import sense, start_sensing
from tandemlift.parts.sensors.sensors_table import SensorsTable, first_samples
from tandemlift.parts.sensors.start_sensors import sensors_from

STEP, NOISE = 1e-3, 0.03
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
AT_REST = State(ZERO, ZERO, LEVEL, ZERO)


def felt_at(force: float) -> PerfectReadings:
    joints = spread([[0.0, 0.0, force], [0.0, 0.0, -force]])
    return PerfectReadings(ZERO, joints, joints, ZERO)


def readings_of_steps(table: SensorsTable, steps: int, flights: int | None = None):
    """The readings of every step; at step k the first joint carries k newtons."""
    rng = np.random.default_rng(0)
    k, layout = sensors_from(table, 2, STEP, rng)
    memory = start_sensing(k, AT_REST, felt_at(-1.0), LEVEL, first_samples(table, STEP))
    out = []
    for step in range(steps):
        shape = (27,) if flights is None else (27, flights)
        readings, memory = sense(
            k, memory, AT_REST, felt_at(float(step)), LEVEL, rebuilt(list(rng.standard_normal(shape)), layout)
        )
        out.append(readings)
    return out


def allan_deviation(x: np.ndarray, samples: int) -> float:
    """Of steps × flights, over clusters of so many steps (IEEE Std 952, annex C)."""
    means = x[: len(x) // samples * samples].reshape(-1, samples, x.shape[1]).mean(axis=1)
    return float(np.sqrt(0.5 * np.mean(np.diff(means, axis=0) ** 2)))


@pytest.mark.parametrize(
    ("interval", "noise_interval", "density"),
    [(0.02, 0.001, NOISE * 0.001**0.5), (0.004, 1.0, NOISE), (0.02, None, NOISE * 0.02**0.5)],
)
def test_the_density_of_the_noise_is_kept_or_the_noise_of_a_sample(interval, noise_interval, density):
    table = SensorsTable(
        model="simulated",
        interval=interval,
        noise_interval=noise_interval,
        accelerometer={"noise": NOISE},
        gyroscope={"noise": NOISE},
        joints={"force_noise": NOISE, "interval": interval / 2 if interval > 0.001 else None},
    )
    seen = readings_of_steps(table, 1200, flights=150)
    for value in ("specific_force", "rates"):
        x = np.array([getattr(r.imu, value).y for r in seen])
        assert allan_deviation(x, 200) == pytest.approx(density / 0.2**0.5, rel=0.12)


def test_a_sample_of_the_joints_scales_with_their_own_interval():
    joints = {"force_noise": NOISE, "interval": 0.008}
    seen = readings_of_steps(SensorsTable(model="simulated", joints=joints, noise_interval=0.002), 800, flights=50)
    x = np.array([r.imu.joint_force.x[0] for r in seen])[::8]
    assert x.std() == pytest.approx(NOISE * (0.002 / 0.008) ** 0.5, rel=0.03)


@pytest.mark.parametrize(("every", "of_joints", "first"), [(1, 3, 2), (4, 1, 0), (2, 5, 3)])
def test_a_sample_of_the_imu_holds_the_last_one_of_joints_on_their_own_clock(every, of_joints, first):
    table = SensorsTable(
        model="simulated",
        interval=every * STEP,
        joints={"interval": of_joints * STEP, "first_sample": first * STEP},
        motion={"interval": 0.007, "first_sample": 0.003},
    )
    for step, r in enumerate(readings_of_steps(table, 60)):
        taken = step // every * every
        sampled = first + (taken - first) // of_joints * of_joints if taken >= first else -1
        assert r.imu.fresh == (step % every == 0)
        assert r.imu.joint_force.z == (float(sampled), -float(sampled))
        assert r.motion.fresh == (step % 7 == 3)


@pytest.mark.parametrize(
    ("keys", "text"),
    [
        (
            {"sensors.interval": 0.004, "sensors.first_sample": 0.004},
            "sensors.first_sample = 0.004: sensors.interval must be above it, and is 0.004",
        ),
        (
            {"sensors.joints.first_sample": 0.001},
            "sensors.joints.first_sample = 0.001: sensors.joints.interval must be set, and above it",
        ),
        (
            {"sensors.additional": [{"name": "altimeter", "interval": 0.01, "first_sample": 0.02}]},
            "sensors.additional.0.first_sample = 0.02: sensors.additional.0.interval must be above it, and is 0.01",
        ),
        ({"sensors.noise_interval": 0.0}, "sensors.noise_interval = 0.0: must be a number > 0"),
        ({"sensors.joints.interval": -0.1}, "sensors.joints.interval = -0.1: must be a number ≥ 0 and ≤ 10"),
    ],
)
def test_bad_input_names_the_key_the_value_and_what_is_allowed(keys, text):
    with pytest.raises(tl.InputError) as error:
        tl.load_mission("iris", keys)
    assert text in str(error.value)
