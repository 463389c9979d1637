"""How a limit is exceeded, against the same numbers from the whole signal."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from tandemlift.core.vector import Vec3
from tandemlift.simulation.loop.excess import NO_EXCESS, exceed

STEP = 0.01  # s


def remembered(signal, limit):
    memory = NO_EXCESS
    for k, value in enumerate(signal.tolist()):
        over = 1.0 if value > limit else 0.0
        memory = exceed(memory, over, value, Vec3(float(k), value, -value), k * STEP, STEP)
    return memory


@given(arrays.arrays(np.float64, st.integers(1, 60), elements=st.floats(0.0, 4.0, width=16)), st.floats(0.5, 3.0))
def test_it_is_what_the_whole_signal_says(signal, limit):
    m, over = remembered(signal, limit), signal > limit
    assert m.steps == over.sum()
    ends = np.flatnonzero(np.diff(np.concatenate(([0], over.astype(int), [0]))))
    lengths = ends[1::2] - ends[::2]
    assert round(m.stretch / STEP) == max(lengths, default=0)
    if not len(lengths):
        assert m == NO_EXCESS
        return
    assert round(m.start / STEP) in ends[::2][lengths == lengths.max()]
    assert m.worst == signal.max()
    assert m.place == (round(m.at / STEP), m.worst, -m.worst)
    assert signal[round(m.at / STEP)] == m.worst


@given(st.floats(0.0, 1e6), st.floats(0.0, 100.0))
def test_it_stays_while_nothing_is_exceeded(value, t):
    memory = remembered(np.array([2.0, 3.0, 0.0]), 1.0)
    assert memory.now == 0.0
    assert exceed(memory, 0.0, value, Vec3(1.0, 2.0, 3.0), t, STEP) == memory
