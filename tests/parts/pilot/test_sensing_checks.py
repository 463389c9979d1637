"""The check of the push threshold against wind: what the compensation leaves of it, along each axis."""

import pytest

import tandemlift as tl
from tandemlift.missions.flight_checks import flight_checks
from tandemlift.parts.pilot.sensing_checks import REMOVED


def on_payload(velocity, compensation):
    """The wind that the check finds on the payload along the axis of a gust [N]."""
    gust = {"velocity": velocity, "start": 20.0, "rise": 0.5, "hold": 2.0}
    changes = {"wind.model": "air", "wind.gusts": [gust], "estimator.wind_compensation": compensation}
    axis = "xyz"[[bool(v) for v in velocity].index(True)]
    results = flight_checks(tl.load_mission("iris", changes))
    (found,) = [r.value for r in results if r.check == "wind on the payload" and r.subject == axis]
    return found


@pytest.mark.parametrize(("axis", "left"), [(0, 1.0 - REMOVED), (2, 1.0)])
def test_the_compensation_takes_most_of_a_level_gust_and_nothing_of_a_vertical_one(axis, left):
    velocity = [6.0 * (i == axis) for i in range(3)]
    whole = on_payload(velocity, "none")
    assert whole > 0.1
    assert on_payload(velocity, "quadrotors") == pytest.approx(left * whole, rel=1e-9)
