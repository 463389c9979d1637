"""Force left for acceleration once weight, disturbance and push are compensated."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import maximum, sqrt, tan, where
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number, PerRotor
from tandemlift.core.vector import Absent, Vec3, total
from tandemlift.parts.mechanics.rigid_body import UP
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import thrust_limits
from tandemlift.parts.rotors.rotor_faults import RotorFaults, efficiency_at


class AvailableForce(NamedTuple):
    """The nominal `mass` [kg]; `max_thrust` [N] that may be used; `tangent` of the largest tilt.

    `limits` [N] of all rotors, a set, and the faults `known` to the pilot.
    """

    mass: Number
    max_thrust: Number
    tangent: Number
    limits: PerRotor
    known: RotorFaults | Absent


@law(absent=1.0)
def remaining_fraction(known: RotorFaults, limits: PerRotor, t: Number) -> Number:
    """The fraction of the largest thrust that rotors with known faults have at time t [s]; `limits` [N] of each."""
    return total(limits * efficiency_at(known, t)) / total(limits)


@law
def usable_thrust(k: AvailableForce, t: Number) -> Number:
    """The largest thrust [N] that may be used at time t [s]."""
    return k.max_thrust * remaining_fraction(k.known, k.limits, t)


@law
def needed_force(k: AvailableForce, load: Vec3) -> Vec3:
    """The force [N, world axes] that the rotors must give to stay in place under a load [N] besides the weight."""
    return UP * (k.mass * GRAVITY) - load


@law
def available_acceleration(k: AvailableForce, disturbance: Vec3, max_thrust: Number) -> Number:
    """The horizontal acceleration [m/s²] that rotors and tilt can give beside weight and disturbance [N]."""
    d = disturbance
    up = maximum(k.mass * GRAVITY - d.z, 0.0)
    thrust = sqrt(maximum(max_thrust * max_thrust - up * up, 0.0))
    across = sqrt(maximum(d.x * d.x + d.y * d.y, 1e-24))
    limit = where(thrust < up * k.tangent, thrust, up * k.tangent)
    return maximum(limit - across, 0.0) / k.mass


def start_available(
    vehicle: Vehicle, thrust_fraction: Number, max_tilt: Number, known: RotorFaults | Absent
) -> AvailableForce:
    """The available thrust and tilt, by a fraction of the thrust and a largest tilt [rad]; `known`: rotor faults."""
    return AvailableForce(
        mass=vehicle.mass,
        max_thrust=vehicle.max_thrust * thrust_fraction,
        tangent=tan(max_tilt),
        limits=thrust_limits(vehicle),
        known=known,
    )
