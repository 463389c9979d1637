"""What the caller of a step adds: pushes and thrusts, in plain Python and in machine code."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.types import flat
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each, mat3, vec3
from tandemlift.parts.guidance.requests import ReferenceVelocity
from tandemlift.parts.mechanics.push import CentralPush, PointPush, PushSamples, push_moment
from tandemlift.simulation.loop.caller_inputs import CallerInput, commanded_thrusts, with_caller_push
from tandemlift.simulation.loop.step import step_flight
from tandemlift.simulation.plan import FlightPlan

FORCE, POINT = Vec3(1.0, -2.0, 0.5), Vec3(0.1, 0.8, -0.06)
TILTED = Quat(0.8, 0.36, -0.48, 0.0)
ROTORS = each(8)
CENTRAL = CentralPush(Vec3(0.5, 0.0, 1.0))
AT_POINTS = PointPush(Vec3(0.5, 0.0, 1.0), mat3(np.outer([0.5, 0.0, 1.0], [0.2, -0.7, 0.0])))
DT = 0.001
NOT_LED = ReferenceVelocity(ZERO, 0.0)


def external(force=ZERO, point=ZERO, thrusts=None):
    given = 0.0 if thrusts is None else 1.0
    return CallerInput(force, point, ROTORS(*(thrusts or [0.0] * 8)), given, NOT_LED)


@pytest.mark.parametrize("own", [CENTRAL, AT_POINTS])
def test_an_added_push_adds_its_force_and_its_moment_at_start_middle_and_end(own):
    hand = with_caller_push(external(FORCE, POINT), PushSamples(own, own, own))
    alone = push_moment(PointPush(FORCE, mat3(np.outer(FORCE, POINT))), TILTED)
    for push in hand:
        assert push.force == own.force + FORCE
        assert tuple(push_moment(push, TILTED) - push_moment(own, TILTED)) == pytest.approx(tuple(alone), abs=1e-14)


@pytest.mark.parametrize("attitude", [TILTED, Quat(-0.5, 0.5, -0.5, 0.5)])
def test_without_a_force_the_moment_of_a_central_push_is_zero_and_never_minus_zero(attitude):
    hand = with_caller_push(external(point=Vec3(-0.3, 0.8, -0.1)), PushSamples(CENTRAL, CENTRAL, CENTRAL))
    moment = push_moment(hand.start, attitude)
    assert moment == ZERO
    assert not any(np.signbit(v) for v in moment)


def test_thrusts_are_the_pilots_unless_they_are_overridden():
    own, given = ROTORS(*range(8)), [7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.0]
    assert commanded_thrusts(external(), own) == own
    assert commanded_thrusts(external(thrusts=given), own) == tuple(given)
    assert commanded_thrusts(Absent(), own) is own
    assert with_caller_push(Absent(), CENTRAL) is CENTRAL


def test_plain_python_takes_the_same_step_as_machine_code():
    mission = tl.load_mission("one-push", {"pushes.0.point": [0.0, -0.5, 0.1], "pushes.0.time": 40.0})
    p, sim = FlightPlan(mission, interactive=True), tl.Simulation(mission)
    thrusts = [4.0, 5.0, 4.5, 4.2, 4.8, 4.1, 4.4, 4.6]
    added = CallerInput(vec3([0.6, -0.3, 0.4]), vec3([0.0, 0.7, 0.05]), ROTORS(*thrusts), 1.0, NOT_LED)
    flight_state, _ = step_flight(p.model, p.given._replace(external=added), 0.0, DT)
    state = sim.step(added.force, thrusts, point=added.point)
    np.testing.assert_allclose(state, flat(flight_state.state), rtol=1e-13, atol=1e-15)


def test_a_velocity_moves_the_reference_of_scheduled_guidance_at_it_and_then_the_admittance_brakes():
    sim = tl.Simulation(tl.load_mission("paper", {"pushes": []}))
    velocity, before = np.array([0.2, -0.1, 0.05]), None
    for k in range(400):
        sim.step(velocity=velocity)
        before = sim["admittance_position"] if k == 0 else before
        np.testing.assert_array_equal(sim["admittance_velocity"], velocity)
    np.testing.assert_allclose(sim["admittance_position"] - before, velocity * 399 * sim.dt, rtol=1e-12)
    a = sim.mission.admittance
    sim.step(steps=300)
    decay = np.exp(-np.array(a.damping) / np.array(a.mass) * 299 * sim.dt)
    np.testing.assert_allclose(sim["admittance_velocity"], velocity * decay, rtol=1e-3)


def test_a_velocity_leads_interactive_guidance_within_its_limits_once_it_follows():
    sim = tl.Simulation(tl.load_mission("iris", {"pushes": [], "person.model": "none"}))
    asked, limits = np.array([5.0, 0.0, 0.0]), sim.mission.compliance
    sim.step(velocity=asked, steps=1000)
    np.testing.assert_array_equal(sim["admittance_velocity"], 0.0)  # on the ground
    while sim.time < 30.0:
        sim.step(velocity=asked, steps=10)
        assert abs(sim["admittance_acceleration"]).max() <= limits.max_acceleration[0] * (1.0 + 1e-9)
    assert sim["admittance_velocity"][0] == pytest.approx(limits.max_speed[0], rel=1e-3)
