"""The outcome of a flight, by the definitions of `core.phases`, and the reason of an early end.

The ending as numbers is a law, which modules for other machines have too; the words are added here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce
from typing import Any, NamedTuple

from tandemlift.core.algebra import atan2, chosen, maximum, sqrt, where
from tandemlift.core.law import law
from tandemlift.core.phases import (
    DIVERGED,
    ENDING_OF,
    ENDINGS,
    LARGEST_DISTANCE,
    LEFT_FENCE,
    STRUCK,
    TURNED_OVER,
    EndingKind,
)
from tandemlift.core.trajectories import PhasesTable
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3, dot
from tandemlift.flight.record import CAUSE_TEXT, ENDING_TEXT, Ending
from tandemlift.parts.guidance.compliance import ComplianceTable
from tandemlift.parts.guidance.fault_detection import distance_outside
from tandemlift.parts.guidance.requests import RequestTable
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import body_z_axis
from tandemlift.simulation.loop.ending import CrashLimits, CrashMemory, OuterFence, Strike
from tandemlift.simulation.loop.log_sample import Sample
from tandemlift.simulation.loop.step import FlightState
from tandemlift.simulation.plan import FlightPlan

NOT_FINITE = "must be finite"
LARGEST_SLOPE = 1.875  # slope of the smooth step that a landing follows
MARGIN = 1.0  # s, in which a landing should touch down after its reference
BORNE_SHARE = 0.5  # of the weight: the part that the floor carries of a standing vehicle
DEGREE = 57.29577951308232  # 180/π


class EndingMoment(NamedTuple):
    """The moment of an ending: its number in `core.phases`, 0 for none; time [s]; state; impulse [N·s]."""

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


def ending_of(p: FlightPlan, s: FlightState, step: int, interruption: Ending | None = None) -> Ending | None:
    """The reason for stopping a flight at a step, or None; a crash counts before a later interruption."""
    ended = s.ended or (getattr(s.crash, "number", 0.0) if interruption else 0.0)
    if ended == 0.0:
        return interruption
    found = ending_numbers(p.model.limits, s.crash, EndingMoment(ended, step * p.dt, s.state, s.impulse))
    if found.not_finite:
        return Ending(State._fields[int(found.not_finite) - 1], found.time, found.value, NOT_FINITE)
    kind = ENDING_OF[found.number]
    cause = cause_of(p, found.number).format(value=f"{found.value:.3g}")
    return Ending(kind.quantity, found.time, found.value, limit_of(p, found.number), kind.outcome, cause)


ENDING_PARTS = (("limits",), *[("flight_state", name) for name in ("crash", "ended", "state", "impulse")])


def ending_parts(p: FlightPlan) -> tuple[Any, ...]:
    """The values of a flight that its ending follows from; `ENDING_PARTS` are their paths."""
    return tuple(reduce(getattr, path, p.model) for path in ENDING_PARTS)


def ending_from(limits: Any, crash: Any, ended: Any, state: Any, impulse: Any, t: Any) -> EndingNumbers:
    """The ending of a flight at time t [s], from its `ENDING_PARTS`."""
    return ending_numbers(limits, crash, EndingMoment(ended, t, state, impulse))


def ending_texts(p: FlightPlan) -> dict[str, Any]:
    """Outcome and text of each ending by number; the texts of non-finite values by their place in the state.

    The places of a text's numbers are in braces; {rounded}: of three digits.
    """
    known = {str(int(k.number)): _ending_text(p, k, k.quantity, limit_of(p, k.number)) for k in ENDINGS}
    return {"by_number": known, "not_finite": [_ending_text(p, ENDING_OF[DIVERGED], part) for part in State._fields]}


def _ending_text(p: FlightPlan, kind: EndingKind, quantity: str, limit: str = NOT_FINITE) -> dict[str, str]:
    cause = cause_of(p, kind.number).format(value="{rounded}")
    named = {"quantity": quantity, "limit": limit, "time": "{time}", "value": "{value}", "cause": cause}
    text = (CAUSE_TEXT if cause else ENDING_TEXT).replace(":.6g", "")
    return {"outcome": kind.outcome, "text": text.format(outcome=kind.outcome, **named)}


def place_of(p: FlightPlan, s: FlightState) -> Vec3:
    """The place at which a flight ended [m, world]."""
    return ending_numbers(p.model.limits, s.crash, EndingMoment(s.ended, 0.0, s.state, s.impulse)).place


def limit_of(p: FlightPlan, number: float) -> str:
    """The limit that an ending has broken, in words."""
    limits = p.model.limits
    if number == TURNED_OVER:
        return f"must stay within {math.degrees(p.mission.crash.tilt):g} degrees"
    if number == STRUCK and not isinstance(limits.strike, Absent):
        return f"must stay below {limits.strike.impulse:.3g} N s"
    if number == LEFT_FENCE:
        return f"must stay below {p.mission.crash.fence_margin:g} m"
    return f"must stay below {LARGEST_DISTANCE:g} m"


def cause_of(p: FlightPlan, number: float) -> str:
    """The cause of an ending in words, with its {value} in braces; empty where quantity and limit say it."""
    strike = p.model.limits.strike
    if number != STRUCK or isinstance(strike, Absent):
        return ""
    floor, walls = p.mission.ground.model != "none", bool(p.mission.all_walls)
    surface = " or ".join([*["the floor"] * floor, *["a wall"] * walls])
    return f"hit {surface}: {{value}} of {strike.impulse:.3g} N s"


def outcome_of(p: FlightPlan, s: FlightState, last: Sample, highest: float, end: float) -> str:
    """The name of the outcome of a flight that was not stopped before its end.

    Args:
        p: the plan of the flight.
        s: its last state.
        last: its last sample.
        highest: the greatest z of its centre of mass [m].
        end: time of its end [s].
    """
    mission, start = p.mission, p.model.flight_state.state.position.z
    lifted = min(mission.outcome.lifted_height, 0.5 * mission.phases.height)
    if asks_for_lift(mission.phases, mission.requests, end) and highest - start < lifted:
        return "not-lifted"
    return "landed" if _stands(p, s.state, last, start, end) else "flying"


def asks_for_lift(p: PhasesTable, requests: Sequence[RequestTable], end: float) -> bool:
    """Whether a flight has a lift that should be over by its end [s]."""
    if p.height <= 0.0:
        return False
    asked = [p.lift_start, *(r.time for r in requests if r.action == "lift")]
    return min(asked) + p.lift_duration < end


def _stands(p: FlightPlan, state: State, last: Sample, start: float, end: float) -> bool:
    """Whether a vehicle stands at the end [s]; without a floor, whether it is at the place of its landing."""
    mission, slow = p.mission, math.dist(state.velocity, ZERO) < p.mission.outcome.landed_speed
    strike = p.model.limits.strike
    if not isinstance(last.contact, Absent) and not isinstance(strike, Absent):
        return slow and last.contact.contact_force.z > BORNE_SHARE * strike.weight
    land = mission.phases.land_start
    if land is None or land + mission.phases.land_duration > end:
        return False
    return slow and abs(state.position.z - start) < mission.outcome.landed_height


def landing_time(p: PhasesTable, by_hand: ComplianceTable | None) -> float:
    """The longest time of a landing from the height of the lift [s]; `by_hand`: limits of interactive guidance."""
    if by_hand is None:
        return p.land_duration
    return (
        max(p.land_duration, LARGEST_SLOPE * (p.height + by_hand.touchdown_depth) / by_hand.max_descent_speed) + MARGIN
    )
