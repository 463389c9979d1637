"""Checks of requests in flight: touching the vehicle, requests to its pilot, taring force sensors; failed rotors.

A tare in flight sets the bias of the force sensors to their readings in hover without a push. The texts of refusals
have placeholders in braces, which a session fills in; so does a page that flies without a server, to which
`apps.live.page_manifest` gives them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tandemlift.apps.live.session.server_messages import SceneVehicle
from tandemlift.core.algebra import Number, sqrt, where
from tandemlift.core.errors import InputError
from tandemlift.core.phases import CONTACT, GUIDED, HOLD, PHASE_NAMES
from tandemlift.core.vector import ZERO, Vec3, dot
from tandemlift.missions import Mission
from tandemlift.simulation.recorded_flight import RecordedFlight

TARE = "estimator.tare_start"
HOVER_TIME = ("memory", "guidance", "phase", "hover_time")  # of a flight's state
TARE_NOTICE = 1.0  # s, from the request until a tare begins: to prepare it, and to let go

UNKNOWN = "{key}: is not a parameter that can be changed in flight; there are {known}"
NO_NUMBER = "{key} = {value}: must be a number, or a list of numbers"
OUT_OF_BOUNDS = "{key} = {value}: must be from {low:g} to {high:g}"
OVER = "{key}: the flight is over; reset it first"
WHOLE_ROTORS = "rotor {rotor}: the rotors of this mission cannot fail"
FAILED_ALREADY = "rotor {rotor}: fails at {time:g} s already"
BESIDE_TEXT = "point = {point}: must be on the vehicle, within {reach:.3g} m of its centre of mass"
TARED_IN_HOVER_TEXT = "hands off until the force sensors are tared, in steady hover"
TARED_UNTIL_TEXT = "hands off until {end:g} s: the force sensors are tared in hover"
REPEATABLE = ("compiled", "mujoco")  # engines whose bodies only the flight pushes
NOT_REPEATABLE = "{what}: others may push the body in {engine}, so that its flights cannot be flown again"
NO_REQUESTS = "{what}: mission {mission} is scheduled and takes no requests"

ALLOWED, TARED_IN_HOVER, TARED_UNTIL, BESIDE = 0.0, 1.0, 2.0, 3.0  # whether a push is allowed, else the reason


class TouchRule(NamedTuple):
    """Times and places at which a vehicle may be pushed.

    Attributes:
        reach: farthest point from the centre of mass [m].
        tare_duration: hover that the tare of its force sensors takes, if the pilot tares by itself [s]; else 0.
        tare_end: when a tare at a set time ends [s]; 0 without one.
    """

    reach: Number
    tare_duration: Number
    tare_end: Number


def touch_rule(mission: Mission, vehicle: SceneVehicle) -> TouchRule:
    """The rule of the mission as it is now."""
    reach, estimator, start = max(_reaches(vehicle)), mission.estimator, mission.estimator.tare_start
    if mission.pilot.push == "truth":  # no force sensor is read, so none is tared
        return TouchRule(reach, 0.0, 0.0)
    if estimator.tare == "hover":
        return TouchRule(reach, estimator.tare_duration, 0.0)
    return TouchRule(reach, 0.0, 0.0 if start is None else start + estimator.tare_duration)


def touch_refusal(rule: TouchRule, at: Number, hover_time: Number, point: Vec3) -> Number:
    """The reason of a push's refusal, as a number; `ALLOWED` if it is not refused.

    Args:
        rule: of the mission as it is now.
        at: time [s].
        hover_time: for which the vehicle has hovered [s].
        point: of the push [m, body axes].
    """
    beside = where(sqrt(dot(point, point)) > rule.reach, BESIDE, ALLOWED)
    tared_until = where(at < rule.tare_end, TARED_UNTIL, beside)
    return where(hover_time < rule.tare_duration, TARED_IN_HOVER, tared_until)


def touch_texts(rule: TouchRule) -> dict[float, str]:
    """The texts of the refusals, complete but for the point."""
    beside = BESIDE_TEXT.format(point="{point}", reach=rule.reach)
    tared_until = TARED_UNTIL_TEXT.format(end=rule.tare_end)
    return {TARED_IN_HOVER: TARED_IN_HOVER_TEXT, TARED_UNTIL: tared_until, BESIDE: beside}


def failed_rotors(flight: RecordedFlight) -> list[int]:
    """The rotors that have failed, counted over the whole vehicle from 0."""
    at = flight.step * flight.dt
    return sorted(4 * (f.quadrotor - 1) + f.rotor - 1 for f in flight.now.faults if f.time <= at)


def check_touch(flight: RecordedFlight, vehicle: SceneVehicle, point: Sequence[float]) -> None:
    """Refuse a push while sensors are tared, or at a point [m, body axes] beside the vehicle.

    Raises:
        InputError: it is refused.
    """
    rule = touch_rule(flight.now, vehicle)
    refusal = touch_refusal(rule, flight.step * flight.dt, _hover_time(flight, rule), Vec3(*point))
    if refusal != ALLOWED:
        raise InputError(touch_texts(rule)[refusal].format(point=list(point)))


def tare_left(flight: RecordedFlight, vehicle: SceneVehicle) -> float:
    """The time for which nobody may touch the vehicle, as its force sensors are tared [s]; else 0."""
    rule = touch_rule(flight.now, vehicle)
    return max(rule.tare_end - flight.step * flight.dt, rule.tare_duration - _hover_time(flight, rule), 0.0)


def _hover_time(flight: RecordedFlight, rule: TouchRule) -> float:
    """For how long the vehicle has hovered [s]; 0 where no tare needs it."""
    return flight.number(*HOVER_TIME) if rule.tare_duration else 0.0


def check_repeatable(engine: str, what: str = "rewind") -> None:
    """Refuse to fly again in an engine that does not do the same twice.

    Raises:
        InputError: it does not.
    """
    if engine not in REPEATABLE:
        raise InputError(NOT_REPEATABLE.format(what=what, engine=engine))


def check_may_tare(flight: RecordedFlight, vehicle: SceneVehicle, phase: str) -> None:
    """Refuse a tare except in hover and without a push; `phase`: of the flight.

    Raises:
        InputError: it does not hover, the beam is held, or a tare is under way.
    """
    if flight.now.estimator.tare == "at-time":
        check_touch(flight, vehicle, ZERO)
    if phase not in [PHASE_NAMES[int(number)] for number in (GUIDED, HOLD, CONTACT)]:
        raise InputError(f"tare: only in the air, hovering; the phase is {phase}")
    if flight.hand.held or any(flight.hand.force):
        raise InputError("tare: hands off first")


def tare_start_for(flight: RecordedFlight) -> float:
    """The earliest begin of a tare that is requested now [s].

    Raises:
        InputError: the mission has no tare, or begins it by itself.
    """
    mission = flight.now
    if mission.pilot.push == "truth":
        raise InputError("tare: the pilot receives the true push, and uses no sensor that could be tared")
    if mission.estimator.tare == "hover":
        raise InputError("tare: the pilot tares by itself, in steady hover (estimator.tare)")
    if mission.estimator.tare_start is None:
        raise InputError(f"tare: the mission has none ({TARE})")
    return round(flight.step * flight.dt + TARE_NOTICE, 3)


def check_in_time(flight: RecordedFlight, start: float) -> None:
    """Refuse a tare whose start has passed while it was prepared: it would continue where the last one ended.

    Raises:
        InputError: it has.
    """
    if flight.step * flight.dt > start - 2.0 * flight.dt:
        raise InputError("tare: it took too long to prepare; ask again")


def _reaches(vehicle: SceneVehicle) -> Iterator[float]:
    """Distances of the ends of the payload and of the rotors from the centre of mass [m]."""
    payload = vehicle["payload"]
    yield math.hypot(*payload["position"]) + math.hypot(payload["length"], payload["width"], payload["height"]) / 2.0
    for quadrotor in vehicle["quadrotors"]:
        for rotor in quadrotor["rotors"]:
            yield math.hypot(*rotor["position"]) + rotor["radius"]
