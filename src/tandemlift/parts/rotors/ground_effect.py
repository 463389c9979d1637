"""Ground effect: a rotor gives more thrust near the floor.

Source: Cheeseman and Bennett, The effect of the ground on a helicopter rotor in forward flight, ARC R&M 3021 (1955).
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import maximum
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Vec3
from tandemlift.parts.mechanics.rigid_body import State

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


@elementwise
def height_above(offset: Number, z: Number) -> Number:
    """The height [m] of a rotor that is `offset` above the centre of mass, which is z above the floor."""
    return offset + z


@law(absent=1.0)
def ground_effect_ratio(surface: GroundEffect, state: State) -> PerRotor:
    """Thrust near the floor over thrust in free air."""
    q, r = state.attitude, surface.rotors
    up = Vec3(2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))
    offset = r.x * up.x + r.y * up.y + r.z * up.z
    return thrust_ratio(height_above(offset, state.position.z - surface.floor), surface.quarter_radius)
