"""A sharp peak of µ between two frequencies of the loop is found, whether its frequency is known or not."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.analysis.certification import uncertain_loop as loops
from tandemlift.analysis.certification.uncertain_loop import STRIDE, proven_factor

PEAK = 7.3  # rad/s


@pytest.mark.parametrize(("near", "sharp"), [(math.nan, 20.0), (PEAK, 100.0)])
def test_frequencies_are_close_about_the_peak_so_that_the_proof_reaches_its_height(near, sharp, monkeypatch):
    """µ = 0.8/(1 + (sharp log(w/7.3))²): its largest value proves the factor 1/0.8."""

    def mu(w):
        return 0.8 / (1.0 + (sharp * np.log(w / PEAK)) ** 2)

    hovers = SimpleNamespace(w=np.geomspace(0.1, 100.0, 241))
    deviations = SimpleNamespace(widths={"mass": 0.1}, stable=lambda values: True)
    monkeypatch.setattr(loops, "family_at", lambda hovers, w: w)
    monkeypatch.setattr(loops, "bounds_of", lambda w, widths: [SimpleNamespace(value=float(mu(x))) for x in w])
    monkeypatch.setattr(
        loops, "uncertain_loop", lambda w, box: SimpleNamespace(M=box["mass"].half / 0.1 * mu(w), blocks=())
    )
    monkeypatch.setattr(loops, "upper_bound", lambda M, blocks, start, enough: SimpleNamespace(value=M))
    factor, w, found = proven_factor(hovers, deviations, near)
    assert found == pytest.approx(mu(w))
    assert factor == pytest.approx(1.0 / mu(w).max())
    assert factor == pytest.approx(1.0 / 0.8, rel=0.03)
    coarse = (1e3) ** (STRIDE / 240.0)
    between = (w > PEAK / coarse) & (w < PEAK * coarse)
    assert between.sum() > 10
    assert (w[0], w[-1]) == (0.1, pytest.approx(100.0))
