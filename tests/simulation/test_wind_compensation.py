"""Flights with `estimator.wind_compensation` in calm air: a floor and a wall are no wind."""

import numpy as np
import pytest

import tandemlift as tl

ON = {"estimator.wind_compensation": "quadrotors"}
LANDING = {"pushes": [], "phases.land_start": 15.0, "mission.duration": 30.0}
WALL = {"start": [1.2, 0.6], "end": [1.2, 4.0]}
HIT = {"pushes": [{"force": [2.0, 0.0, 0.0], "time": 18.0, "sigma": 2.0}], "walls": [WALL], "mission.duration": 30.0}


def flown(changes):
    """Beyond the tare: the flight with compensation, the error of its push, and the largest load of floor or walls."""
    flight = tl.fly(tl.load_mission("iris", {"phases.land_start": 1000.0, **changes}))
    tared = flight.time > 12.0
    error = (flight["push_estimate"] - flight["push_force"])[tared]
    return error, np.abs(flight["contact_force"][tared]).max(axis=0)


@pytest.fixture(scope="module")
def landed():
    return flown(LANDING | ON)


@pytest.mark.thorough
def test_friction_at_touchdown_is_no_push(landed):
    """It was one of 41 N, to which the pilot gave way: the feet bounced with 112 N."""
    error, contact = landed
    assert np.abs(error).max() < 0.35  # N
    assert np.abs(contact[:2]).max() < 5.0  # N


def test_in_calm_air_the_sensors_errors_come_through_times_the_ratio_of_drags(landed):
    error, _ = landed
    assert np.sqrt(np.mean(error**2, axis=0)) == pytest.approx([0.06, 0.01, 0.02], abs=0.03)


@pytest.mark.thorough
@pytest.mark.parametrize("contact", ["none", "on"])
def test_a_wall_at_a_guard_is_at_most_the_wind_that_it_may_be(contact):
    error, struck = flown(HIT | ON | {"contact.model": contact})
    assert struck[0] > 50.0  # N, on the guard of one quadrotor
    assert np.abs(error).max() < 9.0  # N: 54 N without the bound
