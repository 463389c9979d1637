"""A step over a series of inputs against a loop in NumPy, and its tangents against central differences."""

from typing import NamedTuple

import numpy as np
import pytest

from tandemlift.compiler.machine_code.series import Series
from tandemlift.core.algebra import sin
from tandemlift.core.law import law
from tandemlift.core.types import Number


class Pendulum(NamedTuple):
    angle: Number
    rate: Number


class Constants(NamedTuple):
    length: Number
    damping: Number
    step: Number


class Prepared(NamedTuple):
    stiffness: Number
    damping: Number
    step: Number


def prepared(k):
    return Prepared(9.81 / k.length, k.damping, k.step)


@law
def swing(k, x, torque):
    """A semi-implicit Euler step; the output is the height of the bob over the length, 1 − cos, by sines."""
    rate = x.rate + (torque - sin(x.angle) * k.stiffness - x.rate * k.damping) * k.step
    half = sin(x.angle * 0.5)
    return Pendulum(x.angle + rate * k.step, rate), half * half * 2.0


ROWS, STEPS = 11, 60  # not a multiple of the lanes
CHANCE = np.random.default_rng(1)
X, U = CHANCE.standard_normal((ROWS, 2)), CHANCE.standard_normal((ROWS, STEPS, 1))
P = np.array([0.7, 0.2, 0.02])


def swung(x, p, u):
    (angle, rate), found = x.T.copy(), []
    for k in range(u.shape[1]):
        found.append(1.0 - np.cos(angle))
        rate = rate + (u[:, k, 0] - 9.81 / p[0] * np.sin(angle) - p[1] * rate) * p[2]
        angle = angle + rate * p[2]
    return np.array(found).T[..., None], np.stack([angle, rate], axis=1)


@pytest.fixture(scope="module")
def series():
    likes = Constants(1.0, 0.0, 0.1), Pendulum(0.0, 0.0), 0.0
    return [Series(prepared, swing, *likes, differentiated=d) for d in (False, True)]


def test_outputs_and_last_states_are_those_of_a_loop_and_arguments_stay_as_they_are(series):
    before = X.copy()
    y, after = series[0](X, P, U)
    expected, last = swung(X, P, U)
    assert y == pytest.approx(expected, abs=1e-12)
    assert after == pytest.approx(last, abs=1e-12)
    assert np.array_equal(X, before)


def test_tangents_are_central_differences(series):
    dx, dp, du = (CHANCE.standard_normal(a.shape) for a in (X, P, U))
    dp[2] = 0.0
    h = 1e-6
    ahead, behind = (swung(X + s * h * dx, P + s * h * dp, U + s * h * du)[0] for s in (1.0, -1.0))
    y, dy = series[1].tangent(X, P, U, dx, dp, du)
    assert y == pytest.approx(swung(X, P, U)[0], abs=1e-12)
    assert dy == pytest.approx((ahead - behind) / (2.0 * h), rel=1e-6, abs=1e-7)
