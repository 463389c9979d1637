"""The places that a led vehicle takes, before any flight: a tractrix behind a hand, and headings at a limited rate."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tandemlift.parts.interaction.passage import APART, TURNING, trailing, turning


@pytest.mark.parametrize("grip", [1.0, -1.0])
def test_behind_a_hand_that_goes_straight_the_centre_follows_a_tractrix(grip):
    """The grip is led along x from a heading across it; the lag angle obeys dθ/ds = −sin θ / a, here by SciPy."""
    a, steps = abs(grip), np.arange(0.0, 4.0, 0.001)
    grips = np.column_stack([steps, np.zeros(len(steps))])
    places = trailing(grips, grip, 0.3 if grip > 0.0 else 0.3 - np.pi)
    away = grips[0] - places.centres[0]
    start = np.arctan2(away[1], away[0])
    lag = solve_ivp(lambda s, y: -np.sin(y) / a, (0.0, 4.0), [start], t_eval=steps, rtol=1e-9, atol=1e-12).y[0]
    expected = grips - a * np.column_stack([np.cos(lag), np.sin(lag)])
    assert np.linalg.norm(places.centres - grips, axis=1) == pytest.approx(a)
    assert places.centres == pytest.approx(expected, abs=2e-3)
    body_y = np.column_stack([-np.sin(places.headings), np.cos(places.headings)])
    assert places.centres + grip * body_y == pytest.approx(grips, abs=1e-9)


def test_a_hand_at_the_centre_leaves_the_heading_open():
    assert trailing(np.zeros((3, 2)), 0.0, 0.0) is None


def test_a_heading_is_kept_and_another_is_reached_the_short_way_at_a_limited_rate():
    assert turning(np.full(20, 0.8), 0.5) == pytest.approx(np.full(20, 0.8))
    most = TURNING * APART / 0.5
    found = turning(np.concatenate([[3.0], np.full(60, -3.0)]), 0.5)  # across ±π
    assert np.diff(found).max() == pytest.approx(most)
    assert np.diff(found).min() >= -1e-12
    assert found[-1] == pytest.approx(2.0 * np.pi - 3.0)
