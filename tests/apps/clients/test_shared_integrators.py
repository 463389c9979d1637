"""Integrators of quadrotors on one body come together, and those of quadrotors that fly by themselves do not."""

import math

import numpy as np
import pytest

from tandemlift.apps.clients.quadrotors import Quadrotors
from tandemlift.apps.clients.setpoints import PositionSetpoint
from tandemlift.missions import load_mission

STATE = np.array([0.0, 0.0, 1.0, *[0.0] * 3, 1.0, *[0.0] * 6])  # at rest, level
STEP = 1e-3


def hovering(control, seconds, first, second):
    """The integrals of two quadrotors some time after they were apart, held where their setpoints are."""
    quads = Quadrotors(load_mission("crazyflie-stick").hover.vehicle, 0.05, STEP, control)
    quads.update(0.0, STATE)
    for i in range(2):
        quads.arm(i)
    quads._outer[0].integral, quads._outer[1].integral = first, second
    for k in range(1, round(seconds / STEP) + 1):
        for i in range(2):
            quads.command(i, PositionSetpoint(quads.state(i).position, 0.0))
        quads.update(k * STEP, STATE)
    return np.array([outer.integral for outer in quads._outer])


@pytest.mark.parametrize("seconds", [0.5, 2.0])
def test_integrators_of_one_body_keep_their_mean_and_agree_within_a_second(seconds):
    one, other = np.array([1.0, -0.5, 0.25]), np.array([-0.6, 0.1, 0.75])
    found = hovering("shared", seconds, tuple(one), tuple(other))
    mean, apart = 0.5 * (one + other), 0.5 * (one - other) * math.exp(-seconds / 1.0)
    assert found[0] == pytest.approx(mean + apart, abs=2e-3)
    assert found[1] == pytest.approx(mean - apart, abs=2e-3)


def test_integrators_of_quadrotors_with_own_loops_stay_apart():
    found = hovering("own", 1.0, (1.0, -0.5, 0.25), (-0.6, 0.1, 0.75))
    assert found == pytest.approx(np.array([[1.0, -0.5, 0.25], [-0.6, 0.1, 0.75]]))
