"""A payload of several bodies: mass, centre of mass and inertia of them all, each evenly filled."""

from __future__ import annotations

from typing import Any

import numpy as np

from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.bodies import Body
from tandemlift.parts.mechanics.vehicle import parallel_axis_term

ALIKE = 1e-9  # relative: a saved mission has the numbers of its bodies, too


def with_bodies(payload: dict[str, Any]) -> dict[str, Any]:
    """The table of a payload with the mass, centre of mass and inertia of its bodies.

    Raises:
        InputError: the payload has another mass, centre of mass or inertia than its bodies.
    """
    given = payload.get("bodies")
    if payload.get("shape") != "bodies" or not isinstance(given, list | tuple):
        return payload
    try:
        bodies = [Body.model_validate(body) for body in given]
    except ValueError:  # the tables of the mission say what is wrong with it
        bodies = []
    if not bodies:
        return {"mass": 1.0, "inertia": [1.0, 1.0, 1.0]} | payload
    mass = sum(body.mass for body in bodies)
    parts = [(body.mass, *solid(body)) for body in bodies]
    center = sum((m * place for m, place, _ in parts), np.zeros(3)) / mass
    tensor = sum((J + parallel_axis_term(m, place - center) for m, place, J in parts), np.zeros((3, 3)))
    (x, xy, xz), (_, y, yz), (_, _, z) = tensor.tolist()
    made = {"mass": mass, "center_of_mass": center.tolist(), "inertia": [x, y, z], "products": [xy, xz, yz]}
    for name, value in made.items():
        if name in payload and not np.allclose(payload[name], value, ALIKE, ALIKE * np.max(np.abs(value))):
            raise InputError(f"{name} = {shown(payload[name])}: must be left out, because it comes from bodies")
    return payload | made


def solid(body: Body) -> tuple[Array, Array]:
    """Centre of mass (3) [m] and tensor of inertia about it (3 × 3) [kg m²] of an evenly filled body, body axes."""
    if body.ends is not None and body.radius is not None:
        start, end = np.array(body.ends)
        square, thick = float((end - start) @ (end - start)), body.radius**2
        outer = np.outer(end - start, end - start) / square
        across = body.mass * (3.0 * thick + square) / 12.0
        return 0.5 * (start + end), across * (np.eye(3) - outer) + 0.5 * body.mass * thick * outer
    corners = body.hull.corners[body.hull.triangles]  # of tetrahedra whose fourth corner is the origin
    volumes, sums = np.linalg.det(corners) / 6.0, corners.sum(axis=1)
    center = volumes @ sums / (4.0 * volumes.sum())
    squares = np.einsum("tki,tkj->tij", corners, corners) + np.einsum("ti,tj->tij", sums, sums)
    spread = np.einsum("t,tij->ij", volumes, squares) / (20.0 * volumes.sum()) - np.outer(center, center)
    return center, body.mass * (np.trace(spread) * np.eye(3) - spread)
