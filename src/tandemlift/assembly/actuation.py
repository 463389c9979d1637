"""The rotors of a mission: ideal, or real with limits, lag, delay, faults and ground effect."""

from __future__ import annotations

from typing import Any

from tandemlift.laws.limits import share_scale
from tandemlift.laws.rotors import FreeAir, IdealRotors, Spinning, ground_effect, rotors_of
from tandemlift.pilot.start import faults_of
from tandemlift.settings import Mission
from tandemlift.vector import Nothing, each
from tandemlift.vehicle import Vehicle


def hover_thrusts(vehicle: Vehicle, weights: Any) -> Any:
    """Thrusts of all rotors [N] that carry the weight, as a set."""
    thrusts = vehicle.allocation(weights) @ [vehicle.weight, 0.0, 0.0, 0.0]
    return each(vehicle.rotor_count)(*thrusts.tolist())


def start_rotors(mission: Mission, vehicle: Vehicle, floor: Any, *, late: bool) -> tuple[Any, Any, Any]:
    """The rotors of a mission, their memory at t = 0, and their thrusts [N] then."""
    hover = hover_thrusts(vehicle, mission.allocation.weights)
    if mission.actuators.model == "ideal":
        return IdealRotors(), Nothing(), hover
    surface = ground_effect(vehicle, floor.height) if mission.ground.effect else FreeAir()
    rotors = rotors_of(
        vehicle,
        mission.mission.step,
        late=late,
        faults=faults_of(mission, vehicle),
        surface=surface,
        per_reach=share_scale(vehicle.effect),
    )
    cls, share = type(hover), 1.0 if mission.actuators.start == "hover" else 0.0
    start = cls(*[share * min(max(f, 0.0), most) for f, most in zip(hover, rotors.max_thrust, strict=True)])
    speed = cls(*[(f * c) ** 0.5 for f, c in zip(start, rotors.per_constant, strict=True)])
    return rotors, Spinning(speed, start), start
