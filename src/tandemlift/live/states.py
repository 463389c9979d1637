"""What else viewers must know of a flight: rotors that were stopped, and when and where hands may touch the vehicle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tandemlift.live.recorded import RecordedFlight


def dead_rotors(flight: RecordedFlight) -> list[int]:
    """The rotors that have failed, counted over the whole vehicle from 0."""
    at = flight.step * flight.dt
    return sorted(4 * (f.quadrotor - 1) + f.rotor - 1 for f in flight.now.faults if f.time <= at)


def hands_off(flight: RecordedFlight) -> str:
    """Why nobody may touch the vehicle: its sensors are tared, which would take a hand for a bias; "" if one may."""
    estimator = flight.now.estimator
    if flight.now.pilot.push == "truth":
        return ""
    if estimator.tare == "hover":
        left = estimator.tare_duration - flight.number("memory", "guidance", "phase", "hovered")
        return "hands off until the force sensors are tared, in steady hover" if left > 0.0 else ""
    if estimator.tare_start is None:
        return ""
    end = estimator.tare_start + estimator.tare_duration
    waits = flight.step * flight.dt < end
    return f"hands off until {end:g} s: the force sensors are tared in hover" if waits else ""


def off_vehicle(scene: Mapping[str, Any], point: Sequence[float]) -> str:
    """Why nobody can touch the vehicle of a scene at a point [m, body axes]; "" if somebody can."""
    reach = max(_ways(scene["vehicle"]))
    if math.hypot(*point) <= reach:
        return ""
    return f"point = {list(point)}: must be on the vehicle, within {reach:.3g} m of its centre of mass"


def _ways(vehicle: Mapping[str, Any]) -> Iterator[float]:
    """How far the ends of the payload and of the rotors are from the centre of mass [m]."""
    payload = vehicle["payload"]
    yield math.hypot(*payload["position"]) + math.hypot(payload["length"], payload["width"], payload["height"]) / 2.0
    for quadrotor in vehicle["quadrotors"]:
        for rotor in quadrotor["rotors"]:
            yield math.hypot(*rotor["position"]) + rotor["radius"]
