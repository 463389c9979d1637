"""The bound of µ: against the spinning satellite, closed forms, slycot and brute force."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tandemlift.analysis.certification.structured_singular_value import DeltaBlock, upper_bound

pytest.importorskip("scipy")
REAL, COMPLEX = DeltaBlock(1, real=True), DeltaBlock(1, real=False)
SPIN = 10.0  # rad/s, of the satellite


def satellite(w):
    """The closed loop T of a spinning satellite with unit feedback at a frequency [rad/s]; Zhou and Doyle, 1998."""
    return np.array([[1.0, SPIN], [-SPIN, 1.0]]) / (1j * w + 1.0)


def peak(response, blocks, frequencies):
    """The largest bound of µ over frequencies."""
    return max(upper_bound(response(w), blocks).value for w in frequencies)


@pytest.mark.parametrize("block", [REAL, COMPLEX])
def test_gains_of_a_spinning_satellite_may_be_off_together_by_a_tenth_though_either_alone_may_vanish(block):
    together = peak(satellite, [block, block], [0.0, 0.1, 1.0, 10.0])
    assert together == pytest.approx(np.sqrt(1.0 + SPIN**2), rel=1e-3)
    assert upper_bound(satellite(0.0)[:1, :1], [block]).value == pytest.approx(1.0)
    off = 1.0 / together
    gains = np.diag([1.0 + off, 1.0 - off])
    rates = np.linalg.eigvals(np.array([[0.0, SPIN], [-SPIN, 0.0]]) - gains @ np.array([[1.0, SPIN], [-SPIN, 1.0]]))
    assert rates.real.max() == pytest.approx(0.0, abs=1e-3)  # states with x' = A x − B K y, y = C x


@pytest.mark.parametrize("real", [0, 2, 5])
def test_the_bound_is_that_of_slycot_where_no_real_delta_is_repeated(real):
    slycot = pytest.importorskip("slycot")
    rng = np.random.default_rng(real)
    for _ in range(4):
        M = rng.normal(size=(5, 5)) + 1j * rng.normal(size=(5, 5))
        known = slycot.ab13md(M, np.ones(5, dtype=int), np.array([1] * real + [2] * (5 - real)))[0]
        assert upper_bound(M, [REAL] * real + [COMPLEX] * (5 - real)).value == pytest.approx(known, rel=2e-3)


def test_a_repeated_real_delta_has_the_largest_real_eigenvalue():
    rng = np.random.default_rng(4)
    for _ in range(4):
        M = rng.normal(size=(5, 5))
        values = np.linalg.eigvals(M)
        largest = np.abs(values[np.abs(values.imag) < 1e-9]).max()
        assert upper_bound(M + 0j, [DeltaBlock(5, real=True)]).value == pytest.approx(largest, rel=1e-3)
        assert upper_bound(M + 0j, [REAL] * 5).value > 1.02 * largest


def test_a_rotation_is_no_limit_to_a_real_gain():
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]], dtype=complex)
    assert upper_bound(turn, [DeltaBlock(2, real=True)]).value < 1e-3
    assert upper_bound(turn, [DeltaBlock(2, real=False)]).value == pytest.approx(1.0)


def test_two_parameters_of_a_third_order_loop_end_where_routh_and_a_grid_say():
    a, b, c, da, db = 2.0, 3.0, 2.5, 1.0, 1.2  # s³ + (a + da δ₁) s² + (b + db δ₂) s + c

    def response(w):
        s = 1j * w
        column = np.array([da * s**2, db * s])
        return -np.outer(column, [1.0, 1.0]) / (s**3 + a * s**2 + b * s + c)

    routh = min(root.real for root in np.roots([da * db, -(a * db + b * da), a * b - c]) if root.real > 0.0)
    bound = peak(response, [REAL, REAL], [0.5, 1.0, *np.linspace(1.38, 1.48, 41), 2.0])
    assert 1.0 / bound == pytest.approx(routh, rel=0.01)
    inside = np.linspace(-1.0, 1.0, 21) / bound
    for x, y in itertools.product(inside, inside):
        assert np.roots([1.0, a + da * x, b + db * y, c]).real.max() < 1e-3


def test_the_search_ends_early_with_a_bound_that_holds():
    M = np.random.default_rng(7).normal(size=(4, 4)) + 0j
    blocks = [DeltaBlock(2, real=True), REAL, REAL]
    best = upper_bound(M, blocks)
    early = upper_bound(M, blocks, enough=2.0 * best.value)
    assert best.value - 1e-9 <= early.value <= 2.0 * best.value
    again = upper_bound(1.01 * M, blocks, start=best, enough=1.02 * best.value)
    assert again.value <= 1.02 * best.value
