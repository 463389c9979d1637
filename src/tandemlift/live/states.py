"""What else viewers must know of a flight: rotors that were stopped, and when and where hands may touch the vehicle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tandemlift.common.errors import InputError
from tandemlift.live.recorded import RecordedFlight
from tandemlift.live.taring import check_hands_off
from tandemlift.settings import Mission


def dead_rotors(flight: RecordedFlight) -> list[int]:
    """The rotors that have failed, counted over the whole vehicle from 0."""
    at = flight.step * flight.dt
    return sorted(4 * (f.quadrotor - 1) + f.rotor - 1 for f in flight.now.faults if f.time <= at)


def check_touch(flight: RecordedFlight, scene: Mapping[str, Any], point: Sequence[float]) -> None:
    """Refuse a hand that may not touch the vehicle of a scene now, or not at this point [m, body axes].

    Raises:
        InputError: it may not.
    """
    check_hands_off(flight)
    reach = max(_ways(scene["vehicle"]))
    if math.hypot(*point) > reach:
        raise InputError(f"point = {list(point)}: must be on the vehicle, within {reach:.3g} m of its centre of mass")


def check_listens(mission: Mission, what: str) -> None:
    """Refuse to ask a pilot for something that is not guided by hand.

    Raises:
        InputError: it is not.
    """
    if mission.pilot.guidance == "clock":
        raise InputError(f"{what}: mission {mission.mission.name} is guided by the clock and asks nobody")


def _ways(vehicle: Mapping[str, Any]) -> Iterator[float]:
    """How far the ends of the payload and of the rotors are from the centre of mass [m]."""
    payload = vehicle["payload"]
    yield math.hypot(*payload["position"]) + math.hypot(payload["length"], payload["width"], payload["height"]) / 2.0
    for quadrotor in vehicle["quadrotors"]:
        for rotor in quadrotor["rotors"]:
            yield math.hypot(*rotor["position"]) + rotor["radius"]
