"""Ground effect: a rotor gives more thrust near the floor.

Source: Cheeseman and Bennett, The effect of the ground on a helicopter rotor in forward flight, ARC R&M 3021 (1955).
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import maximum
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Vec3, set_of, spread
from tandemlift.parts.mechanics.joint_loads import add_to_each
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import world_z_in_body
from tandemlift.parts.mechanics.vehicle import Vehicle

MIN_HEIGHT = 0.5  # rotor radii: the theory of ground effect holds no nearer to the floor


class GroundEffect(NamedTuple):
    """Rotors from the centre of mass [m, body axes, vector of sets], R/4 of their radius R [m], floor's z [m]."""

    rotors: Vec3
    quarter_radius: PerRotor
    floor: Number


@elementwise
def thrust_ratio(height: Number, quarter_radius: Number) -> Number:
    """1/(1 − (R/4z)²), with z no less than half a radius."""
    z = maximum(height, 4.0 * MIN_HEIGHT * quarter_radius)
    ratio = quarter_radius / z
    return 1.0 / (1.0 - ratio * ratio)


@law(absent=1.0)
def ground_effect_ratio(surface: GroundEffect, state: State) -> PerRotor:
    """Thrust near the floor over thrust in free air."""
    r, up = surface.rotors, world_z_in_body(state.attitude)
    offset = r.x * up.x + r.y * up.y + r.z * up.z
    return thrust_ratio(add_to_each(offset, state.position.z - surface.floor), surface.quarter_radius)


def ground_effect_from(vehicle: Vehicle, floor: Number | None) -> GroundEffect | Absent:
    """Ground effect over a floor at z = `floor` [m], if there is one."""
    if floor is None:
        return Absent()
    hubs = [
        (d[0] + x, d[1] + y, d[2])
        for d, q in zip(vehicle.lever_arms, vehicle.quadrotors, strict=True)
        for x, y in q.rotors
    ]
    quarter = [q.rotor_radius / 4.0 for q in vehicle.quadrotors for _ in range(4)]
    return GroundEffect(spread(hubs), set_of(quarter), floor)
