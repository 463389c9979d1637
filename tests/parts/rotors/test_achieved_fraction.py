"""The share of a wanted wrench that thrusts give."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from bounded_problems import EVERY, Craft, craft, outside, problems, solve
from law_values import flat, rebuilt
from machine_code import answers

from tandemlift.core.vector import each, vec3
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.rotors.allocation import Mixer, achieved_fraction, wrench_scale


def share(c: Craft, wanted: Any, f: Any) -> float:
    n = c.B.shape[1]
    effect = Mixer(*[each(n)(*map(float, row)) for row in c.B])
    tau = Wrench(float(wanted[0]), vec3(wanted[1:]))
    return float(achieved_fraction(effect, wrench_scale(c.B), tau, each(n)(*map(float, f))))


@EVERY
def test_a_part_of_a_wrench_is_that_share_of_it(count, layout):
    c = craft(count, layout)
    for p in problems(c, 20, seed=10):
        for part, wanted_share in ((0.0, 0.0), (0.25, 0.25), (1.0, 1.0), (1.5, 0.5), (-1.0, 0.0), (3.0, 0.0)):
            assert share(c, p.wanted, part * p.unlimited) == pytest.approx(wanted_share, abs=1e-9)


@EVERY
def test_the_share_given_is_whole_within_the_limits_and_a_part_beyond(count, layout):
    c = craft(count, layout)
    for p in problems(c, 200, seed=11):
        found = share(c, p.wanted, solve(c, p).f)
        assert 0.0 <= found <= 1.0
        if not outside(p):
            assert found == pytest.approx(1.0, abs=1e-9)


def test_nothing_wanted_is_wholly_given():
    c = craft(2, "+")
    assert share(c, np.zeros(4), np.zeros(8)) == 1.0
    assert share(c, np.zeros(4), np.ones(8)) == 1.0


class Shared(NamedTuple):
    """Arguments of `achieved_fraction`."""

    effect: Mixer
    scale: Wrench
    wanted: Wrench
    thrusts: Any


def shared(numbers: Any) -> Any:
    return achieved_fraction(*rebuilt(numbers, SHARED))


ROW = each(4)(0.0, 0.0, 0.0, 0.0)
SHARED = Shared(Mixer(ROW, ROW, ROW, ROW), wrench_scale(np.eye(4)), wrench_scale(np.eye(4)), ROW)


def test_the_share_is_the_same_in_every_library(jax, casadi):
    size, rng = len(flat(SHARED)), np.random.default_rng(12)
    table = rng.uniform(0.2, 1.0, (size, 12))
    wanted = [shared(map(float, column)) for column in table.T]
    symbols = casadi.SX.sym("numbers", size)
    by_casadi = casadi.Function("share", [symbols], [shared(casadi.vertsplit(symbols))])
    assert np.ptp(wanted) > 0.1
    assert shared(table) == pytest.approx(wanted, abs=1e-12)
    assert np.asarray(shared(list(jax.numpy.asarray(table)))) == pytest.approx(wanted, abs=1e-12)
    assert np.array(by_casadi(table)).ravel() == pytest.approx(wanted, abs=1e-12)
    for lanes in (1, 8):
        assert answers(achieved_fraction, tuple(SHARED), table.T, lanes).ravel() == pytest.approx(wanted, abs=1e-12)
