"""The low-pass against SciPy's simulation of the same differential equation, and closed forms of its answers."""

import numpy as np
import pytest
from scipy import linalg, signal

from tandemlift.core.low_pass import LowPassState, low_pass, low_pass_step


def test_it_is_the_held_response_of_two_equal_lags():
    w, step = 36.0, 1e-3
    inputs = np.random.default_rng(0).standard_normal(300)
    numerator, denominator, _ = signal.cont2discrete(([w * w], [1.0, 2.0 * w, w * w]), step, method="zoh")
    expected = signal.lfilter(numerator.ravel(), denominator, np.append(inputs, 0.0))
    k, memory, found = low_pass(w, step), LowPassState(0.0, 0.0), []
    for u in inputs:
        memory = low_pass_step(k, memory, u)
        found.append(memory.value)
    assert found == pytest.approx(expected[1:], abs=1e-12)


def answer(w, step, inputs):
    k, memory, found = low_pass(w, step), LowPassState(0.0, 0.0), []
    for u in inputs:
        memory = low_pass_step(k, memory, u)
        found.append(memory.value)
    return np.array(found)


def test_a_step_of_its_input_is_answered_by_one_minus_one_plus_wt_times_e_to_the_minus_wt():
    w, step = 20.0, 2e-3
    t = step * np.arange(1, 401)
    assert answer(w, step, np.ones(400)) == pytest.approx(1.0 - (1.0 + w * t) * np.exp(-w * t), abs=1e-13)


def test_a_ramp_comes_two_over_its_bandwidth_late():
    """The ramp is held over each step, so half a step more."""
    w, step = 36.0, 1e-3
    t = step * np.arange(2000)
    assert t[-1] + step - answer(w, step, t)[-1] == pytest.approx(2.0 / w + 0.5 * step, rel=1e-6)


@pytest.mark.parametrize("w", [1.0, 36.0])
def test_white_noise_leaves_with_a_quarter_of_bandwidth_times_step_of_its_variance(w):
    """By the discrete Lyapunov equation of its two states; the docstring's closed form is that of short steps."""
    step = 1e-3
    k = low_pass(w, step)
    A = np.array([k[:2], k[2:]])
    b = np.array([1.0, 0.0]) - A[:, 0]
    assert linalg.solve_discrete_lyapunov(A, np.outer(b, b))[0, 0] == pytest.approx(w * step / 4.0, rel=w * step)


def test_what_decays_does_not_end_among_denormal_numbers():
    memory, k = LowPassState(1.0, 0.0), low_pass(36.0, 1e-3)
    seen = []
    for _ in range(20_000):
        memory = low_pass_step(k, memory, 0.0)
        seen += [abs(memory.value), abs(memory.rate)]
    assert abs(memory.value) < 1e-200
    assert min(x for x in seen if x) > np.finfo(float).tiny
