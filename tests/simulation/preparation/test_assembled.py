"""What an assembled flight takes from its mission: the pilot's nominal vehicle, delays, and where its numbers stand."""

import re

import numpy as np
import pytest
from flights import different

import tandemlift as tl
from tandemlift.compiler.tracer import TraceError
from tandemlift.core.caching import LastUsed
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.missions.facts import Facts
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.simulation import plan
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import compiled_flight
from tandemlift.simulation.preparation.assemble import assemble
from tandemlift.simulation.preparation.limits import finding_limits_from
from tandemlift.simulation.preparation.loops import LoopWriter
from tandemlift.simulation.preparation.traced_step import check_layout


def test_the_estimators_know_the_payloads_place_and_the_drag_of_the_nominal_vehicle():
    drag = {"vehicle.drag.force": [0.1, 0.2, 0.3], "vehicle.drag.moment": [0.01, 0.02, 0.03]}
    mission = tl.load_mission("iris", drag)
    known = assemble(mission).model.estimator.vehicle
    payload = -Vehicle.from_settings(mission.vehicle).center_of_mass
    assert abs(payload).max() > 0.0
    assert np.array(known.payload) == pytest.approx(payload)
    assert known.drag_force == Vec3(0.1, 0.2, 0.3)
    assert known.drag_moment == Vec3(0.01, 0.02, 0.03)


def test_whose_law_changes_the_layout_is_named():
    """The controller's file and line where its memory changes; else what has changed."""
    model = FlightPlan(tl.load_mission("paper")).model
    state = model.flight_state
    moved = state._replace(state=state.state._replace(position=(ZERO, ZERO)))
    with pytest.raises(TraceError, match=r"^state\.position is "):
        check_layout(model.pilot.controller, state, moved)
    other = state._replace(memory=state.memory._replace(controller=(1.0, 2.0, 3.0)))
    with pytest.raises(TraceError, match=r"nftsmc\.py, line \d+: .* returns another layout"):
        check_layout(model.pilot.controller, state, other)
    check_layout(model.pilot.controller, state, state)


def limits(**changes):
    mission = tl.load_mission("iris", {key.replace("__", "."): value for key, value in changes.items()})
    return Facts(mission).call(finding_limits_from)


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


def test_a_step_in_pieces_has_the_bits_of_the_step_in_one(tmp_path, monkeypatch):
    mission, largest = tl.load_mission("iris", {"mission.duration": 4.0}), 500
    whole, writers = tl.fly(mission), []

    def in_pieces(traced, lanes, alike):
        writers.append(LoopWriter(traced, lanes, largest=largest, alike=alike))
        return writers[-1]

    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path))
    monkeypatch.setattr(plan, "LOOP_CODE", LastUsed(8))
    monkeypatch.setattr(compiled_flight, "LoopWriter", in_pieces)
    assert different(tl.fly(mission), whole) == []
    pieces = re.findall(r"(?ms)^define [^\n]*@(?:acting|end)\d+_part.*?^}", writers[0].module.text)
    assert len(pieces) > 2
    assert all(piece.count(" = f") < 3 * largest for piece in pieces)  # of arithmetic
    assert sum(piece.count(" = f") for piece in pieces) > largest
