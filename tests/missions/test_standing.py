"""How a vehicle stands on the floor, and what hover and the log need, as the checks of a mission compute it."""

import math
import warnings
from itertools import product

import pytest
from for_all import for_all
from hypothesis import given
from hypothesis import strategies as st

from tandemlift.core.types import leaves
from tandemlift.missions import load_mission
from tandemlift.parts.contact.feet import sinkage_of, standing_height
from tandemlift.parts.contact.standing import standing_on
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation.assemble import assemble

WEAK = [{"quadrotor": 1, "rotor": r, "time": 1.0, "efficiency": 0.1, "known_after": 0.0} for r in (1, 2, 3)]
UNLIMITED = {"allocation.method": "pseudo-inverse", "observer.model": "none", "detection.model": "none"}


@pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"mission.step": 0.005},
        {"plant.mass_scale": 1.2, "plant.inertia_scale": [2.0, 1.0, 1.0]},
        {"ground.height": -0.2, "ground.sinkage": 0.002},
    ],
    ids=str,
)
def test_the_floor_that_is_checked_is_the_one_that_is_flown(changes):
    mission = load_mission("iris", changes)
    standing, flown = standing_of(mission), assemble(mission).model.plant.floor
    assert standing.floor == flown
    assert standing.sinkage == pytest.approx(sinkage_of(flown, mission.hover.weight))
    assert standing.rests == pytest.approx(flown.height + standing_height(flown, mission.hover.weight))


def standing_of(m):
    """How the vehicle of a mission stands on the floor."""
    return standing_on(m.ground, m.vehicle, m.plant.mass_scale, m.mission.step, m.initial)


def test_a_level_vehicle_starts_as_deep_in_its_own_floor_as_it_sinks():
    for changes in ({}, {"mission.step": 0.002}, {"plant.mass_scale": 1.2}):
        standing = standing_of(load_mission("iris", changes))
        assert standing.depth == pytest.approx(0.0, abs=1e-12)
        assert standing.rests == pytest.approx(0.03)


@given(st.floats(-0.016, 0.016), st.sampled_from(["roll", "pitch"]))
def test_a_tilted_start_is_as_deep_as_its_lowest_foot(angle, about):
    """A foot is 0.12 m along x, and 1.12 m along y, from the centre of mass, and 0.169 m below it."""
    euler = [angle, 0.0, 0.7] if about == "roll" else [0.0, angle, 0.7]
    arm, below = 1.12 if about == "roll" else 0.12, 0.18 - 0.075 * 0.5 / 3.5
    depth = arm * math.sin(abs(angle)) - below * (1.0 - math.cos(angle))
    assert told_of("iris", {"initial.euler": euler}).depth == pytest.approx(depth, abs=1e-12)


def told_of(name, changes):
    """How the vehicle stands, whatever is warned of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return standing_of(load_mission(name, changes))


def test_lift_and_weight_are_those_of_the_parts():
    mission = load_mission("iris", {"faults": WEAK, "plant.mass_scale": 1.1})
    most = 5.84e-6 * 1100.0**2
    assert mission.hover.weight == pytest.approx(3.5 * 1.1 * 9.81)
    assert mission.hover.lift == pytest.approx(8 * most)
    assert mission.hover.faulty_lift == pytest.approx((5 + 0.3) * most)


WITHOUT = {"detection.model": "none", "supervision.model": "none"}


@pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
@for_all(list(product(["paper", "iris", "zigzag"], [{}, {"wind.model": "air"}, UNLIMITED, WITHOUT])))
def test_the_size_of_a_logged_sample_is_that_of_the_log(case):
    mission = load_mission(*case)
    assert mission.sample_size == 8 * (leaves(FlightPlan(mission).sample) + 1)  # and its time
