"""The tare from sums of samples, against NumPy's means and least squares on all of them."""

import numpy as np
import pytest

from tandemlift.core.vector import ZERO, each, vec3
from tandemlift.parts.estimation.tare import SideForces, TareSums, summed, tare_of

PAIR = each(2)
NONE = TareSums(0.0, ZERO, ZERO, ZERO, 0.0, 0.0, SideForces(PAIR(0.0, 0.0), PAIR(0.0, 0.0)))
RNG = np.random.default_rng(0)
COUNT, MASS = 50, 1.3
SPECIFIC = [0.1, -0.2, 9.8] + 0.05 * RNG.normal(size=(COUNT, 3))
FORCE = MASS * SPECIFIC + [0.3, 0.2, 0.0] + 0.1 * RNG.normal(size=(COUNT, 3))
MOMENT, SIDES = RNG.normal(size=(COUNT, 3)), RNG.normal(size=(COUNT, 2, 2))


def tared(identify=1.0, armed=1.0, first=0, until=COUNT):
    """The tare over samples; those before the first count before it has begun, those from `until` on are not taken."""
    sums = NONE
    for k, (f, a, moment, (x, y)) in enumerate(zip(FORCE, SPECIFIC, MOMENT, SIDES, strict=True)):
        begun, taken = float(k >= first), float(first <= k < until)
        sides = SideForces(PAIR(*x.tolist()), PAIR(*y.tolist()))
        sums = summed(sums, begun, taken, vec3(f), vec3(a), vec3(moment), sides)
    return tare_of(2.0, identify, sums, armed)


@pytest.mark.parametrize(("first", "until"), [(0, COUNT), (10, COUNT), (10, 40)])
def test_it_is_the_least_squares_mass_and_the_mean_of_what_is_left(first, until):
    part = slice(first, until)
    (mass,), *_ = np.linalg.lstsq(SPECIFIC[part].reshape(-1, 1), FORCE[part].ravel(), rcond=None)
    found = tared(first=first, until=until)
    assert found.mass == pytest.approx(mass)
    assert found.force == pytest.approx((mass * SPECIFIC[part] - FORCE[part]).mean(axis=0))
    assert found.moment == pytest.approx(MOMENT[part].mean(axis=0))
    assert np.array(found.sides) == pytest.approx(SIDES[part].mean(axis=0))


def test_without_identification_the_mass_is_the_nominal_one_and_before_its_end_there_is_no_bias():
    found = tared(identify=0.0)
    assert found.mass == 2.0
    assert found.force == pytest.approx((2.0 * SPECIFIC - FORCE).mean(axis=0))
    early = tared(armed=0.0)
    assert (early.mass, early.force, early.moment) == (2.0, ZERO, ZERO)
    assert not np.array(early.sides).any()


def test_a_sum_that_was_begun_too_early_is_forgotten():
    sums = NONE
    for begun in (1.0, 0.0, 1.0):
        sums = summed(sums, begun, begun, vec3(FORCE[0]), vec3(SPECIFIC[0]), vec3(MOMENT[0]), NONE.sides)
    assert sums.count == 1.0
    assert sums.force == pytest.approx(FORCE[0])
    assert (sums.weight, sums.square) == pytest.approx((FORCE[0] @ SPECIFIC[0], SPECIFIC[0] @ SPECIFIC[0]))
