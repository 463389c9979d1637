"""What ends a flight before its time, and the time after a crash; `test_outcomes.py` has the impulse of a contact."""

import pytest

from tandemlift.core.phases import DIVERGED, FLIES, STRUCK
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.simulation.loop.ending import (
    STILL_TIME,
    Aftermath,
    CrashMemory,
    unless_crashed,
    until_crash,
    with_aftermath,
)

DT = 1e-3
STILL = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
MOVING = STILL._replace(velocity=Vec3(0.1, 0.0, 0.0))
SOUND = CrashMemory(0.0, 0.0, STILL, 0.0, 0.0)


def flown(numbers, states, seconds, duration=5.0):
    """(the memory, the ending) after each step with the number(t) of an ending and a state(t); impulse k in step k."""
    crash, found = SOUND, []
    for k in range(round(seconds / DT)):
        t = k * DT
        crash, ending = with_aftermath(Aftermath(duration), crash, numbers(t), states(t), float(k), t, DT)
        found.append((crash, ending))
    return found


def test_a_crash_is_kept_as_it_was_whatever_comes_after():
    found = flown(lambda t: STRUCK if 0.2 < t < 0.4 else FLIES, lambda t: MOVING if t < 0.3 else STILL, 0.5)
    assert all(
        crash == SOUND._replace(time=crash.time, state=crash.state, impulse=crash.impulse) for crash, _ in found[:200]
    )
    crash = found[-1][0]
    first = next(k for k, (crash, _) in enumerate(found) if crash.number)
    assert crash[:4] == (STRUCK, pytest.approx((first + 1) * DT), MOVING, float(first))
    assert {ending for _, ending in found} == {FLIES}


@pytest.mark.parametrize(("moves", "ends"), [(False, 0.2 + STILL_TIME), (True, 0.2 + 2.0)])
def test_a_flight_ends_once_the_vehicle_lies_still_or_the_aftermath_is_over(moves, ends):
    found = flown(lambda t: STRUCK if t > 0.2 else FLIES, lambda t: MOVING if moves or t < 0.2 else STILL, 3.0, 2.0)
    over = next(k * DT for k, (_, ending) in enumerate(found) if ending)
    assert over == pytest.approx(ends, abs=1.5 * DT)
    assert found[-1][1] == STRUCK
    turning = STILL._replace(rates=Vec3(0.0, 0.06, 0.0))
    assert not any(ending for _, ending in flown(lambda t: STRUCK, lambda t: turning, 1.0))


def test_divergence_ends_it_at_once_and_a_crash_stops_rotors_and_metrics():
    assert flown(lambda t: DIVERGED, lambda t: MOVING, 0.002)[0][1] == DIVERGED
    crashed = SOUND._replace(number=STRUCK)
    assert (unless_crashed(SOUND, 3.0), unless_crashed(crashed, 3.0)) == (3.0, 0.0)
    before, after = Vec3(1.0, 2.0, 3.0), Vec3(4.0, 5.0, 6.0)
    assert (until_crash(SOUND, before, after), until_crash(crashed, before, after)) == (after, before)
