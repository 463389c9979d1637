"""Positions, masses and inertias of a vehicle's parts, in the form that the laws of mechanics use."""

from __future__ import annotations

import numpy as np

from tandemlift.core.caching import cached
from tandemlift.core.types import number
from tandemlift.core.vector import each, quarters, spread, vec3
from tandemlift.parts.mechanics.loads import PartsLayout
from tandemlift.parts.mechanics.vehicle import Vehicle


@cached
def parts_layout_from(vehicle: Vehicle) -> PartsLayout:
    """The layout of a vehicle's parts."""
    quadrotors, N = vehicle.quadrotors, vehicle.count
    x, y = np.array([q.rotors for q in quadrotors]).reshape(4 * N, 2).T
    torque = [q.torque_per_thrust * spin for q in quadrotors for spin in q.spins]
    return PartsLayout(
        payload=vec3(-vehicle.center_of_mass),
        quadrotors=spread(vehicle.lever_arms),
        joints=spread([np.subtract(q.joint_position, q.position) for q in quadrotors]),
        mass=each(N)(*[q.mass for q in quadrotors]),
        inertia=spread([q.inertia for q in quadrotors]),
        x=quarters(each(4 * N)(*map(number, x))),
        y=quarters(each(4 * N)(*map(number, y))),
        torque=quarters(each(4 * N)(*torque)),
    )
