"""The reaction to faults over time, what it bounds, and the log of events, sample by sample."""

import pytest
from guided import hand_guidance

import tandemlift as tl
from tandemlift.core.faults import REACTIONS
from tandemlift.core.phases import GUIDED, HOLD, IDLE
from tandemlift.core.vector import ZERO
from tandemlift.parts.guidance.fault_detection import FaultReaction
from tandemlift.parts.guidance.preflight_checks import SensorStatus
from tandemlift.parts.guidance.supervision import (
    ALARM,
    CONTACT,
    PHASE,
    TOUCHDOWN_TIME,
    finish_supervision,
    supervision_output,
    update_reaction,
)
from tandemlift.parts.sensors.health import WELL

MISSION = tl.load_mission("iris", {"supervision.model": "on"})
GUIDANCE, MEMORY = hand_guidance(MISSION)
DT = 0.25  # s: times add up exactly
K = GUIDANCE.supervision._replace(recovery_time=1.0, hold_timeout=3.0)
START, STARTED_PHASE = MEMORY.supervision, MEMORY.phase
NONE, HOLDS, LANDS, STOPS = map(float, range(len(REACTIONS)))
SENSORS = SensorStatus(WELL, 0.0, 1.0, 1.0)


def reacting(faults, seconds, idle=0.0):
    """(reaction, alarm) after each sample with the strongest reaction that is called for, a function of time."""
    m, found = START, []
    for k in range(round(seconds / DT)):
        m = update_reaction(K, m, FaultReaction(*faults(k * DT)), idle, DT)
        found.append((m.reaction, m.alarm))
    return found


def test_a_hold_ends_once_there_was_no_fault_for_the_recovery_time():
    found = reacting(lambda t: (HOLDS, 7.0) if t < 1.0 else (NONE, 0.0), 3.0)
    assert found == [(HOLDS, 7.0)] * 7 + [(NONE, 0.0)] * 5  # the fourth sample without a fault ends it
    again = reacting(lambda t: (HOLDS, 7.0) if t % 1.0 < 0.25 else (NONE, 0.0), 3.0)
    assert again == [(HOLDS, 7.0)] * 12


def test_a_hold_that_lasts_becomes_a_landing_which_no_recovery_ends_in_the_air():
    found = reacting(lambda t: (HOLDS, 7.0) if t < 4.0 else (NONE, 0.0), 8.0)
    assert [reaction for reaction, _ in found] == [HOLDS] * 12 + [LANDS] * 20
    assert reacting(lambda t: (LANDS, 5.0) if t < 0.5 else (NONE, 0.0), 8.0)[-1] == (LANDS, 5.0)
    assert reacting(lambda t: (LANDS, 5.0) if t < 0.5 else (NONE, 0.0), 8.0, idle=1.0)[-1] == (NONE, 0.0)
    assert reacting(lambda t: (HOLDS, 7.0), 8.0, idle=1.0)[-1] == (HOLDS, 7.0)


def test_only_a_stronger_reaction_replaces_one_with_its_alarm():
    def faults(t):
        return (LANDS, 5.0) if t < 1.0 else (HOLDS, 7.0) if t < 2.0 else (STOPS, 9.0)

    found = reacting(faults, 3.0)
    assert found == [(LANDS, 5.0)] * 8 + [(STOPS, 9.0)] * 4


@pytest.mark.parametrize(
    ("reaction", "holds", "lands", "stops"), [(NONE, 0, 0, 0), (HOLDS, 1, 0, 0), (LANDS, 1, 1, 0), (STOPS, 1, 1, 1)]
)
def test_a_reaction_holds_lands_or_stops_in_flight(reaction, holds, lands, stops):
    for grounded in (0.0, 1.0):
        b = supervision_output(K, SENSORS, START._replace(reaction=reaction), 0.0, grounded).bounds
        assert (b.hold, b.land, b.stop) == (holds, lands * (1 - grounded), stops * (1 - grounded))


def test_bounds_say_what_fails_and_what_is_unknown():
    def output(m=START, lift=0.0, **report):
        return supervision_output(K, SENSORS._replace(report=WELL._replace(**report)), m, lift, 0.0)

    sound = output()
    b = sound.bounds
    assert (b.lift_allowed, b.guidance_allowed, b.touched_down, b.extra_depth, sound.motion_unknown) == (1, 1, 0, 0, 0)
    assert output(lift=2.0).bounds == b._replace(lift_allowed=0.0)
    assert output(START._replace(failed_guidance_check=8.0)).bounds == b._replace(guidance_allowed=0.0)
    standing = START._replace(timers=START.timers._replace(touchdown=TOUCHDOWN_TIME + 1e-9))
    assert output(standing).bounds == b._replace(touched_down=1.0)
    for lost in ("motion", "position", "velocity"):
        deeper = 0.0 if lost == "velocity" else K.blind_descent_depth
        assert output(**{lost: 1.0}).bounds.extra_depth == deeper
        assert output(**{lost: 1.0}).motion_unknown == 0.0
        for also in ("accelerometer", "imu"):
            assert output(**{lost: 1.0, also: 1.0}).motion_unknown == 1.0
    assert output(accelerometer=1.0, imu=1.0).motion_unknown == 0.0


def logged(*steps):
    """[(time, code)] of the log after steps of (phase, memory's changes, contact); each a second after the last."""
    m = START
    for t, (phase, changes, contact) in enumerate(steps):
        m = m._replace(**changes)
        shown, m = finish_supervision(K, m, STARTED_PHASE._replace(phase=phase), ZERO, contact, float(t))
    count = int(m.events.count)
    return list(zip(m.events.time, m.events.code, strict=True))[:count], shown


def test_an_event_is_logged_whenever_phase_alarm_contact_or_failed_check_changes_and_only_then():
    alarm = {"alarm": 7.0, "reaction": HOLDS}
    log, shown = logged(
        (GUIDED, {}, 0.0), (GUIDED, {}, 0.0), (GUIDED, {}, 3.0), (HOLD, alarm, 3.0), (HOLD, alarm, 3.0), (HOLD, {}, 0.0)
    )  # fmt: skip
    codes = [GUIDED * PHASE, GUIDED * PHASE + 3.0 * CONTACT, HOLD * PHASE + 7.0 * ALARM + 3.0 * CONTACT]
    assert log == [(0.0, codes[0]), (2.0, codes[1]), (3.0, codes[2]), (5.0, HOLD * PHASE + 7.0 * ALARM)]
    assert (shown.alarm, shown.failed_check) == (7.0, 0.0)


def test_a_check_that_fails_is_logged_with_the_phase_that_waits_for_it():
    log, shown = logged(
        (IDLE, {"failed_lift_check": 4.0}, 0.0),
        (IDLE, {"failed_lift_check": 0.0}, 0.0),
        (IDLE, {"failed_lift_check": 5.0}, 0.0),
    )
    assert [code for _, code in log] == [IDLE * PHASE + 4.0, IDLE * PHASE + 5.0]
    assert shown.failed_check == 5.0
    waits = {"failed_guidance_check": 8.0, "reaction": 0.0}
    log, shown = logged((HOLD, waits, 0.0))
    assert (log, shown.failed_check) == ([(0.0, HOLD * PHASE + 8.0)], 8.0)
    log, shown = logged((HOLD, waits | {"reaction": HOLDS}, 0.0))
    assert (log, shown.failed_check) == ([(0.0, HOLD * PHASE)], 0.0)
