"""The optimiser against functions whose minimum is known, through the interface that missions are tuned by."""

import math
import sys

import numpy as np
import pytest

from tandemlift.analysis.studies.tuning.optimisers import FAR_STEP, EvolutionStrategy
from tandemlift.analysis.studies.tuning.parameters import Tunable
from tandemlift.core.errors import InputError


def plain(count, present=-1.0, low=-5.0, high=5.0):
    return [Tunable(f"x{i}", None, present, low, high) for i in range(count)]


def rosenbrock(x):
    return float(np.sum(100.0 * (x[1:] - x[:-1] ** 2) ** 2 + (1.0 - x[:-1]) ** 2))


def rotated_ellipsoid(x):
    """Minimum 0 at 2 on every axis; condition 1e6, along axes that a random rotation gives."""
    turned = np.linalg.qr(np.random.default_rng(3).standard_normal((len(x), len(x))))[0] @ (x - 2.0)
    return float(np.sum(10.0 ** np.linspace(0.0, 6.0, len(x)) * turned**2))


def searched(optimiser, cost, budget):
    """The lowest cost, its point, and the number of candidates."""
    best, tried = (math.inf, ()), 0
    while tried < budget and not optimiser.ended:
        points = optimiser.ask()
        costs = [cost(np.array(point)) for point in points]
        optimiser.tell(points, costs)
        tried += len(points)
        best = min(best, *zip(costs, points, strict=True))
    return *best, tried


@pytest.mark.parametrize(("count", "budget"), [(2, 1_200), (5, 4_000), (10, 12_000)])
def test_cma_finds_the_minimum_of_rosenbrock(count, budget):
    lowest, point, tried = searched(EvolutionStrategy(plain(count), seed=1), rosenbrock, budget)
    assert lowest < 1e-10
    assert tried <= budget
    np.testing.assert_allclose(point, 1.0, atol=1e-4)


def test_cma_finds_the_minimum_of_a_rotated_ellipsoid_of_condition_one_million():
    lowest, point, _ = searched(EvolutionStrategy(plain(8), seed=2), rotated_ellipsoid, 8_000)
    assert lowest < 1e-9
    np.testing.assert_allclose(point, 2.0, atol=1e-4)


def test_a_number_that_is_wrong_by_a_factor_of_300_is_found():
    numbers = [Tunable(f"gain.{i}", i, 30.0, 0.03, 3e4, is_log=True) for i in range(3)]
    wanted = np.array([0.1, 9.0, 300.0])
    cost = lambda x: float(np.sum(np.log(x / wanted) ** 2))  # noqa: E731
    _, point, _ = searched(EvolutionStrategy(numbers, seed=0, step=FAR_STEP), cost, 1_000)
    np.testing.assert_allclose(point, wanted, rtol=1e-3)


def test_a_minimum_on_a_bound_is_found_within_the_bound():
    numbers = [Tunable("x", None, 2.0, 0.5, 4.0, is_log=True), Tunable("y", None, 0.0, -1.0, 1.0)]
    _, (x, y), _ = searched(EvolutionStrategy(numbers, seed=0), lambda p: float(p[0] + (p[1] - 3.0) ** 2), 800)
    assert (x, y) == (pytest.approx(0.5, abs=1e-6), pytest.approx(1.0, abs=1e-6))
    assert x >= 0.5
    assert y <= 1.0


def test_every_candidate_is_within_its_bounds():
    numbers = plain(3, present=0.9, low=0.0, high=1.0)
    optimiser = EvolutionStrategy(numbers, seed=5, step=FAR_STEP)
    for _ in range(20):
        points = optimiser.ask()
        assert all(0.0 <= x <= 1.0 for point in points for x in point)
        optimiser.tell(points, [-sum(point) for point in points])


def cliff(x):
    """A quadratic cost with its minimum at 0.5; beyond 0.6 the outcome is bad, which counts first."""
    bad, ratio = int(x[0] > 0.6), (x[0] - 0.5) ** 2 + (x[1] + 1.0) ** 2
    return bad + ratio / (1.0 + ratio)


def test_a_search_that_begins_among_bad_outcomes_ends_beside_the_cliff():
    numbers = [Tunable("x", None, 4.0, -5.0, 5.0), Tunable("y", None, 3.0, -5.0, 5.0)]
    lowest, point, _ = searched(EvolutionStrategy(numbers, seed=0), cliff, 1_200)
    assert lowest < 1e-8
    np.testing.assert_allclose(point, [0.5, -1.0], atol=1e-3)


def test_one_seed_gives_the_same_bits_whatever_numpy_draws_meanwhile():
    def path(noise):
        optimiser, seen = EvolutionStrategy(plain(4), seed=11), []
        for _ in range(6):
            np.random.seed(noise)  # noqa: NPY002
            points = optimiser.ask()
            seen += points
            optimiser.tell(points, [rosenbrock(np.array(p)) for p in points])
        return np.array(seen).tobytes()

    assert path(1) == path(2)


def test_the_search_leaves_numpys_own_random_numbers_alone():
    np.random.seed(4)  # noqa: NPY002
    expected = np.random.random(3)  # noqa: NPY002
    np.random.seed(4)  # noqa: NPY002
    optimiser = EvolutionStrategy(plain(2), seed=0)
    optimiser.tell(points := optimiser.ask(), [rosenbrock(np.array(p)) for p in points])
    np.testing.assert_array_equal(np.random.random(3), expected)  # noqa: NPY002


def test_another_seed_gives_other_candidates():
    assert EvolutionStrategy(plain(2), seed=0).ask() != EvolutionStrategy(plain(2), seed=1).ask()


def test_a_missing_package_is_named_with_the_command_that_installs_it(monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "cma"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "cma", None)
    with pytest.raises(InputError, match=r"needs cma: pip install 'tandemlift\[tune\]'"):
        EvolutionStrategy(plain(2), seed=0)
