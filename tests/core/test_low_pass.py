"""The low-pass against SciPy's simulation of the same differential equation."""

import numpy as np
import pytest
from scipy import signal

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
