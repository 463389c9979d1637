"""A vehicle as bodies that are fixed to each other: what a model file of another simulator holds of it.

What the true vehicle has beyond the one that its pilot knows (`plant`) sits at the centre of mass and is fixed to the
payload, as in both engines: here it is a part of the payload.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.settings import Mission
from tandemlift.vehicle import Vehicle, parallel_axis_term

ROUNDING = 1e-9  # of a flat body's largest moment, by which the other two may together be less


class Link(NamedTuple):
    """A rigid body; its axes are the body axes.

    Attributes:
        name: `payload`, `quadrotor_1`, …
        position: of its frame from the centre of mass of the system [m] (3): the centre of mass of the payload or of
            the quadrotor, as the pilot knows it.
        mass: [kg].
        center: of its mass, from its frame [m] (3).
        inertia: about there [kg m²] (3 × 3).
    """

    name: str
    position: Array
    mass: float
    center: Array
    inertia: Array


def links_of(mission: Mission, vehicle: Vehicle) -> list[Link]:
    """The bodies of a mission's vehicle as it really is, the payload first.

    Raises:
        InputError: the true vehicle is so much lighter, or has so much less inertia, that the payload would be no body.
    """
    fleet = zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)
    return [
        _payload(mission, vehicle),
        *(Link(f"quadrotor_{i}", d, q.mass, np.zeros(3), np.diag(q.inertia)) for i, (q, d) in enumerate(fleet, 1)),
    ]


def _payload(mission: Mission, vehicle: Vehicle) -> Link:
    """The payload, with the difference between the true vehicle and the one that is known."""
    own, place, plant = vehicle.payload, 0.0 - vehicle.center_of_mass, mission.plant
    known = Link("payload", place, own.mass, np.zeros(3), np.diag(own.moments))
    if plant.mass_scale == 1.0 and plant.inertia_scale == (1.0, 1.0, 1.0):
        return known
    scale, J, more = np.diag(np.sqrt(plant.inertia_scale)), vehicle.inertia, (plant.mass_scale - 1.0) * vehicle.mass
    mass = own.mass + more
    if mass <= 0.0:
        raise _no_body(mission, f"a mass of {mass:g} kg")
    center = own.mass / mass * place  # from the system's, where the difference is
    inertia = (
        known.inertia
        + parallel_axis_term(own.mass, place - center)
        + scale @ J @ scale
        - J
        + parallel_axis_term(more, center)
    )
    least, middle, most = np.linalg.eigvalsh(inertia)
    if least <= 0.0 or least + middle < most * (1.0 - ROUNDING):
        raise _no_body(mission, f"principal moments of {least:g}, {middle:g} and {most:g} kg m2")
    return known._replace(mass=mass, center=center - place, inertia=inertia)


def _no_body(mission: Mission, what: str) -> InputError:
    plant = mission.plant
    return InputError(
        f"plant.mass_scale = {plant.mass_scale:g}, plant.inertia_scale = {list(plant.inertia_scale)}: the difference "
        f"is part of the payload, which then had {what}; a model file can only hold a body that there can be"
    )
