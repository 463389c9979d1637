"""Limits of a mission's detectors, and where its guidance begins, against what the keys say."""

import pytest

import tandemlift as tl
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation.limits import finding_limits_from


def limits(**changes):
    mission = tl.load_mission("iris", {key.replace("__", "."): value for key, value in changes.items()})
    return finding_limits_from(mission, Vehicle.from_settings(mission.vehicle))


def test_an_axis_owes_the_speed_of_its_damping_and_none_with_a_spring_or_without_damping():
    push = limits(admittance__damping=[2.0, 4.0, 5.0], admittance__stiffness=[0.0, 1.0, 0.0]).push
    assert push.inverse_damping == pytest.approx((0.5, 0.0, 0.2))
    assert limits(admittance__damping=[0.0, 4.0, 5.0]).push.inverse_damping == pytest.approx((0.0, 0.25, 0.2))


@pytest.mark.parametrize(("rotors", "yaw"), [("flight", 0.5), ("always", 0.0)])
def test_interactive_guidance_holds_the_heading_at_the_start_unless_it_flies_at_once_to_its_reference(rotors, yaw):
    mission = tl.load_mission("iris", {"initial.euler": [0.0, 0.0, 0.5], "phases.rotors": rotors})
    assert FlightPlan(mission).model.flight_state.memory.guidance.heading.angle == yaw


def test_a_push_has_the_slowest_axis_to_be_answered_in():
    push = limits(admittance__mass=[2.0, 3.0, 4.0], admittance__damping=[4.0, 2.0, 5.0]).push
    assert push.time == pytest.approx(tl.load_mission("iris").findings.push_time + 1.5)
