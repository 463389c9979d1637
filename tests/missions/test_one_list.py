"""Loading and `check` read one list of checks."""

import warnings

import pytest

import tandemlift as tl
from tandemlift.core.errors import FAILS, REFUSED
from tandemlift.missions import load_mission
from tandemlift.missions.checks import mission_checks


def test_a_refused_mission_has_the_refusal_that_loading_says_and_nothing_after_it():
    iris = load_mission("iris")
    broken = iris.model_copy(update={"allocation": iris.allocation.model_copy(update={"method": "pseudo-inverse"})})
    (result,) = mission_checks(broken)
    assert result.verdict == REFUSED
    assert tl.check(broken) == (result,)
    with pytest.raises(tl.InputError) as refusal:
        load_mission("iris", {"allocation.method": "pseudo-inverse"})
    assert str(refusal.value) == f"iris: {result.text}"


def test_loading_warns_of_what_fails():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        mission = load_mission("iris", {"plant.mass_scale": 0.5, "sensors.joints.force_range": 2.0})
    failed = [result.text for result in mission_checks(mission) if result.verdict == FAILS]
    assert len(told) >= 3
    assert {str(one.message).removeprefix("iris: ") for one in told} <= set(failed)


@pytest.mark.parametrize("name", ["paper", "one-push", "hover"])
def test_guidance_by_hand_has_a_soft_gate(name):
    by_hand = {"pilot.guidance": "interactive"}
    for gate in ({}, {"admittance.gate": "soft"}):
        assert load_mission(name, by_hand | gate).admittance.gate in (None, "soft")
    with pytest.raises(tl.InputError, match=r'admittance\.gate = "hard": must be "soft" or left out'):
        load_mission(name, by_hand | {"admittance.gate": "hard"})
    assert load_mission(name, {"admittance.gate": "hard"}).admittance.gate == "hard"
