"""The phases as a state machine: what is asked, allowed and demanded at which time, and what comes of it."""

import pytest

from tandemlift.core.phases import GUIDED, IDLE, LAND, PHASE_NAMES, STOPPED
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each
from tandemlift.parts.guidance.phases import (
    SETTLING_TIME,
    PhaseBounds,
    PhaseSettings,
    PhaseState,
    exceeds,
    lift_request,
    phase_output,
    reached,
    update_phase,
)
from tandemlift.parts.guidance.requests import (
    NO_REQUEST,
    OperatorRequest,
    RequestCounts,
    RequestSchedule,
    requests_until,
    with_operator,
)
from tandemlift.parts.mechanics.rigid_body import State

FREE = PhaseBounds(1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
LEVEL, DT, NEVER = Quat(1.0, 0.0, 0.0, 0.0), 0.05, 1e18
PHASING = PhaseSettings(1.0, 1.0, 0.5, NEVER, 0.5, 0.03, 0.3, 0.0, 10.0, 3.0, Absent())
BEFORE = PhaseState(IDLE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -SETTLING_TIME)


def flown(until, k=PHASING, bounds=lambda t: FREE, operator=lambda t: NO_REQUEST, land=lambda t: 0.0, height=0.0):
    """[(time, name of the phase)] whenever it changes; the last memory and orders."""
    m, story, t = BEFORE, [], 0.0
    state = State(Vec3(0.0, 0.0, height), ZERO, LEVEL, ZERO)
    for i in range(round(until / DT)):
        t = i * DT
        asked = with_operator(
            requests_until(k.requests, t), operator(t), reached(t, k.lift_start), reached(t, k.land_start)
        )
        lands = max(land(t), exceeds(asked.lands, m.handled_lands))
        lifts = lift_request(k, m, asked, operator(t).lift, lands)
        after = update_phase(k, m, state, asked, (lifts, lands), bounds(t), t, DT)
        if after.phase != m.phase:
            story.append((round(t, 2), PHASE_NAMES[int(after.phase)]))
        m = after
    return story, m, phase_output(k, m, t)


def names(story):
    return [name for _, name in story]


def test_at_a_wall_it_listens_on_in_a_phase_of_its_own_until_it_may_land():
    def touched(t):
        return FREE._replace(contact=float(5.0 <= t < 7.0 or t >= 9.0), land=float(t >= 10.0))

    story, _, _ = flown(9.5, bounds=touched)
    assert story[2:] == [(5.0, "contact"), (7.0, "guided"), (9.0, "contact")]
    assert flown(6.0, bounds=touched)[2].responding == 1.0
    assert flown(6.0, bounds=lambda t: touched(t)._replace(hold=float(t > 5.5)))[0][-1] == (5.55, "hold")
    assert names(flown(15.0, bounds=touched)[0])[-2:] == ["land", "idle"]


def test_by_the_clock_it_lifts_listens_lands_and_stays_down():
    story, _, orders = flown(20.0, PHASING._replace(land_start=8.0))
    assert story == [(1.0, "lift"), (3.3, "guided"), (8.0, "land"), (10.0, "idle")]
    assert (orders.running, orders.responding, orders.compensating, orders.grounded) == (0.0, 0.0, 0.0, 1.0)


def test_a_lift_is_asked_for_on_the_ground_unless_a_landing_is_or_rotors_that_always_run_have_landed_once():
    asked = RequestCounts(lifts=1.0, lands=0.0, enabled=1.0, stop=0.0)
    landed = BEFORE._replace(land_rate=0.25)  # of a landing in 4 s

    def wanted(m, *, land=0.0, always=0.0, requests=asked):
        return lift_request(PHASING._replace(always_running=always), m, requests, 0.0, land)

    assert wanted(BEFORE) == wanted(landed) == wanted(BEFORE, always=1.0) == 1.0
    assert wanted(BEFORE, land=1.0) == wanted(landed, always=1.0) == 0.0
    assert wanted(BEFORE._replace(phase=GUIDED)) == wanted(BEFORE, requests=asked._replace(lifts=0.0)) == 0.0


def refused_until(until):
    return lambda t: FREE._replace(lift_allowed=0.0 if t < until else 1.0)


def test_a_check_that_refuses_a_lift_delays_that_of_the_schedule_and_one_that_was_asked_for_lapses():
    assert flown(5.0, bounds=refused_until(2.5))[0][0] == (2.5, "lift")
    asked = PHASING._replace(lift_start=NEVER, requests=requests((2.0, "lift"), (4.0, "lift")))
    assert flown(5.0, asked, bounds=refused_until(2.1))[0][0] == (2.1, "lift")
    assert flown(5.0, asked, bounds=refused_until(2.5))[0][0] == (4.0, "lift")  # asked again
    assert flown(5.0, asked._replace(lift_start=2.0), bounds=refused_until(2.5))[0][0] == (2.5, "lift")


def test_a_landing_that_is_asked_for_on_the_ground_takes_back_a_lift_that_was_refused():
    assert flown(6.0, PHASING._replace(requests=requests((2.0, "land"))), bounds=refused_until(3.0))[0] == []
    assert flown(6.0, bounds=refused_until(3.0), land=lambda t: float(2.0 <= t < 2.2))[0] == []


def requests(*asked):
    cls = each(len(asked))
    return RequestSchedule(
        cls(*[t for t, _ in asked]),
        *[cls(*[float(a == what) for _, a in asked]) for what in ("lift", "land", "stop")],
        cls(*[{"enable": 1.0, "disable": -1.0}.get(a, 0.0) for _, a in asked]),
        1.0,
    )


def test_after_a_landing_it_lifts_again_only_if_asked_again():
    k = PHASING._replace(requests=requests((5.0, "land"), (9.0, "lift")))
    story, _, _ = flown(15.0, k)
    assert names(story) == ["lift", "guided", "land", "idle", "lift", "guided"]
    assert story[4][0] == 9.0


def test_what_was_asked_in_the_air_is_forgotten_on_the_ground():
    k = PHASING._replace(requests=requests((4.0, "lift"), (5.0, "land")))
    assert names(flown(15.0, k)[0]) == ["lift", "guided", "land", "idle"]


def test_disabled_it_holds_and_does_not_listen_and_enabled_it_does():
    k = PHASING._replace(requests=requests((5.0, "disable"), (6.0, "enable")))
    assert flown(8.0, k)[0][2:] == [(5.0, "hold"), (6.0, "guided")]
    assert flown(5.5, k)[2].responding == 0.0
    assert flown(5.5, k)[2].compensating == 1.0


def test_an_operator_beside_the_clock_enables_and_stops_and_lifts_without_it():
    story, _, orders = flown(8.0, operator=lambda t: OperatorRequest(0.0, float(5.0 <= t < 5.1), float(t < 4.0)))
    assert story[2:] == [(4.0, "hold"), (5.0, "stopped")]
    assert (orders.running, orders.flying, orders.grounded) == (0.0, 0.0, 1.0)
    alone = PHASING._replace(lift_start=NEVER)
    assert flown(3.0, alone, operator=lambda t: OperatorRequest(float(t > 2.0), 0.0, 1.0))[0] == [(2.05, "lift")]


@pytest.mark.parametrize("phase", ["idle", "lift", "hold", "guided", "land"])
def test_a_stop_ends_every_phase_for_good(phase):
    at = {"idle": 0.5, "lift": 2.0, "hold": 5.0, "guided": 5.0, "land": 9.0}[phase]
    k = PHASING._replace(land_start=8.0, requests=requests((at, "stop"), (12.0, "lift")))
    story, m, _ = flown(20.0, k, bounds=lambda t: FREE._replace(guidance_allowed=float(phase != "hold")))
    assert story[-1] == (at, "stopped")
    assert m.phase == STOPPED


@pytest.mark.parametrize(
    ("bounds", "expected"), [({"hold": 1.0}, "hold"), ({"land": 1.0}, "land"), ({"stop": 1.0}, "stopped")]
)
def test_a_reaction_leads_to_its_phase(bounds, expected):
    story, _, _ = flown(5.0, bounds=lambda t: FREE._replace(**bounds) if t >= 4.0 else FREE)
    assert story[2] == (4.0, expected)


def test_a_hold_during_the_lift_lands_from_where_it_is():
    story, m, _ = flown(2.2, bounds=lambda t: FREE._replace(hold=1.0) if t >= 2.0 else FREE, height=0.3)
    assert story[-1] == (2.0, "land")
    s = (2.0 - 1.0 - 0.3) * 0.5
    assert m.lift_fraction == pytest.approx(10 * s**3 - 15 * s**4 + 6 * s**5, abs=1e-12)
    before, after = (flown(t, bounds=lambda t: FREE._replace(hold=float(t >= 2.0)))[2] for t in (2.0, 2.05))
    assert after.lift.value == pytest.approx(before.lift.value, abs=0.06)


def test_a_landing_ends_when_it_stands_on_something():
    story, _, _ = flown(
        6.0, PHASING._replace(land_start=4.0), bounds=lambda t: FREE._replace(touched_down=float(t > 4.5))
    )
    assert story[-1] == (4.55, "idle")


def test_a_landing_is_no_faster_than_allowed_and_as_deep_as_told():
    k = PHASING._replace(land_start=4.0, max_descent_speed=0.3)
    _, m, orders = flown(4.2, k, bounds=lambda t: FREE._replace(extra_depth=0.5), height=1.0)
    assert m.land_rate == pytest.approx(0.3 / (1.875 * 0.53))
    assert orders.end == pytest.approx(1.0 - 0.03 - 0.5)  # the ground is where the lift began


def test_the_rate_of_a_landing_is_that_of_its_beginning():
    """Halfway down, a limit on the descent would allow more."""
    k = PHASING._replace(max_descent_speed=0.3)
    m = BEFORE._replace(phase=LAND, land_rate=0.123)
    low = State(Vec3(0.0, 0.0, 0.2), ZERO, LEVEL, ZERO)
    after = update_phase(k, m, low, RequestCounts(0.0, 0.0, 0.0, 1.0), (0.0, 1.0), FREE, 5.0, DT)
    assert (after.phase, after.land_rate) == (LAND, 0.123)


def test_hovering_counts_from_steady_flight():
    _, m, _ = flown(3.3 + 2.0)
    assert m.hover_time == pytest.approx(2.0 - SETTLING_TIME, abs=2 * DT)
    assert flown(3.2)[1].hover_time == -SETTLING_TIME


@pytest.mark.parametrize(("tare", "left"), [(3.0, -SETTLING_TIME), (0.2, 0.5)])
def test_a_landing_ends_a_tare_in_hover_unless_it_is_over(tare, left):
    k = PHASING._replace(requests=requests((3.3 + SETTLING_TIME + 0.5, "land")), tare_duration=tare)
    assert flown(9.0, k)[1].hover_time == pytest.approx(left, abs=2 * DT)


def test_a_vehicle_that_cannot_follow_is_limited_until_it_can():
    story, _, _ = flown(12.0, bounds=lambda t: FREE._replace(limited=float(5.0 < t < 8.0)))
    assert story == [(1.0, "lift"), (3.3, "guided"), (5.05, "limited"), (8.0, "guided")]


def test_a_limit_during_the_lift_counts_once_it_is_over_and_a_landing_ends_it():
    story, _, orders = flown(9.0, PHASING._replace(land_start=8.0), bounds=lambda t: FREE._replace(limited=2.0))
    assert story == [(1.0, "lift"), (3.3, "limited"), (8.0, "land")]
    _, _, orders = flown(7.0, bounds=lambda t: FREE._replace(limited=2.0))
    assert (orders.running, orders.responding, orders.compensating, orders.grounded) == (1.0, 0.0, 1.0, 0.0)


def test_being_limited_is_not_the_beginning_of_another_hover():
    _, m, _ = flown(9.0, bounds=lambda t: FREE._replace(limited=float(6.0 < t < 7.0)))
    assert m.hover_time == pytest.approx(9.0 - 3.3 - SETTLING_TIME, abs=2 * DT)


@pytest.mark.parametrize(("rate", "height", "ends"), [(3.0, 0.02, True), (-3.0, 0.02, True), (3.0, 0.1, False)])
def test_a_landing_ends_just_above_the_ground_where_the_vehicle_still_turns(rate, height, ends):
    m = BEFORE._replace(phase=LAND, land_rate=0.1)
    state = State(Vec3(0.0, 0.0, height), ZERO, LEVEL, Vec3(0.0, 0.0, rate))
    after = update_phase(PHASING, m, state, requests_until(Absent(), 1.0), (0.0, 0.0), FREE, 1.0, DT)
    assert (after.phase == IDLE) == ends


def test_the_ramp_of_a_landing_goes_from_0_to_1_in_its_time_and_stays_there():
    k, m = PHASING, BEFORE._replace(phase=LAND, since=2.0, land_rate=0.5)
    ramp = [phase_output(k, m, t).land for t in (2.0, 3.0, 4.0)]
    assert [step.value for step in ramp] == pytest.approx([0.0, 0.5, 1.0])
    assert ramp[1].rate > 0.5  # twice the mean, or nearly
    quarters = [phase_output(k, m, t).land.value for t in (2.5, 3.5)]
    assert quarters[0] + quarters[1] == pytest.approx(1.0)
    landed = phase_output(k._replace(always_running=1.0), m._replace(phase=IDLE), 9.0).land
    assert (landed.value, landed.rate, landed.curvature) == (1.0, 0.0, 0.0)
