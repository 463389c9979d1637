"""Intervals of shares and quantiles, held against SciPy's own tests and against published numbers of flights."""

import math

import numpy as np
import pytest
from scipy import stats

import tandemlift as tl
from tandemlift.analysis.studies.execution.statistics import quantile, share, upper_bound


@pytest.mark.parametrize(
    ("count", "total", "confidence"), [(0, 7, 0.95), (3, 10, 0.5), (10, 10, 0.95), (17, 2_995, 0.999), (2, 10**6, 0.95)]
)
def test_the_interval_of_a_share_is_that_of_the_exact_binomial_test(count, total, confidence):
    exact = stats.binomtest(count, total).proportion_ci(confidence, method="exact")
    found = share(count, total, confidence)
    assert (found.low, found.high) == pytest.approx(
        (exact.low, exact.high), rel=1e-9, abs=1e-11
    )  # it searches to 2e-12
    assert found.value == count / total


@pytest.mark.parametrize(
    ("flights", "confidence", "most"), [(2_995, 0.95, 1e-3), (46_050, 0.99, 1e-4), (2_995_731, 0.95, 1e-6)]
)
def test_as_many_flights_without_a_failure_as_are_needed_for_a_bound_give_it_and_one_less_does_not(
    flights, confidence, most
):
    assert upper_bound(0, flights, confidence) <= most < upper_bound(0, flights - 1, confidence)


def test_no_rows_say_nothing():
    nothing = share(0, 0)
    assert math.isnan(nothing.value)
    assert (nothing.low, nothing.high) == (0.0, 1.0)
    assert all(map(math.isnan, quantile(np.array([math.nan]))))


@pytest.mark.parametrize(("count", "at"), [(1, 0.5), (5, 0.5), (6, 0.5), (20, 0.05), (20, 0.9), (999, 0.05)])
def test_the_interval_of_a_quantile_is_that_of_the_quantile_test(count, at):
    values = np.random.default_rng(count).normal(size=count)
    with_gaps = np.concatenate([values, [math.nan, math.inf]])
    exact = stats.quantile_test(values, p=at).confidence_interval(0.95)
    found = quantile(with_gaps, at)
    assert (found.low, found.high) == pytest.approx((exact.low, exact.high), nan_ok=True)
    assert found.value == np.quantile(values, at)


@pytest.mark.parametrize(
    "wrong", [lambda: share(3, 2), lambda: share(-1, 2), lambda: share(1, 2, 1.0), lambda: quantile(np.ones(3), at=0.0)]
)
def test_numbers_that_mean_nothing_are_refused(wrong):
    with pytest.raises(tl.InputError, match="must be"):
        wrong()
