"""Intervals: exactness of rounding against fractions and mpmath, containment of laws' own values."""

from __future__ import annotations

import math
import operator
from fractions import Fraction

import numpy as np
import pytest

from tandemlift.analysis.certification.intervals import Interval, bounds
from tandemlift.analysis.certification.nonlinear import box_of
from tandemlift.core import algebra
from tandemlift.missions import load_mission
from tandemlift.parts.pilot.commanded_thrusts import commanded_thrusts
from tandemlift.simulation.pilot_api import pilot_at_start

mpmath = pytest.importorskip("mpmath")
ELEMENTARY = {"sin": 50.0, "cos": 50.0, "tan": 1.5, "tanh": 20.0, "exp": 700.0, "expm1": 30.0}
UP_TO_TWO = np.array([[0.0]]), np.array([[2.0]])
CONTROLLERS = ("nftsmc", "geometric", "pid", "lqr", "smc", "super-twisting")


def point(x):
    return Interval(np.float64(x), np.float64(x))


@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul, operator.truediv])
def test_bounds_of_an_operation_hold_its_exact_result_and_are_next_to_it(operation):
    rng = np.random.default_rng(1)
    for a, b in rng.uniform(-1.0, 1.0, (500, 2)) * 10.0 ** rng.integers(-12, 12, (500, 2)):
        found, exact = operation(point(a), point(b)), operation(Fraction(a), Fraction(b))
        assert Fraction(float(found.lo)) <= exact <= Fraction(float(found.hi))
        assert found.hi - found.lo <= 2.0 * np.spacing(abs(float(exact)))


def test_a_product_that_underflows_is_not_lost():
    found = point(1e-200) * point(-1e-200)
    assert found.lo < 0.0 <= found.hi


@pytest.mark.parametrize("name", ELEMENTARY)
def test_bounds_of_an_elementary_function_hold_its_exact_value(name):
    for x in np.random.default_rng(2).uniform(-ELEMENTARY[name], ELEMENTARY[name], 300):
        found = getattr(algebra, name)(point(x))
        with mpmath.workdps(60):
            exact = getattr(mpmath, name)(mpmath.mpf(float(x)))
            assert mpmath.mpf(float(found.lo)) < exact < mpmath.mpf(float(found.hi))


@pytest.mark.parametrize(
    "law",
    [
        lambda x, y: algebra.sin(x) * y + algebra.cos(y),
        lambda x, y: algebra.atan2(x, y),
        lambda x, y: algebra.sqrt(x * x + y * y),
        lambda x, y: algebra.clip(x, -0.3, 0.4) / (3.0 + y),
        lambda x, y: algebra.where(x > y, x - y, 2.0 * y) + algebra.absolute(x),
        lambda x, y: algebra.where((x > 0.1) & (y < 0.2), 1.0, x),
        lambda x, y: algebra.where((x == 0.5) | (y != 0.25), x, -y),
        lambda x, y: algebra.power(algebra.absolute(x), 1.5) - algebra.tanh(y),
    ],
)
def test_bounds_over_boxes_hold_the_values_at_all_sampled_points(law):
    rng = np.random.default_rng(3)
    centre, half = rng.uniform(-2.0, 2.0, (2, 100)), rng.uniform(0.0, 0.5, (2, 100))
    centre[:, :6] = [[0.5, 0.5, 0.0, 0.0, -0.25, 0.1], [0.25, 0.0, 0.0, -1.0, 0.25, 0.2]]  # on edges of the laws
    for part in range(100):
        low, high = centre[:, [part]] - half[:, [part]], centre[:, [part]] + half[:, [part]]
        least, most = bounds(lambda x: [law(*x)], low, high)
        for share in [*rng.uniform(0.0, 1.0, (40, 2)), (0.0, 0.0), (1.0, 1.0), (0.5, 0.5)]:
            x, y = np.minimum(low[:, 0] + np.array(share) * (high - low)[:, 0], high[:, 0]).tolist()
            assert least[0] <= law(x, y) <= most[0]


def test_what_may_be_no_number_is_marked():
    for law in (lambda x: algebra.sqrt(x - 1e-9), lambda x: 1.0 / (x - 1.0), algebra.log, algebra.tan):
        assert all(math.isnan(end[0]) for end in bounds(lambda x, law=law: [law(x[0])], *UP_TO_TWO))
    assert bounds(lambda x: [algebra.sqrt(x[0])], *UP_TO_TWO)[0][0] == 0.0


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_thrusts_over_a_box_hold_those_of_every_state_in_it(controller):
    pilot = pilot_at_start(load_mission("iris", controller=controller))
    thrusts = commanded_thrusts(pilot.parameters, pilot.memory)
    rng = np.random.default_rng(4)
    for scale in (0.003, 0.05, 0.4):
        half = scale * rng.uniform(0.2, 1.0, 12)
        least, most = bounds(thrusts, *box_of(half))
        assert np.isfinite([least, most]).all()
        drawn = rng.uniform(-1.0, 1.0, (150, 12))
        found = np.array([thrusts((half * x).tolist()) for x in [*drawn, *np.sign(drawn)]])
        assert (found >= least).all()
        assert (found <= most).all()


def test_thrusts_over_a_small_box_are_bounded_within_a_tenth():
    pilot = pilot_at_start(load_mission("zigzag"))
    thrusts, half = commanded_thrusts(pilot.parameters, pilot.memory), np.full(12, 0.01)
    least, most = bounds(thrusts, *box_of(half))
    corners = np.sign(np.random.default_rng(5).normal(size=(4000, 12)))
    found = np.array([thrusts((half * x).tolist()) for x in corners])
    assert (most - least).max() < 1.1 * (found.max(axis=0) - found.min(axis=0)).max()
