"""Points through a study's distributions follow the distributions of SciPy, however the points are chosen."""

import itertools

import numpy as np
import pytest
from scipy import stats
from scipy.stats import qmc

import tandemlift as tl
from tandemlift.analysis.studies.design.draws import dimensions_of, drawn_keys, values_at
from tandemlift.analysis.studies.design.sampling import point_count, points

COUNT = 10_000
SAMPLINGS = ("random", "sobol", "latin-hypercube")
NORMAL = {"distribution": "normal", "mean": 1.0, "deviation": 0.2}
CUT = stats.truncnorm(-1.0, 2.5, loc=1.0, scale=0.2)
CONTINUOUS = {
    "uniform": ({"distribution": "uniform", "low": -2.0, "high": 3.0}, stats.uniform(-2.0, 5.0)),
    "log-uniform": ({"distribution": "log-uniform", "low": 1e-3, "high": 10.0}, stats.loguniform(1e-3, 10.0)),
    "normal": (NORMAL, stats.norm(1.0, 0.2)),
    "cut-normal": ({**NORMAL, "low": 0.8, "high": 1.5}, CUT),
    "half-normal": ({**NORMAL, "low": 1.0}, stats.truncnorm(0.0, np.inf, loc=1.0, scale=0.2)),
}
DISCRETE = {
    "integer": ({"distribution": "integer", "low": -2, "high": 4}, dict.fromkeys(range(-2, 5), 1 / 7)),
    "stepped": ({"distribution": "uniform", "low": 0.1, "high": 0.3, "step": 0.05}, dict.fromkeys(range(2, 7), 1 / 5)),
    "choice": ({"distribution": "choice", "among": ["a", "b", "c", "d"]}, dict.fromkeys("abcd", 1 / 4)),
}


def values(table, sampling, seed=5, count=COUNT, beside=0):
    """Values of a drawn key, with other keys drawn before it."""
    others = {f"other{i}": {"distribution": "uniform", "low": 0.0, "high": 1.0} for i in range(beside)}
    drawn = drawn_keys({"draw": {**others, "key": table}})
    u = points(sampling, count, dimensions_of(drawn), seed, 0, count)
    return [row["key"] for row in values_at(drawn, u)]


@pytest.mark.parametrize("sampling", SAMPLINGS)
@pytest.mark.parametrize("name", CONTINUOUS)
def test_drawn_numbers_have_the_distribution_that_scipy_knows(name, sampling):
    table, known = CONTINUOUS[name]
    found = stats.kstest(values(table, sampling, beside=2), known.cdf)
    assert found.pvalue > 0.01
    if sampling != "random":
        assert found.statistic < 0.002  # evenly spread, far below 1.6/sqrt(n)


@pytest.mark.parametrize("sampling", SAMPLINGS)
@pytest.mark.parametrize("name", DISCRETE)
def test_drawn_choices_are_equally_frequent(name, sampling):
    table, known = DISCRETE[name]
    found = values(table, sampling, beside=1)
    if name == "stepped":
        assert np.ptp(np.array(found) / 0.05 - np.round(np.array(found) / 0.05)) < 1e-12
        found = [round(x / 0.05) for x in found]
    counts = {value: found.count(value) for value in known}
    assert sum(counts.values()) == COUNT
    expected = [COUNT * share for share in known.values()]
    assert stats.chisquare(list(counts.values()), expected).pvalue > 0.01


def test_a_horizontal_vector_has_any_direction_and_an_even_length():
    vectors = np.array(values({"distribution": "horizontal", "low": 0.5, "high": 2.0}, "random"))
    assert (vectors[:, 2] == 0.0).all()
    length, angle = np.hypot(*vectors[:, :2].T), np.arctan2(vectors[:, 1], vectors[:, 0])
    assert stats.kstest(length, stats.uniform(0.5, 1.5).cdf).pvalue > 0.01
    assert stats.kstest(angle, stats.uniform(-np.pi, 2.0 * np.pi).cdf).pvalue > 0.01


def test_the_entries_of_a_list_are_independent():
    drawn = np.array(values({**NORMAL, "count": 3}, "random"))
    assert drawn.shape == (COUNT, 3)
    for i in range(3):
        assert stats.kstest(drawn[:, i], stats.norm(1.0, 0.2).cdf).pvalue > 0.01
        assert stats.pearsonr(drawn[:, i], drawn[:, (i + 1) % 3]).pvalue > 0.01


@pytest.mark.parametrize("name", CONTINUOUS)
def test_the_ends_of_the_points_give_the_ends_of_the_values(name):
    table, known = CONTINUOUS[name]
    (drawn,) = drawn_keys({"draw": {"key": table}}).values()
    ends = drawn.values(np.array([[0.0], [np.nextafter(1.0, 0.0)]]))
    assert np.isfinite(ends).all()
    assert table.get("low", -np.inf) <= ends[0] < ends[1] <= table.get("high", np.inf)
    assert known.ppf([1e-12, 1.0 - 1e-12])[0] >= ends[0]


def test_sobol_points_are_those_of_scipy_and_more_even_than_random_ones():
    sobol, random = (points(sampling, 1024, 4, 9, 0, 1024) for sampling in ("sobol", "random"))
    known = qmc.Sobol(4, scramble=True, rng=np.random.default_rng(9)).random(1024)
    assert np.array_equal(sobol, known)
    hypercube = points("latin-hypercube", 1024, 4, 9, 0, 1024)
    assert qmc.discrepancy(sobol) < 0.1 * qmc.discrepancy(random)
    assert qmc.discrepancy(hypercube) < qmc.discrepancy(random)
    for axis in hypercube.T:  # one point in each slice
        assert np.array_equal(np.sort(np.floor(axis * 1024)), np.arange(1024))


@pytest.mark.parametrize("sampling", ["random", "sobol"])
def test_the_points_of_a_longer_study_begin_with_those_of_a_shorter_one(sampling):
    assert np.array_equal(points(sampling, 256, 3, 1, 0, 64), points(sampling, 64, 3, 1, 0, 64))


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_points_are_the_same_however_they_are_cut(sampling):
    assert point_count(sampling, 64, 2) > 0  # two numbers are enough for every kind
    count = point_count(sampling, 64, 3)
    whole = points(sampling, 64, 3, 1, 0, count)
    cuts = [0, 1, 7, 8, 40, count]
    parts = [points(sampling, 64, 3, 1, a, b) for a, b in itertools.pairwise(cuts)]
    assert np.array_equal(np.concatenate(parts), whole)
    assert ((whole >= 0.0) & (whole < 1.0)).all()
    assert not np.array_equal(points(sampling, 64, 3, 2, 0, count), whole)


@pytest.mark.parametrize(
    ("sampling", "draws", "dimensions", "said"),
    [
        ("sobol", 100, 3, "draws = 100: must be a power of two"),
        ("sobol", 1000, 3, "such as 512 or 1024"),
        ("latin-hypercube", 8, 0, "needs keys in [draw]"),
        ("latin-hypercube", 10**9, 3, "at most 200000000"),
    ],
)
def test_a_number_of_draws_that_does_not_suit_the_sampling_is_refused(sampling, draws, dimensions, said):
    with pytest.raises(tl.InputError) as refused:
        point_count(sampling, draws, dimensions)
    assert said in str(refused.value)
