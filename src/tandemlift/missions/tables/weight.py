"""The weight of a mission's vehicle, and the lift of its rotors."""

from __future__ import annotations

from tandemlift.missions.tables.mission import Mission
from tandemlift.parts.mechanics.vehicle import Vehicle


def weight_of(m: Mission) -> float:
    """The true weight of the vehicle [N]."""
    return Vehicle.from_settings(m.vehicle).weight * m.plant.mass_scale


def lift_of(m: Mission, *, faulty: bool = False) -> float:
    """The largest thrust of all rotors together [N]; if `faulty`, with all faults of the flight."""
    faults = [f for f in m.faults if f.time < m.mission.duration] if faulty else []
    lost = sum(m.vehicle.quadrotors[f.quadrotor - 1].max_thrust * (1.0 - f.efficiency) for f in faults)
    return Vehicle.from_settings(m.vehicle).max_thrust - lost
