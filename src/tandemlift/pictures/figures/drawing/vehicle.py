"""Masses of the vehicle that flew, which may differ from those that its pilot knows."""

from __future__ import annotations

from tandemlift.core.types import GRAVITY
from tandemlift.flight.record import Flight
from tandemlift.parts.mechanics.vehicle import Vehicle


def true_mass(flight: Flight) -> float:
    """Mass [kg] of the vehicle that flew."""
    return Vehicle.from_mission(flight.mission).mass * flight.mission.get("plant", {}).get("mass_scale", 1.0)


def true_weight(flight: Flight) -> float:
    """Weight [N] of the vehicle that flew."""
    return true_mass(flight) * GRAVITY


def true_payload_mass(flight: Flight) -> float:
    """Mass [kg] of the payload that flew: it has the whole difference from the vehicle that the pilot knows."""
    return true_mass(flight) - sum(q.mass for q in Vehicle.from_mission(flight.mission).quadrotors)
