"""What rotors and tilt can give beside weight, disturbance and push."""

from typing import Any, NamedTuple

from tandemlift.core.algebra.constants import GRAVITY
from tandemlift.core.algebra.law import choice, law
from tandemlift.core.algebra.ops import maximum, sqrt, where
from tandemlift.core.algebra.vector import Vec3, total
from tandemlift.parts.mechanics.rigid_body import UP
from tandemlift.parts.rotors.rotor_faults import NoFaults, RotorFaults, efficiency_at


class AvailableForce(NamedTuple):
    """The nominal `mass` [kg]; `max_thrust` [N] that may be used; `tangent` of the largest tilt.

    `limits` [N] of all rotors, a set, and the faults `known` to the pilot.
    """

    mass: Any
    max_thrust: Any
    tangent: Any
    limits: Any
    known: Any


@choice
def remaining_fraction(known: NoFaults | RotorFaults, limits: Any, t: Any) -> Any:
    """The fraction of the largest thrust that rotors with known faults have at time t [s]; `limits` [N] of each."""


@remaining_fraction.register(NoFaults)
def _all(known: NoFaults, limits: Any, t: Any) -> Any:
    return 1.0


@remaining_fraction.register(RotorFaults)
def _remaining(known: RotorFaults, limits: Any, t: Any) -> Any:
    return total(limits * efficiency_at(known, t)) / total(limits)


@law
def usable_thrust(k: AvailableForce, t: Any) -> Any:
    """The largest thrust [N] that may be used at time t [s]."""
    return k.max_thrust * remaining_fraction(k.known, k.limits, t)


@law
def needed_force(k: AvailableForce, load: Vec3) -> Vec3:
    """The force [N, world axes] that the rotors must give to stay in place under a load [N] besides the weight."""
    return UP * (k.mass * GRAVITY) - load


@law
def available_acceleration(k: AvailableForce, disturbance: Vec3, max_thrust: Any) -> Any:
    """The horizontal acceleration [m/s²] that rotors and tilt can give beside weight and disturbance [N]."""
    d = disturbance
    up = maximum(k.mass * GRAVITY - d.z, 0.0)
    thrust = sqrt(maximum(max_thrust * max_thrust - up * up, 0.0))
    across = sqrt(maximum(d.x * d.x + d.y * d.y, 1e-24))
    limit = where(thrust < up * k.tangent, thrust, up * k.tangent)
    return maximum(limit - across, 0.0) / k.mass
