"""What is allowed in flight: touching the vehicle, asking its pilot, taring its force sensors; and which rotors failed.

A tare in flight takes what the force sensors read in hover, without a push, as their bias.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from tandemlift.common.errors import InputError
from tandemlift.common.phases import GUIDED, HOLD, PHASE_NAMES
from tandemlift.live.wire.scene import SceneVehicle
from tandemlift.missions import Mission
from tandemlift.simulation.recorded_flight import RecordedFlight

TARE = "estimator.tare_start"
TARE_NOTICE = 1.0  # s, from the request until a tare begins: to prepare it, and to let go


def failed_rotors(flight: RecordedFlight) -> list[int]:
    """The rotors that have failed, counted over the whole vehicle from 0."""
    at = flight.step * flight.dt
    return sorted(4 * (f.quadrotor - 1) + f.rotor - 1 for f in flight.now.faults if f.time <= at)


def check_touch(flight: RecordedFlight, vehicle: SceneVehicle, point: Sequence[float]) -> None:
    """Refuse a push while sensors are tared, or at a point [m, body axes] beside the vehicle.

    Raises:
        InputError: it is refused.
    """
    check_hands_off(flight)
    reach = max(_reaches(vehicle))
    if math.hypot(*point) > reach:
        raise InputError(f"point = {list(point)}: must be on the vehicle, within {reach:.3g} m of its centre of mass")


def check_takes_requests(mission: Mission, what: str) -> None:
    """Refuse a request to a pilot that is guided by the clock.

    Raises:
        InputError: it is.
    """
    if mission.pilot.guidance == "clock":
        raise InputError(f"{what}: mission {mission.mission.name} is guided by the clock and takes no requests")


def check_hands_off(flight: RecordedFlight) -> None:
    """Refuse a push while the force sensors are tared, as the tare would take it for a bias.

    Raises:
        InputError: they are.
    """
    mission = flight.now
    start, at = mission.estimator.tare_start, flight.step * flight.dt
    if mission.pilot.push == "truth":
        return
    if mission.estimator.tare == "hover":
        if flight.number("memory", "guidance", "phase", "hover_time") < mission.estimator.tare_duration:
            raise InputError("hands off until the force sensors are tared, in steady hover")
        return
    if start is None:
        return
    end = start + mission.estimator.tare_duration
    if at < end:
        raise InputError(f"hands off until {end:g} s: the force sensors are tared in hover")


def check_may_tare(flight: RecordedFlight, phase: str) -> None:
    """Refuse a tare except in hover and without a push; `phase`: of the flight.

    Raises:
        InputError: it does not hover, the beam is held, or a tare is under way.
    """
    if flight.now.estimator.tare == "clock":
        check_hands_off(flight)
    if phase not in (PHASE_NAMES[int(GUIDED)], PHASE_NAMES[int(HOLD)]):
        raise InputError(f"tare: only in the air, hovering; the phase is {phase}")
    if flight.hand.held or any(flight.hand.force):
        raise InputError("tare: hands off first")


def tare_start_for(flight: RecordedFlight) -> float:
    """When a tare that is requested now may begin [s].

    Raises:
        InputError: the mission has no tare, or begins it by itself.
    """
    mission = flight.now
    if mission.pilot.push == "truth":
        raise InputError("tare: the pilot is given the true push, and reads no sensor that could be tared")
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
