"""The outcome of a flight, by the definitions of `common.outcomes`, and why it was stopped before its end."""

from __future__ import annotations

import math
from typing import Any

from tandemlift.algebra.vector import ZERO, Nothing
from tandemlift.common.outcomes import ENDING_OF, FAR, LEFT_FENCE, STRUCK, TURNED_OVER
from tandemlift.flight.record import Ending
from tandemlift.laws.guidance.fault_detection import distance_outside
from tandemlift.laws.mechanics.rigid_body import State
from tandemlift.laws.mechanics.rotation import body_z_axis
from tandemlift.loop.step import FlightState
from tandemlift.settings import Mission
from tandemlift.simulation.plan import FlightPlan

BORNE = 0.5  # of the weight: what the floor bears of a vehicle that stands on it


def ending_of(p: FlightPlan, s: FlightState, step: int) -> Ending | None:
    """Why a flight was stopped at a step, or None."""
    if s.ended == 0.0:
        return None
    number, at, state, impulse = s.ended, step * p.dt, s.state, s.impulse
    if not isinstance(s.crash, Nothing) and s.crash.number > 0.0:
        number, at, state, impulse = s.crash.number, s.crash.time, s.crash.state, s.crash.impulse
    for quantity, values in zip(State._fields, state, strict=True):
        bad = [v for v in values if not math.isfinite(v)]
        if bad:
            return Ending(quantity, at, bad[0], "must be finite")
    value, limit = _measured(p, number, state, impulse)
    return Ending(ENDING_OF[number].quantity, at, value, limit, ENDING_OF[number].outcome)


def _measured(p: FlightPlan, number: float, state: State, impulse: Any) -> tuple[float, str]:
    """The value that ended a flight, and its limit in words."""
    limits = p.model.limits
    if number == TURNED_OVER:
        tilt = math.acos(max(-1.0, min(1.0, body_z_axis(state.attitude).z)))
        return math.degrees(tilt), f"must stay within {math.degrees(p.mission.crash.tilt):g} degrees"
    if number == STRUCK:
        return impulse, f"must stay below {limits.strike.impulse:.3g} N s"
    if number == LEFT_FENCE:
        fence = limits.fence
        return distance_outside(fence.low, fence.high, state.position), f"must stay below {fence.margin:g} m"
    return math.dist(state.position, ZERO), f"must stay below {FAR:g} m"


def outcome_of(p: FlightPlan, s: FlightState, last: Any, highest: float) -> str:
    """The name of the outcome of a flight that is over.

    Args:
        p: the plan of the flight.
        s: its last state.
        last: its last sample.
        highest: the greatest z of its centre of mass [m].
    """
    ending = ending_of(p, s, 0)
    if ending is not None:
        return ending.outcome
    mission, start = p.mission, p.model.flight_state.state.position.z
    if asks_for_lift(mission) and highest - start < _lifted(mission):
        return "not-lifted"
    return "landed" if _stands(p, s.state, last, start) else "flying"


def asks_for_lift(mission: Mission) -> bool:
    """Whether a mission asks its pilot to lift before its end."""
    p, end = mission.phases, mission.mission.duration
    if p.height <= 0.0:
        return False
    return p.lift_start < end or any(r.action == "lift" and r.time < end for r in mission.requests)


def _lifted(mission: Mission) -> float:
    """The height above its start from which on a vehicle has lifted [m]."""
    return min(mission.outcome.lifted_height, 0.5 * mission.phases.height)


def _stands(p: FlightPlan, state: State, last: Any, start: float) -> bool:
    """Whether a vehicle stands at the end; without a floor, whether it is where a landing that is over leaves it."""
    mission, slow = p.mission, math.dist(state.velocity, ZERO) < p.mission.outcome.landed_speed
    if not isinstance(last.contact, Nothing):
        return slow and last.contact.contact_force.z > BORNE * p.model.limits.strike.weight
    land = mission.phases.land_start
    if land is None or land + mission.phases.land_duration > mission.mission.duration:
        return False
    return slow and abs(state.position.z - start) < mission.outcome.landed_height
