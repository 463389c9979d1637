"""The optimiser against functions whose minimum is known, through the interface that missions are tuned by."""

import math
import sys
from importlib.machinery import BuiltinImporter

import numpy as np
import pytest

from tandemlift.analysis.studies.tuning.optimisers import FAR_STEP, EvolutionStrategy
from tandemlift.analysis.studies.tuning.parameters import Tunable
from tandemlift.core.errors import InputError


def plain(count, present=-1.0, low=-5.0, high=5.0):
    return [Tunable(f"x{i}", None, present, low, high) for i in range(count)]


def rosenbrock(x):
    return float(np.sum(100.0 * (x[1:] - x[:-1] ** 2) ** 2 + (1.0 - x[:-1]) ** 2))


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


def test_the_minimum_of_rosenbrock_is_found():
    lowest, point, _ = searched(EvolutionStrategy(plain(5), seed=1), rosenbrock, 4_000)
    assert lowest < 1e-10
    np.testing.assert_allclose(point, 1.0, atol=1e-4)


def test_a_number_that_is_wrong_by_a_factor_of_300_is_found():
    numbers = [Tunable(f"gain.{i}", i, 30.0, 0.03, 3e4, is_log=True) for i in range(3)]
    wanted = np.array([0.1, 9.0, 300.0])
    cost = lambda x: float(np.sum(np.log(x / wanted) ** 2))  # noqa: E731
    _, point, _ = searched(EvolutionStrategy(numbers, seed=0, step=FAR_STEP), cost, 1_000)
    np.testing.assert_allclose(point, wanted, rtol=1e-3)


def test_a_minimum_on_a_bound_is_found_and_no_candidate_is_beyond_it():
    numbers = [Tunable("x", None, 2.0, 0.5, 4.0, is_log=True), Tunable("y", None, 0.0, -1.0, 1.0)]

    def cost(point):
        assert all(number.low <= x <= number.high for number, x in zip(numbers, point, strict=True))
        return float(point[0] + (point[1] - 3.0) ** 2)

    _, point, _ = searched(EvolutionStrategy(numbers, seed=0), cost, 800)
    assert point == pytest.approx([0.5, 1.0], abs=1e-6)


def cliff(x):
    """A quadratic cost with its minimum at 0.5; beyond 0.6 the outcome is bad, which counts first."""
    bad, ratio = int(x[0] > 0.6), (x[0] - 0.5) ** 2 + (x[1] + 1.0) ** 2
    return bad + ratio / (1.0 + ratio)


def test_a_search_that_begins_among_bad_outcomes_ends_beside_the_cliff():
    numbers = [Tunable("x", None, 4.0, -5.0, 5.0), Tunable("y", None, 3.0, -5.0, 5.0)]
    lowest, point, _ = searched(EvolutionStrategy(numbers, seed=0), cliff, 1_200)
    assert lowest < 1e-8
    np.testing.assert_allclose(point, [0.5, -1.0], atol=1e-3)


def test_a_search_and_numpys_own_random_numbers_leave_each_other_alone():
    def path(noise):
        optimiser, seen = EvolutionStrategy(plain(4), seed=11), []
        for _ in range(6):
            np.random.seed(noise)  # noqa: NPY002
            points = optimiser.ask()
            seen += points
            optimiser.tell(points, [rosenbrock(np.array(p)) for p in points])
            assert np.random.random() == np.random.RandomState(noise).random()  # noqa: NPY002
        return np.array(seen).tobytes()

    assert path(1) == path(2)


def test_a_missing_package_is_named_with_the_command_that_installs_it(monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "cma"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "meta_path", [BuiltinImporter])  # no package is found
    with pytest.raises(InputError, match=r"needs cma: pip install 'tandemlift\[tune\]'"):
        EvolutionStrategy(plain(2), seed=0)
