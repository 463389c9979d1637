"""The low-pass against SciPy's simulation of the same differential equation, and its effect on noise."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

from tandemlift.core.vector import ZERO, Vec3, each
from tandemlift.parts.mechanics.low_pass import LowPassState, low_pass, low_pass_step


def response(bandwidth: float, step: float, inputs: np.ndarray) -> np.ndarray:
    k, memory, out = low_pass(bandwidth, step), LowPassState(0.0, 0.0), []
    for u in inputs:
        memory = low_pass_step(k, memory, u)
        out.append(memory.value)
    return np.array(out)


def test_it_is_the_held_response_of_two_equal_lags():
    w, step = 36.0, 1e-3
    inputs = np.random.default_rng(0).standard_normal(300)
    numerator, denominator, _ = signal.cont2discrete(([w * w], [1.0, 2.0 * w, w * w]), step, method="zoh")
    expected = signal.lfilter(numerator.ravel(), denominator, np.append(inputs, 0.0))
    assert response(w, step, inputs) == pytest.approx(expected[1:], abs=1e-12)


def test_a_ramp_is_followed_two_time_constants_late():
    w, step, slope = 20.0, 1e-3, 3.0
    t = step * np.arange(1, 2001)
    late = (t - 0.5 * step) - response(w, step, slope * (t - 0.5 * step)) / slope  # a held ramp is half a step behind
    assert late[-1] == pytest.approx(2.0 / w, abs=step)


def test_white_noise_comes_down_as_the_bandwidth_says():
    """The sum of the squared impulse response is the gain on the variance of white noise."""
    w, step = 36.0, 1e-3
    impulse = np.zeros(2000)
    impulse[0] = 1.0
    assert np.sum(response(w, step, impulse) ** 2) == pytest.approx(w * step / 4.0, rel=1e-3)


def test_vectors_and_sets_are_smoothed_component_by_component():
    k = low_pass(10.0, 1e-2)
    alone = low_pass_step(k, LowPassState(0.0, 0.0), 2.0)
    three = low_pass_step(k, LowPassState(ZERO, ZERO), Vec3(0.0, 2.0, 4.0))
    pair = each(2)
    two = low_pass_step(k, LowPassState(pair(0.0, 0.0), pair(0.0, 0.0)), pair(2.0, -2.0))
    assert three.value == (0.0, alone.value, 2.0 * alone.value)
    assert two.rate == (alone.rate, -alone.rate)
