"""A pilot says why it refuses to lift or to land, and why it does not follow a push, with numbers and what to do."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.faults import FAULTS
from tandemlift.core.refusals import REASONS, REQUESTS, refusal_of
from tandemlift.parts.mechanics.vehicle import Vehicle

BY_HAND = {"pilot.guidance": "interactive", "phases.rotors": "flight", "ground.model": "floor"}
SUPERVISED = BY_HAND | {"supervision.model": "on", "phases.lift_start": 1e6, "phases.land_start": 2e6}
STAYS = {"compliance.following.max_error": 100.0}  # the vehicle of these tests never moves
LEVEL = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, *[0.0] * 9])


def pilot(**changes):
    settings = {"phases.lift_duration": 0.5, "supervision.limits.tracking_error": 100.0, **STAYS, **changes}
    return tl.Pilot(tl.load_mission("hover", SUPERVISED | settings))


def sampled(one, seconds, state=LEVEL, **requests):
    """The refusals after some time at a state, during which something is asked."""
    for _ in range(round(seconds / 0.001)):
        one.step(state, **requests)
    return one.refusals


def moving(**parts):
    """The level state at rest, with other numbers from some places on."""
    state = LEVEL.copy()
    for place, numbers in parts.items():
        at = int(place.removeprefix("at"))
        state[at : at + len(numbers)] = numbers
    return state


def test_every_reason_and_every_advice_is_a_sentence_without_a_place_that_is_left_empty():
    for reason in REASONS:
        for request in REQUESTS:
            refusal = refusal_of(request, reason.number, float(FAULTS[0].alarm), 2.5)
            assert refusal.why.endswith(".")
            assert refusal.advice.endswith(".") or reason.key == "landed"
            assert "{" not in str(refusal)
            assert "  " not in str(refusal)
    assert refusal_of("lift", 0, 0.0, 0.0) is None


def test_a_pilot_that_is_guided_by_the_clock_takes_no_requests():
    one = tl.Pilot(tl.load_mission("hover"))
    one.step(LEVEL)
    assert "scheduled" in one.refusals.lift.why
    assert 'pilot.guidance = "interactive"' in one.refusals.land.advice
    assert one.refusals.push is None


def test_from_the_ground_to_the_air_and_back_each_phase_refuses_what_it_cannot_do():
    one = pilot()
    lift, land, push = sampled(one, 0.01)
    assert lift is None
    assert str(land) == "Landing is refused: the vehicle stands on the ground already."
    assert str(push) == "The push is not followed: the vehicle stands on the ground. Lift it off first."
    lift, land, push = sampled(one, 0.01, lift=True)
    assert "in the air already" in lift.why
    assert land is None
    assert "still lifting off" in push.why
    assert sampled(one, 3.0)[1:] == (None, None)
    lift, land, push = sampled(one, 0.01, enabled=False)
    assert str(push) == "The push is not followed: the pilot is told not to follow pushes. Let it follow again."
    lift, land, push = sampled(one, 0.01, land=True)
    assert all("landing, which cannot be cancelled" in refusal.why for refusal in (lift, push))
    assert land is None
    lift, land, push = sampled(one, 0.01, stop=True)
    assert all("stopped, which is final" in refusal.why for refusal in (lift, land, push))


def test_a_weak_push_is_told_with_the_axis_that_is_nearest_to_its_threshold():
    one = pilot(**{"admittance.threshold": [0.5, 0.4, 1.0]})
    sampled(one, 3.0, lift=True)
    push = sampled(one, 1.0, moving(at13=[0.2, -0.3, 0.1])).push
    assert push.why == "The push is not followed: it is below the threshold (0.3 N, limit 0.4 N)."
    assert sampled(one, 1.0, moving(at13=[0.2, -0.8, 0.1])).push is None


@pytest.mark.parametrize(
    ("state", "why"),
    [(moving(at0=[0.5]), "too far from the reference"), (moving(at6=[np.cos(0.5), 0.0, 0.0, np.sin(0.5)]), "heading")],
)
def test_a_vehicle_that_cannot_follow_says_what_keeps_it_from_that(state, why):
    one = pilot(**{"compliance.following.max_error": 0.2, "compliance.yaw.model": "compliant"})
    sampled(one, 3.0, lift=True)
    push = sampled(one, 2.0, state).push
    assert push.advice == "Push less, and wait until it can follow again."
    assert why in push.why


@pytest.mark.parametrize(
    ("state", "why"),
    [
        (moving(at6=[np.cos(0.2), np.sin(0.2), 0.0, 0.0]), "not level (22.9°, limit 8.6°)"),
        (moving(at3=[0.3, 0.4, 0.0]), "not at rest (0.5 m/s, limit 0.1 m/s)"),
        (moving(at10=[0.0, 0.0, 0.25]), "not at rest (0.25 rad/s, limit 0.2 rad/s)"),
    ],
)
def test_a_lift_is_refused_with_the_quantity_and_its_limit(state, why):
    one = pilot()
    refusals = sampled(one, 0.01, state, lift=True)
    assert why in refusals.lift.why
    assert refusals.lift.advice
    assert sampled(one, 0.01).lift is None


def test_a_hover_that_needs_too_much_thrust_is_told_in_percent():
    lift = sampled(pilot(**{"supervision.checks.thrust_fraction": 0.3}), 0.01).lift
    vehicle = Vehicle.from_settings(tl.load_mission("hover").vehicle)
    share = float(lift.why.partition("hover needs ")[2].split()[0])
    assert share == pytest.approx(100.0 * vehicle.weight / vehicle.max_thrust, abs=0.06)
    assert "limit 30 %" in lift.why


def test_rotors_that_always_run_lift_only_once():
    one = pilot(**{"phases.rotors": "always"})
    sampled(one, 3.0, lift=True)
    sampled(one, 0.01, land=True)
    assert "lift only once" in sampled(one, 20.0).lift.why


def test_a_state_that_is_not_a_number_is_named_as_the_fault_of_a_sensor():
    one = pilot()
    lift = sampled(one, 0.2, moving(at0=[np.nan])).lift
    assert lift.why == "Lift is refused: a sensor has failed: state not a number."
    lift = sampled(one, 0.5).lift
    assert "the last fault is over for 0.5 s only, of 1 s" in lift.why
    assert sampled(one, 1.0).lift is None


@pytest.mark.thorough
def test_a_simulation_says_it_too():
    one = tl.Simulation(tl.load_mission("hover", SUPERVISED))
    one.step()
    assert one.refusals.lift is None
    assert "stands on the ground" in one.refusals.push.why
