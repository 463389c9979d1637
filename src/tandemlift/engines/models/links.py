"""A vehicle as rigid bodies: its parts in the form that laws use, and links for the model file of another simulator.

Links are those of the true vehicle, fixed to each other. The difference between the true and the nominal vehicle
(`plant`), a mass and an inertia at the real centre of mass less those at the modelled one, is part of the payload.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.caching import cached
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array, number
from tandemlift.core.vector import Mat3, each, quarters, spread, vec3
from tandemlift.engines.models.scene import Scene
from tandemlift.parts.mechanics.joint_loads import PartsLayout
from tandemlift.parts.mechanics.vehicle import Vehicle, parallel_axis_term
from tandemlift.parts.mechanics.vehicle_table import PlantTable

ROUNDING = 1e-9  # relative tolerance of the triangle inequality of principal moments


@cached
def parts_layout_from(vehicle: Vehicle) -> PartsLayout:
    """The layout of a vehicle's parts."""
    quadrotors, N = vehicle.quadrotors, vehicle.count
    x, y = np.array([q.rotors for q in quadrotors]).reshape(4 * N, 2).T
    turned = any(q.heading for q in quadrotors)
    rows = zip(*[q.tensor for q in quadrotors], strict=True)  # row x of every tensor, then y, then z
    torque = [q.torque_per_thrust * spin for q in quadrotors for spin in q.spins]
    return PartsLayout(
        payload=vec3(vehicle.origin),
        quadrotors=spread(vehicle.lever_arms),
        joints=spread([np.subtract(q.joint_position, q.position) for q in quadrotors]),
        mass=each(N)(*[q.mass for q in quadrotors]),
        inertia=Mat3(*map(spread, rows)) if turned else spread([q.inertia for q in quadrotors]),
        x=quarters(each(4 * N)(*map(number, x))),
        y=quarters(each(4 * N)(*map(number, y))),
        torque=quarters(each(4 * N)(*torque)),
    )


class Link(NamedTuple):
    """A rigid body; its axes are the body axes.

    Attributes:
        name: `payload`, `quadrotor_1`, …
        position: of its frame, from the system's centre of mass [m] (3): the part's nominal centre of mass.
        mass: [kg].
        center: centre of mass in its frame [m] (3).
        inertia: about the centre of mass [kg m²] (3 × 3).
    """

    name: str
    position: Array
    mass: float
    center: Array
    inertia: Array


def links_of(scene: Scene, vehicle: Vehicle) -> list[Link]:
    """The bodies of a mission's true vehicle, the payload first.

    Raises:
        InputError: the difference in mass or inertia makes the payload's mass or inertia unphysical.
    """
    fleet = zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)
    return [
        _payload(scene, vehicle),
        *(Link(f"quadrotor_{i}", d, q.mass, np.zeros(3), q.tensor) for i, (q, d) in enumerate(fleet, 1)),
    ]


def _payload(scene: Scene, vehicle: Vehicle) -> Link:
    """The payload, with the real whole added and the modelled whole taken away."""
    own, origin, plant = vehicle.payload, 0.0 + vehicle.origin, scene.plant
    known = Link("payload", origin, own.mass, np.array(own.center_of_mass), own.tensor)
    if plant == PlantTable():
        return known
    whole, real = vehicle.mass, plant.mass_scale * vehicle.mass
    mass = own.mass + real - whole
    if mass <= 0.0:
        raise _no_body(scene, f"a mass of {mass:g} kg")
    place, off = vehicle.payload_center, np.array(plant.center_of_mass_offset)
    center = (own.mass * place + real * off) / mass  # from the modelled whole's
    inertia = known.inertia + parallel_axis_term(own.mass, place - center)
    inertia = inertia + vehicle.real_inertia(plant) + parallel_axis_term(real, off - center)
    inertia = inertia - vehicle.inertia - parallel_axis_term(whole, center)
    least, middle, most = np.linalg.eigvalsh(inertia)
    if least <= 0.0 or least + middle < most * (1.0 - ROUNDING):
        raise _no_body(scene, f"principal moments of {least:g}, {middle:g} and {most:g} kg m2")
    return known._replace(mass=mass, center=center - origin, inertia=inertia)


def _no_body(scene: Scene, what: str) -> InputError:
    plant = scene.plant
    return InputError(
        f"plant.mass_scale = {plant.mass_scale:g}, plant.inertia_scale = {list(plant.inertia_scale)}, "
        f"plant.center_of_mass_offset = {list(plant.center_of_mass_offset)}: the difference is part of the payload, "
        f"which would have {what}; a model file needs a physical mass and inertia"
    )
