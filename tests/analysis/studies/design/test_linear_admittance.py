"""The spread of a linear admittance under a random steady push and random damping is that of its closed form.

Free of stiffness and threshold, M x″ + C x′ = F from rest. The simulated admittance holds x″ over a step, so with
q = 1 − C dt/M its position after n steps is F/C (T − (M/C − dt/2) (1 − qⁿ)), and never more than F/C dt/2 off the
continuous one.
"""

import numpy as np
import pytest
from scipy import stats
from scipy.optimize import brentq

import tandemlift as tl

ROWS, T, M, DT = 512, 2.0, 1.0, 0.001
MEAN, DEVIATION, LEAST = 1.0, 0.2, 0.2  # N
LOW, HIGH = 1.5, 4.0  # N s/m
STUDY = {
    "study": {"name": "linear", "missions": ["one-push"], "draws": ROWS, "seed": 3},
    "set": {
        "mission.duration": T,
        "admittance": {"mass": M, "stiffness": 0.0, "threshold": 0.0},
        "pushes": [{"force": [1.0, 0.0, 0.0], "time": 0.0, "sigma": 1e9}],  # a steady push
    },
    "draw": {
        "admittance.damping": {"distribution": "uniform", "low": LOW, "high": HIGH},
        "pushes": {
            "0": {"force": {"0": {"distribution": "normal", "mean": MEAN, "deviation": DEVIATION, "low": LEAST}}}
        },
    },
    "keep": {"channels": ["reference_position"], "rows": [7]},
}
FORCE = stats.truncnorm((LEAST - MEAN) / DEVIATION, np.inf, loc=MEAN, scale=DEVIATION)


def response(C, t):
    """Position [m] after a time [s] under 1 N."""
    return (t - M / C * (1.0 - np.exp(-C / M * t))) / C


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The study, flown."""
    return tl.study(STUDY, tmp_path_factory.mktemp("linear"))


@pytest.fixture(scope="module")
def columns(study):
    """Damping, force, and the reference's last position, by row."""
    names = ("admittance.damping", "pushes.0.force.0", "final_reference_m.0")
    return [study.table.column(name).to_numpy() for name in names]


def test_every_row_ends_where_the_closed_form_ends(columns):
    C, F, found = columns
    q, steps = 1.0 - C * DT / M, round(T / DT)
    stepped = F / C * (T - (M / C - DT / 2.0) * (1.0 - q**steps))
    assert np.abs(found / stepped - 1.0).max() < 1e-9
    error = found - F * response(C, T)
    assert (np.abs(error) < F / C * DT / 2.0).all()
    assert np.abs(error / found).max() < 5e-4


def test_the_whole_flight_of_a_row_follows_the_closed_form(study, columns):
    C, F, _ = (column[7] for column in columns)
    kept = study.channels(7)
    expected = F * response(C, kept["time"])
    assert np.abs(kept["reference_position"][:, 0] - expected).max() < F / C * DT / 2.0
    assert expected[-1] > 0.1  # m


def share_below(x):
    """P(F g(C) ≤ x) at each x, for C uniform and F normal, cut off."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    C = (LOW + HIGH) / 2.0 + (HIGH - LOW) / 2.0 * nodes
    return FORCE.cdf(np.asarray(x)[..., None] / response(C, T)) @ weights / 2.0


def test_the_spread_is_that_of_the_closed_form(columns):
    _, _, found = columns
    assert stats.kstest(found, share_below).pvalue > 0.01
    for share in (0.05, 0.5, 0.95):
        quantile = brentq(lambda x, share=share: share_below(x) - share, 0.05, 5.0)
        least, most = stats.binom(ROWS, share).ppf([0.001, 0.999])
        assert least <= (found <= quantile).sum() <= most
