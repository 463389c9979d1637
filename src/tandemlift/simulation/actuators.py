"""The rotors of a mission: ideal, or real with limits, lag, delay, faults and ground effect."""

from __future__ import annotations

from typing import Any

from tandemlift.algebra.vector import Nothing, each
from tandemlift.laws.rotors.dynamics import FreeAir, IdealRotors, RotorState, ground_effect, rotor_faults, rotors_from
from tandemlift.laws.rotors.thrust_limits import share_scale
from tandemlift.settings import Mission
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
    failures = [(f.quadrotor, f.rotor, f.time, f.efficiency) for f in mission.faults]
    surface = ground_effect(vehicle, floor.height) if mission.ground.effect else FreeAir()
    rotors = rotors_from(
        vehicle,
        mission.mission.step,
        late=late,
        faults=rotor_faults(vehicle.rotor_count, failures),
        surface=surface,
        per_reach=share_scale(vehicle.effect),
    )
    cls, share = type(hover), 1.0 if mission.actuators.start == "hover" else 0.0
    start = cls(*[share * min(max(f, 0.0), most) for f, most in zip(hover, rotors.max_thrust, strict=True)])
    speed = cls(*[(f * c) ** 0.5 for f, c in zip(start, rotors.per_constant, strict=True)])
    return rotors, RotorState(speed, start), start
