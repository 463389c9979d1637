"""Checks of a mission when it is loaded, at the limits that their texts name."""

from types import SimpleNamespace

import pytest

import tandemlift as tl
from tandemlift.core.faults import FAULTS
from tandemlift.missions import tables_of
from tandemlift.missions.flight_checks import flight_checks
from tandemlift.parts.contact.standing import DISTANCE_BELOW, reference_warnings
from tandemlift.parts.flight_checks.hover_loads import WindOnParts
from tandemlift.parts.flight_checks.schedule_checks import Schedule
from tandemlift.parts.flight_checks.sensing_checks import COMPENSATED_SHARE, wind_after_tare
from tandemlift.parts.mechanics.vehicle import Vehicle


@pytest.mark.parametrize(
    ("above", "warns"), [(-0.5 * DISTANCE_BELOW, False), (0.5 * DISTANCE_BELOW, False), (2.0 * DISTANCE_BELOW, True)]
)
def test_a_landing_that_ends_far_above_where_the_vehicle_stands_is_warned_of(above, warns):
    phases = tl.load_mission("iris", {"phases.land_start": 40.0}).phases
    assert phases.rotors == "flight"
    found = list(reference_warnings(phases, 60.0, SimpleNamespace(rests=-above)))
    assert [f"{above:.3g} m above" in r.text for r in found] == [True] * warns


def test_a_stiff_axis_may_be_damped_by_as_little_as_the_bound_that_is_told():
    """K h/2 = 0.05 N s/m: a damping just above it loads, just below it does not."""
    stiff = {"mission.step": 0.001, "admittance.stiffness": [100.0, 0.0, 0.0]}
    tl.load_mission("paper", stiff | {"admittance.damping": [0.051, 4.0, 4.0]})
    with pytest.raises(tl.InputError, match=r"from stiffness\*step/2 = 0\.05 to"):
        tl.load_mission("paper", stiff | {"admittance.damping": [0.049, 4.0, 4.0]})


def test_quadrotors_without_drag_are_refused_only_where_they_are_to_measure_the_wind():
    fleet = [q | {"drag_coefficient": 0.0} for q in tables_of(tl.load_mission("iris"))["vehicle"]["quadrotors"]]
    without = {"vehicle.quadrotors": fleet, "estimator.wind_compensation": "none"}
    assert tl.load_mission("iris", without).estimator.wind_compensation == "none"
    with pytest.raises(tl.InputError, match="there the wind is not measured"):
        tl.load_mission("iris", without | {"estimator.wind_compensation": "quadrotors"})


@pytest.mark.parametrize(("height", "ready"), [(1.0, 6.0), (0.0, 3.0)])
def test_pushes_count_after_lift_and_tare_and_a_flight_that_does_not_lift_waits_for_no_lift(height, ready):
    times = {"phases.lift_start": 1.0, "phases.lift_duration": 2.0, "phases.height": height}
    mission = tl.load_mission("iris", times | {"estimator.tare": "hover", "estimator.tare_duration": 3.0})
    wind = WindOnParts(mission.wind, Vehicle.from_settings(mission.vehicle), 0.0, mission.mission.step)
    schedule = Schedule(mission.phases, mission.pushes, mission.admittance, mission.compliance, 60.0)
    assert wind_after_tare(schedule, mission.estimator, wind)[0][0] == pytest.approx(ready)


def test_every_fault_has_its_own_reaction_by_default():
    reactions = tl.load_mission("iris").supervision.reactions
    assert {fault.key: getattr(reactions, fault.key) for fault in FAULTS} == {f.key: f.reaction for f in FAULTS}
    assert [r for r in flight_checks(tl.load_mission("iris")) if r.verdict == "fails"] == []


def on_payload(velocity, compensation):
    """The wind that the check finds on the payload along the axis of a gust [N]."""
    gust = {"velocity": velocity, "start": 20.0, "rise": 0.5, "hold": 2.0}
    changes = {"wind.model": "air", "wind.gusts": [gust], "estimator.wind_compensation": compensation}
    axis = "xyz"[[bool(v) for v in velocity].index(True)]
    results = flight_checks(tl.load_mission("iris", changes))
    (found,) = [r.value for r in results if r.check == "wind on the payload" and r.subject == axis]
    return found


@pytest.mark.parametrize(("axis", "left"), [(0, 1.0 - COMPENSATED_SHARE), (2, 1.0)])
def test_the_compensation_takes_most_of_a_level_gust_and_nothing_of_a_vertical_one(axis, left):
    velocity = [6.0 * (i == axis) for i in range(3)]
    whole = on_payload(velocity, "none")
    assert whole > 0.1
    assert on_payload(velocity, "quadrotors") == pytest.approx(left * whole, rel=1e-9)
