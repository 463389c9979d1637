"""Sensors and estimators are one source: plain Python, NumPy, JAX, CasADi and the compiled loop agree."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from law_values import flat, random_state, random_vec3, rebuilt
from newton_euler import paper_parts
from perceived import HISS, STEP, Happening, Onboard, onboard, perceived, step

from tandemlift.core.types import flat as floats
from tandemlift.core.vector import ZERO, spread
from tandemlift.parts.estimation.navigation import navigator
from tandemlift.parts.estimation.push_estimate import push_estimator
from tandemlift.parts.mechanics.loads import PerfectReadings
from tandemlift.parts.sensors.noise_bias_drift import SensorGrade
from tandemlift.parts.sensors.start_sensors import sensors

BATCH = 6
P = paper_parts()
COARSE = SensorGrade(noise=0.05, bias=0.1, drift=0.2, resolution=0.02, limit=30.0, misalignment=0.02)
DEVICES = sensors(2, STEP, COARSE, COARSE, COARSE, COARSE, 0.003, 0.01, 0.002, imu_period=2, motion_period=3)
PUSHES = push_estimator(
    P.mass, P.inertia, P.joints, P.quadrotors, P.masses, STEP, imu_period=2, length=2.0,
    tare_start=0.005, tare_duration=0.01, identify_mass=True,
)  # fmt: skip
OBSERVER = navigator(P.centre, STEP, 2, 3, rates_bandwidth=300.0, age=0.004)


def happenings(count: int) -> list[Happening]:
    rng = np.random.default_rng(5)
    pairs = 4.0 * rng.standard_normal((count, 2, 2, 3))
    return [
        Happening(random_state(rng), PerfectReadings(random_vec3(rng, 9.0), spread(f), spread(t), ZERO))
        for f, t in pairs
    ]


def started() -> Onboard:
    return onboard(happenings(1)[0], DEVICES, PUSHES, OBSERVER)


def flown(steps: int) -> tuple[list[list[float]], Onboard]:
    """What plain Python shows of some steps, and what it carries on."""
    x, out = started(), []
    normals = np.random.default_rng(0).standard_normal((steps, len(flat(HISS))))
    for k, (truth, row) in enumerate(zip(happenings(steps), normals, strict=True)):
        seen, x = step(x, truth, rebuilt(map(float, row), HISS), k * STEP)
        out.append(flat(seen))
    return out, x


def test_the_compiled_loop_is_the_plain_one():
    steps = 40
    wanted, _ = flown(steps)
    seen = perceived(started(), np.array([floats(h) for h in happenings(steps)]))
    found, wanted = np.array(flat(seen)).T, np.array(wanted)
    assert np.all(np.abs(found - wanted) <= 1e-9 * (1.0 + np.abs(wanted)))


def inputs() -> tuple[Any, np.ndarray]:
    """The layout of all that a step takes, and numbers for it (numbers × BATCH), some way into a flight."""
    _, x = flown(17)
    like = (x, happenings(1)[0], HISS)
    numbers = np.tile(np.array(floats(like[0]) + floats(like[1]) + floats(HISS))[:, None], (1, BATCH))
    state_size = len(numbers) - len(floats(HISS))
    numbers[state_size:] = np.random.default_rng(2).standard_normal((len(floats(HISS)), BATCH))
    return like, numbers


def evaluated(like: Any, numbers: Any) -> list[Any]:
    """One step of these numbers."""
    source = iter(numbers)
    x, truth, hiss = (rebuilt(source, part) for part in like)
    seen, after = step(x, truth, hiss, 17 * STEP)
    return flat(seen) + flat(after)


@pytest.fixture(scope="module")
def expected() -> np.ndarray:
    like, numbers = inputs()
    return np.array([evaluated(like, map(float, column)) for column in numbers.T]).T


def assert_agreement(found: Any, expected: np.ndarray) -> None:
    assert np.abs(np.broadcast_to(found, expected.shape) - expected).max() < 1e-10


def test_numpy_broadcasts_a_step(expected):
    like, numbers = inputs()
    assert_agreement([np.broadcast_to(row, BATCH) for row in evaluated(like, numbers)], expected)


def test_jax_evaluates_a_step(expected, jax):
    like, numbers = inputs()
    rows = jax.jit(lambda x: jax.numpy.stack([jax.numpy.broadcast_to(r, BATCH) for r in evaluated(like, list(x))]))
    assert_agreement(rows(numbers), expected)


def test_casadi_traces_a_step(expected, casadi):
    like, numbers = inputs()
    symbols = casadi.SX.sym("numbers", len(numbers))
    outputs = casadi.vertcat(*evaluated(like, casadi.vertsplit(symbols)))
    assert_agreement(np.array(casadi.Function("step", [symbols], [outputs])(numbers)), expected)
