"""The ending of a flight as numbers: a law, also in mission modules. `simulation.outcome` has the words."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import atan2, chosen, maximum, sqrt, where
from tandemlift.core.law import law
from tandemlift.core.phases import LEFT_FENCE, STRUCK, TURNED_OVER
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent, Vec3, dot
from tandemlift.parts.guidance.fault_detection import distance_outside
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import body_z_axis
from tandemlift.simulation.loop.ending import CrashLimits, CrashMemory, OuterFence, Strike

DEGREE = 57.29577951308232  # 180/π


class EndingMoment(NamedTuple):
    """The moment of an ending: its number in `core.outcomes`, 0 for none; time [s]; state; impulse [N·s]."""

    number: Number
    time: Number
    state: State
    impulse: Number | Absent


class EndingNumbers(NamedTuple):
    """Number and time [s] of an ending; the value that broke its limit; position of the vehicle [m, world].

    `not_finite`: from 1, the place of the part of the state that is not finite, of which the value is one; else 0.
    """

    number: Number
    time: Number
    value: Number
    not_finite: Number
    place: Vec3


@law(absent="now")
def moment_of(crash: CrashMemory, now: EndingMoment) -> EndingMoment:
    """The `EndingMoment` of a crash that is remembered; without one, that of now."""
    before = EndingMoment(crash.number, crash.time, crash.state, crash.impulse)
    return chosen(crash.number, before, now)


@law(absent=0.0)
def impulse_of(strike: Strike, impulse: Number) -> Number:
    """The impulse of contact [N·s]; 0 if there is nothing to touch."""
    return impulse


@law(absent=0.0)
def outside_of(fence: OuterFence, position: Vec3) -> Number:
    """The distance of a position outside the fence [m]."""
    return distance_outside(fence.low, fence.high, position)


@law
def ending_numbers(limits: CrashLimits, crash: CrashMemory | Absent, now: EndingMoment) -> EndingNumbers:
    """The ending of a flight as numbers.

    Args:
        limits: those that end a flight.
        crash: the memory of a crash, or `Absent`.
        now: the number of the ending that stops the flight now, at this time and in this state.
    """
    found = moment_of(crash, now)
    number, state = found.number, found.state
    upright = body_z_axis(state.attitude).z
    tilt = DEGREE * atan2(sqrt(maximum(1.0 - upright * upright, 0.0)), upright)
    value = where(number == TURNED_OVER, tilt, sqrt(dot(state.position, state.position)))
    value = where(number == STRUCK, impulse_of(limits.strike, found.impulse), value)
    value = where(number == LEFT_FENCE, outside_of(limits.fence, state.position), value)
    bad = 0.0
    for place, part in reversed(list(enumerate(state, start=1))):
        for component in part:
            finite = component - component == 0.0
            value, bad = where(finite, value, component), where(finite, bad, float(place))
    return EndingNumbers(number, found.time, value, bad, state.position)
