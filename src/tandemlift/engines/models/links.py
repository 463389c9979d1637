"""A vehicle as rigid bodies: its parts in the form that laws use, and links for the model file of another simulator.

Links are those of the true vehicle, fixed to each other. The difference between the true and the nominal vehicle
(`plant`) is concentrated at the centre of mass, as in the engines. Here it is part of the payload.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.caching import cached
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array, number
from tandemlift.core.vector import each, quarters, spread, vec3
from tandemlift.engines.models.scene import Scene
from tandemlift.parts.mechanics.loads import PartsLayout
from tandemlift.parts.mechanics.vehicle import Vehicle, parallel_axis_term

ROUNDING = 1e-9  # relative tolerance of the triangle inequality of principal moments


@cached
def parts_layout_from(vehicle: Vehicle) -> PartsLayout:
    """The layout of a vehicle's parts."""
    quadrotors, N = vehicle.quadrotors, vehicle.count
    x, y = np.array([q.rotors for q in quadrotors]).reshape(4 * N, 2).T
    torque = [q.torque_per_thrust * spin for q in quadrotors for spin in q.spins]
    return PartsLayout(
        payload=vec3(vehicle.origin),
        quadrotors=spread(vehicle.lever_arms),
        joints=spread([np.subtract(q.joint_position, q.position) for q in quadrotors]),
        mass=each(N)(*[q.mass for q in quadrotors]),
        inertia=spread([q.inertia for q in quadrotors]),
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
        *(Link(f"quadrotor_{i}", d, q.mass, np.zeros(3), np.diag(q.inertia)) for i, (q, d) in enumerate(fleet, 1)),
    ]


def _payload(scene: Scene, vehicle: Vehicle) -> Link:
    """The payload, with the difference between the true and the nominal vehicle."""
    own, origin, plant = vehicle.payload, 0.0 + vehicle.origin, scene.plant
    place = 0.0 + vehicle.payload_center
    known = Link("payload", origin, own.mass, np.array(own.center_of_mass), own.tensor)
    if plant.mass_scale == 1.0 and plant.inertia_scale == (1.0, 1.0, 1.0):
        return known
    scale, J, more = np.diag(np.sqrt(plant.inertia_scale)), vehicle.inertia, (plant.mass_scale - 1.0) * vehicle.mass
    mass = own.mass + more
    if mass <= 0.0:
        raise _no_body(scene, f"a mass of {mass:g} kg")
    center = own.mass / mass * place  # from the system's, where the difference is concentrated
    inertia = (
        known.inertia
        + parallel_axis_term(own.mass, place - center)
        + scale @ J @ scale
        - J
        + parallel_axis_term(more, center)
    )
    least, middle, most = np.linalg.eigvalsh(inertia)
    if least <= 0.0 or least + middle < most * (1.0 - ROUNDING):
        raise _no_body(scene, f"principal moments of {least:g}, {middle:g} and {most:g} kg m2")
    return known._replace(mass=mass, center=center - origin, inertia=inertia)


def _no_body(scene: Scene, what: str) -> InputError:
    plant = scene.plant
    return InputError(
        f"plant.mass_scale = {plant.mass_scale:g}, plant.inertia_scale = {list(plant.inertia_scale)}: the difference "
        f"is part of the payload, which would have {what}; a model file needs a physical mass and inertia"
    )
