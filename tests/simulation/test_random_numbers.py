"""Random access to normal numbers: Philox by its published answers, the numbers by their distribution."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from machine_code import answers
from scipy import stats

from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.simulation.loop.random_numbers import MASK, Words, key_from_seed, normal_radius, normals, philox

LANES, STEPS, DRAWS, SEEDS = 8, 20_000, 3, 5
words = st.integers(0, MASK)

# Random123, kat_vectors, philox4x32 with 10 rounds: counter, key, answer
KNOWN = [
    ("00000000 00000000 00000000 00000000", "00000000 00000000", "6627e8d5 e169c58d bc57ac4c 9b00dbd8"),
    ("ffffffff ffffffff ffffffff ffffffff", "ffffffff ffffffff", "408f276d 41c83b0e a20bc7c6 6d5451fd"),
    ("243f6a88 85a308d3 13198a2e 03707344", "a4093822 299f31d0", "d16cfe09 94fdcceb 5001e420 24126ea1"),
]


def hexadecimal(text: str) -> list[int]:
    return [int(word, 16) for word in text.split()]


@functools.cache
def code(lanes: int) -> Callable[[np.ndarray], np.ndarray]:
    return compiled(normals, 0.0, 0.0, 0.0, 0.0, lanes=lanes)


def alone(*given: float) -> np.ndarray:
    """The four numbers of one step and draw, in machine code."""
    return code(1)(np.array([given], dtype=float))[0]


@pytest.fixture(scope="module")
def sample() -> np.ndarray:
    """Numbers (seeds × draws × four × steps) of the first steps."""
    steps = np.arange(STEPS)
    rows = [
        np.stack([steps, *(np.full(STEPS, x) for x in (draw, *key_from_seed(seed)))], axis=1)
        for seed in range(SEEDS)
        for draw in range(DRAWS)
    ]
    return np.array([code(LANES)(part).T for part in rows]).reshape(SEEDS, DRAWS, 4, STEPS)


def words_of(first, second, third, fourth, key0, key1):
    return philox(Words(int(first), int(second), int(third), int(fourth)), int(key0), int(key1))


def test_philox_in_python_and_in_machine_code_gives_the_published_answers():
    rows = [hexadecimal(counter) + hexadecimal(key) for counter, key, _ in KNOWN]
    published = [hexadecimal(answer) for *_, answer in KNOWN]
    assert [list(words_of(*row)) for row in rows] == published
    for lanes in (1, LANES):
        assert answers(words_of, (0.0,) * 6, [*rows, *[rows[0]] * 5], lanes)[: len(rows)].tolist() == published


@given(st.integers(0, 10**9), st.integers(0, 100), words, words)
def test_numbers_in_machine_code_equal_those_of_plain_python(step, draw, key0, key1):
    found = alone(step, draw, key0, key1)
    assert found == pytest.approx(np.array(normals(step, draw, float(key0), float(key1))), abs=1e-12, rel=0.0)
    assert normals(step, draw, key0, key1) == normals(float(step), draw, float(key0), float(key1))


@given(st.integers(0, 10**9), words, words)
def test_two_words_are_the_length_and_the_angle_of_two_numbers(step, key0, key1):
    x = philox(Words(step, 7, 0, 0), key0, key1)
    found = normals(step, 7, key0, key1)
    for a, b, (length, turn) in ((found[0], found[1], x[:2]), (found[2], found[3], x[2:])):
        assert np.exp(-(a * a + b * b) / 2.0) * 2**32 == pytest.approx(length + 0.5, rel=1e-12)
        assert np.angle((a + 1j * b) * np.exp(-2j * np.pi * (turn + 0.5) / 2**32)) == pytest.approx(0.0, abs=1e-12)


def test_the_largest_and_the_smallest_number_are_finite():
    assert normal_radius(0) == pytest.approx(np.sqrt(66.0 * np.log(2.0)), rel=1e-15)
    assert 0.0 < normal_radius(MASK) < 2e-5


@given(st.integers(0, 10**9), st.integers(0, 100))
def test_a_flight_in_a_block_gets_the_bits_of_a_flight_alone(step, draw):
    rows = np.array([[step, draw, *key_from_seed(seed)] for seed in range(LANES)])
    assert code(LANES)(rows).tobytes() == code(1)(rows).tobytes()


def test_the_numbers_are_normal(sample):
    for part in sample.reshape(-1, STEPS):
        assert stats.kstest(part, "norm").pvalue > 1e-4  # of 60 parts
    assert stats.kstest(sample.ravel(), "norm").pvalue > 1e-2


def test_steps_do_not_depend_on_one_another(sample):
    """Correlations of the numbers and of their squares, at lags of up to 50 steps, within five standard errors."""
    for series in (sample, (sample**2 - 1.0) / np.sqrt(2.0)):
        for lag in (*range(1, 11), 16, 32, 50):
            found = np.mean(series[..., lag:] * series[..., :-lag])
            assert abs(found) < 5.0 / np.sqrt(series[..., lag:].size)


def test_draws_and_the_four_of_a_draw_do_not_depend_on_one_another(sample):
    """Nor do those of different seeds: correlations between any two series of steps, and of their squares."""
    for series in (sample, sample**2, np.abs(sample)):
        R = np.corrcoef(series.reshape(-1, STEPS))
        assert np.abs(R - np.eye(len(R))).max() < 5.0 / np.sqrt(STEPS)


def test_a_key_is_two_words_that_floats_hold_and_seeds_do_not_share():
    keys = [key_from_seed(seed) for seed in range(2000)]
    assert len(set(keys)) == len({key for key, _ in keys}) == len({key for _, key in keys}) == 2000
    assert all(isinstance(word, float) and word == int(word) and 0 <= word <= MASK for key in keys for word in key)
    assert [int(word) for word in key_from_seed(7)] == list(np.random.SeedSequence(7).generate_state(2))
