"""Oscillations are found where there are some: signals with closed forms, through the laws that watch every step."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tandemlift.simulation.loop.oscillation import (
    NO_OSCILLATION,
    STILL,
    OscillationLimits,
    Swings,
    half_period,
    oscillation_step,
)

STEP = 0.004  # s
LIMITS = OscillationLimits(Swings(0.3, 0.3, 0.3, 0.15), shortest=0.02, longest=0.5 / 0.3, halves=6.0)


def watched(signal, duration=6.0):
    """The memory of a body rate after a signal of time."""
    memory = STILL
    for k in range(round(duration / STEP)):
        memory = half_period(LIMITS, memory, signal(k * STEP), 0.3, k * STEP)
    return memory


def sine(frequency, amplitude, decay=0.0):
    return lambda t: amplitude * math.exp(-decay * t) * math.sin(2.0 * math.pi * frequency * t)


@settings(max_examples=10, deadline=None)
@given(st.floats(0.9, 20.0), st.floats(0.4, 50.0))
def test_a_sine_is_an_oscillation_of_its_frequency_and_amplitude(frequency, amplitude):
    found = watched(sine(frequency, amplitude))
    lasted = found.last - found.first
    assert lasted > 6.0 - 1.5 / frequency
    assert found.halves / (2.0 * lasted) == pytest.approx(frequency, rel=3.0 * STEP / lasted + 1e-3)
    assert found.amplitude == pytest.approx(amplitude, rel=(math.pi * frequency * STEP) ** 2)


@pytest.mark.parametrize(
    "signal",
    [
        sine(2.0, 0.29),  # too small
        sine(0.2, 5.0),  # a person's motion
        sine(40.0, 5.0),  # noise
        sine(2.0, 20.0, decay=2.0 * math.pi * 2.0 * 0.1),  # a tenth of critical damping
        lambda t: 2.0 + sine(2.0, 1.0)(t),  # on one side of zero
        lambda t: sine(2.0, 1.0)(t) if t < 1.2 else 0.0,  # two periods and a half
        lambda t: 1.0 if t % 0.5 < 0.1 else -1.0,  # pulses: every second half period is four times as long
    ],
)
def test_what_is_no_oscillation_is_not_found(signal):
    assert watched(signal, 6.0).halves == 0.0


def test_three_periods_are_enough_and_a_growing_oscillation_counts():
    assert watched(lambda t: sine(2.0, 1.0)(t) if t < 1.77 else 0.0, 4.0).halves == 6.0
    assert watched(sine(2.0, 0.35, decay=-0.5), 4.0).halves >= 6.0


def test_nothing_is_found_on_the_ground():
    memory = NO_OSCILLATION
    for k in range(600):
        memory = oscillation_step(LIMITS, memory, Swings(*[sine(2.0, 1.0)(k * STEP)] * 4), 0.0, k * STEP)
    assert memory == NO_OSCILLATION
