"""The vehicle of a flight: the one that its pilot believes in, and what the one that flew weighs."""

from __future__ import annotations

from tandemlift.algebra.constants import GRAVITY
from tandemlift.flight.record import Flight
from tandemlift.settings import VehicleTable
from tandemlift.vehicle import Vehicle


def vehicle_of(flight: Flight) -> Vehicle:
    """The vehicle that the pilot believes in."""
    return Vehicle.from_settings(VehicleTable.model_validate(flight.mission["vehicle"]))


def mass_of(flight: Flight) -> float:
    """Mass [kg] of the vehicle that flew."""
    return vehicle_of(flight).mass * flight.mission.get("plant", {}).get("mass_scale", 1.0)


def weight_of(flight: Flight) -> float:
    """Weight [N] of the vehicle that flew."""
    return mass_of(flight) * GRAVITY


def payload_mass_of(flight: Flight) -> float:
    """Mass [kg] of the payload that flew: what the vehicle has beyond the one believed in, the payload has."""
    return mass_of(flight) - sum(q.mass for q in vehicle_of(flight).quadrotors)
