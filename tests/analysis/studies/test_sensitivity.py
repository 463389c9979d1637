"""What a quantity depends on, held against closed forms and against SciPy's own Sobol' indices."""

import math

import numpy as np
import pytest
from scipy import stats

import tandemlift as tl
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.sensitivity import FEWEST, MOST, RBD_FAST, SALTELLI, analyse
from tandemlift.analysis.studies.table import Study

A, B = 7.0, 0.1


def ishigami(x):
    """Ishigami and Homma (1990), at points (n, 3) within ±π."""
    return np.sin(x[:, 0]) + A * np.sin(x[:, 1]) ** 2 + B * x[:, 2] ** 4 * np.sin(x[:, 0])


FIRST_ALONE, SECOND_ALONE = 0.5 * (1.0 + B * math.pi**4 / 5.0) ** 2, A**2 / 8.0  # shares of the variance
TOGETHER = 8.0 * B**2 * math.pi**8 / 225.0
VARIANCE = FIRST_ALONE + SECOND_ALONE + TOGETHER


def plan_of(sampling, draws):
    """The plan of a study that draws three numbers within ±π; nothing of it is flown."""
    three = {"distribution": "uniform", "low": -math.pi, "high": math.pi, "count": 3}
    study = {"name": "ishigami", "missions": ["one-push"], "draws": draws, "sampling": sampling, "seed": 1}
    return load_plan({"study": study, "draw": {"disturbance.force": three}})


def drawn(plan):
    """What a study would fly: its drawn points, and the values of the rows (rows, 3)."""
    values = np.array([row.varied["disturbance.force"] for row in plan.rows(0, plan.count)])
    return Study(None, plan, ()).drawn_points(), values


@pytest.fixture(scope="module")
def saltelli():
    points, x = drawn(plan_of("saltelli", 2**11))
    return analyse(points, ishigami(x), "saltelli")


def check_within(found, true, most):
    """An estimate and its interval, which is no wider than it may be, hold the true value; 1.5 of its widths, as ten
    intervals of 95 % seldom all do."""
    half = 0.5 * (found.high - found.low)
    assert half <= most
    assert abs(found.value - true) <= 1.5 * half


def test_the_indices_of_ishigami_come_out_of_a_saltelli_design(saltelli):
    first, second, third = saltelli.first
    assert (saltelli.method, saltelli.rows, saltelli.left_out) == (SALTELLI, 2**11 * 8, 0)
    check_within(saltelli.first[first], FIRST_ALONE / VARIANCE, 0.06)
    check_within(saltelli.first[second], SECOND_ALONE / VARIANCE, 0.06)
    check_within(saltelli.first[third], 0.0, 0.06)
    check_within(saltelli.total[first], (FIRST_ALONE + TOGETHER) / VARIANCE, 0.08)
    check_within(saltelli.total[second], SECOND_ALONE / VARIANCE, 0.06)
    check_within(saltelli.total[third], TOGETHER / VARIANCE, 0.06)
    check_within(saltelli.second[first, third], TOGETHER / VARIANCE, 0.1)
    check_within(saltelli.second[first, second], 0.0, 0.1)
    check_within(saltelli.second[second, third], 0.0, 0.1)
    assert saltelli.strongest == [first, second, third]


def test_they_are_those_of_scipy(saltelli):
    other = stats.sobol_indices(
        func=lambda x: ishigami(x.T), n=2**13, dists=[stats.uniform(-math.pi, 2.0 * math.pi)] * 3, rng=2
    )
    assert [e.value for e in saltelli.first.values()] == pytest.approx(other.first_order, abs=0.02)
    assert [e.value for e in saltelli.total.values()] == pytest.approx(other.total_order, abs=0.02)


@pytest.mark.parametrize("sampling", ["random", "latin-hypercube", "sobol"])
def test_first_order_indices_come_out_of_any_draws_and_rows_without_a_value_are_left_out(sampling):
    points, x = drawn(plan_of(sampling, 2**12))
    values = ishigami(x)
    values[::50] = math.nan
    found = analyse(points, values, sampling)
    holes = -(-(2**12) // 50)
    assert (found.method, found.rows, found.left_out) == (RBD_FAST, 2**12 - holes, holes)
    assert (found.total, found.second) == ({}, {})
    for estimate, alone in zip(found.first.values(), (FIRST_ALONE, SECOND_ALONE, 0.0), strict=True):
        assert estimate.value == pytest.approx(alone / VARIANCE, abs=0.03)
        assert estimate.low < alone / VARIANCE + 0.02
        assert estimate.high > alone / VARIANCE - 0.02
        assert estimate.high - estimate.low < 0.15


def test_ranks_are_those_of_scipy_and_say_the_direction():
    points, x = drawn(plan_of("random", 500))
    values = x[:, 0] ** 3 - 0.5 * x[:, 1]
    found = analyse(points, values)
    for name, column in zip(points, x.T, strict=True):
        assert found.ranks[name] == pytest.approx(stats.spearmanr(column, values).statistic, abs=1e-12)
    assert [found.ranks[name] > 0.0 for name in list(points)[:2]] == [True, False]


def test_what_takes_few_values_is_not_confused_by_the_order_of_its_draws():
    numbers = np.random.default_rng(0)
    inputs = {"coin": np.floor(2.0 * numbers.random(4_000)), "other": np.arange(4_000) / 4_000}
    found = analyse(inputs, inputs["other"])
    assert abs(found.first["coin"].value) < 0.02
    assert found.first["other"].value > 0.98


def test_of_very_many_rows_some_are_taken():
    numbers = np.random.default_rng(0)
    found = analyse({"x": numbers.random(2 * MOST), "y": numbers.random(2 * MOST)}, numbers.random(2 * MOST))
    assert found.rows == MOST


def test_the_same_rows_give_the_same_intervals(saltelli):
    points, x = drawn(plan_of("saltelli", 2**11))
    assert analyse(points, ishigami(x), "saltelli") == saltelli


def with_holes():
    points, x = drawn(plan_of("saltelli", 2**4))
    values = ishigami(x)
    values[[3, 9]] = math.nan
    return analyse(points, values, "saltelli")


@pytest.mark.parametrize(
    ("ask", "why"),
    [
        (with_holes, "2 of 128 rows have no value, and a Saltelli design must be whole"),
        (lambda: analyse({"x": np.arange(7.0)}, np.arange(7.0), "saltelli"), "there are 7 rows"),
        (lambda: analyse({"x": np.arange(200.0)}, np.ones(200)), "the same in all rows"),
        (lambda: analyse({"x": np.arange(200.0)}, np.full(200, math.nan)), "the same in all rows"),
        (lambda: analyse({"x": np.arange(50.0)}, np.arange(50.0)), f"50 rows have a value; needs at least {FEWEST}"),
        (lambda: analyse({"x": np.arange(999.0)}, 1.0 * (np.arange(999) == 7)), "differs in too few rows"),
        (lambda: analyse({}, np.arange(50.0)), "no number is drawn"),
    ],
)
def test_rows_that_say_nothing_are_refused(ask, why):
    with pytest.raises(tl.InputError, match=why):
        ask()
