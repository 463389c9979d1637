"""Redundant measurements: of a motion that SciPy describes nothing differs; what one of them has wrong adds up."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Quat, vec3
from tandemlift.parts.sensors.consistency import Inconsistency, exceeds, inconsistency_after
from tandemlift.parts.sensors.readings import ImuReading, MotionReading

DT, EVERY, FORGETTING = 1e-3, 10, 0.2
SPIN = np.array([0.4, -0.3, 0.5])  # rad/s, body axes, constant: so the attitude is exact
ACCELERATION = np.array([0.6, -0.4, 0.2])  # m/s², world axes
WEIGHTLESS = np.array([0.0, 0.0, GRAVITY])


def quaternion(t):
    return Quat(*Rotation.from_rotvec(SPIN * t).as_quat(scalar_first=True).tolist())


def differences(seconds=2.0, rates=0.0, force=0.0, velocity=0.0, invalid=lambda t: 0.0):
    """What differs after a motion of which rates, specific force or velocity are measured with an error."""
    start = MotionReading(ZERO, vec3(np.array([velocity] * 3)), quaternion(0.0), 1.0)
    m = Inconsistency(ZERO, ZERO, ZERO, start.attitude, start.position, start.velocity)
    for k in range(1, round(seconds / DT) + 1):
        t = k * DT
        fresh = float(k % EVERY == 0)
        seen = (k if fresh else k - k % EVERY) * DT  # the last sample of the motion is held
        R = Rotation.from_rotvec(SPIN * seen)
        specific = R.inv().apply(ACCELERATION + WEIGHTLESS) + force
        imu = ImuReading(vec3(specific), vec3(SPIN + rates), None, None, None, 1.0)
        moved = MotionReading(
            vec3(0.5 * ACCELERATION * seen**2), vec3(ACCELERATION * seen + velocity), quaternion(seen), fresh
        )
        m = inconsistency_after(FORGETTING, m, imu, moved, invalid(t), DT)
    return m


def test_measurements_of_one_motion_agree():
    m = differences()
    interval = EVERY * DT
    assert np.abs(np.array(m.attitude)).max() < 1e-6
    assert np.abs(np.array(m.velocity)).max() < 1e-9
    assert np.abs(np.array(m.position)).max() < ACCELERATION.max() * interval * interval / FORGETTING


@pytest.mark.parametrize("wrong", ["rates", "force", "velocity"])
def test_an_error_comes_to_what_it_does_in_an_interval_over_the_forgetting(wrong):
    """The sum of λ^k e: an error e per interval comes to e/(1 − λ)."""
    size, interval = 0.05, EVERY * DT
    m, sound = differences(**{wrong: size}), differences()
    error = size * interval / FORGETTING
    rotated = Rotation.from_rotvec(SPIN * 2.0).apply([error] * 3)
    assert m.attitude - sound.attitude == pytest.approx([-error * (wrong == "rates")] * 3, abs=2e-5)
    assert m.position - sound.position == pytest.approx([-error * (wrong == "velocity")] * 3, abs=2e-5)
    assert m.velocity - sound.velocity == pytest.approx(-rotated * (wrong == "force"), abs=0.05 * error)


def test_while_a_measurement_is_invalid_nothing_is_compared_and_then_it_begins_anew():
    assert differences(rates=0.5, force=0.5, velocity=0.5, invalid=lambda t: 1.0)[:3] == (ZERO, ZERO, ZERO)
    again = differences(seconds=2.0, rates=0.05, invalid=lambda t: 1.0 if t < 1.0 else 0.0)
    assert np.array(again.attitude) == pytest.approx(differences(rates=0.05).attitude, rel=1e-3)


def test_a_difference_exceeds_a_gap_by_its_length():
    assert exceeds(vec3([0.3, 0.0, 0.401]), 0.5) == 1.0
    assert exceeds(vec3([0.3, 0.0, 0.399]), 0.5) == 0.0
