"""What a mission's vehicle weighs, and what its rotors lift."""

from __future__ import annotations

from tandemlift.missions.tables.mission import Mission
from tandemlift.parts.mechanics.vehicle import Vehicle


def weight_of(m: Mission) -> float:
    """What the vehicle really weighs [N]."""
    return Vehicle.from_settings(m.vehicle).weight * m.plant.mass_scale


def lift_of(m: Mission, *, faulty: bool = False) -> float:
    """What all rotors together lift at most [N]; if `faulty`, once all faults of the flight are there."""
    faults = [f for f in m.faults if f.time < m.mission.duration] if faulty else []
    lost = sum(m.vehicle.quadrotors[f.quadrotor - 1].max_thrust * (1.0 - f.efficiency) for f in faults)
    return Vehicle.from_settings(m.vehicle).max_thrust - lost
