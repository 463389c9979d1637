"""The share of a wanted wrench that thrusts give."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from bounded_problems import EVERY, Craft, craft, outside, problems, solve

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
