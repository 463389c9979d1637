"""Convex bodies: their corners, edges and faces, and the bodies of which a payload may be made."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise, product
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field, model_validator

from tandemlift.core.arrays import convex_faces
from tandemlift.core.keys import Exactly3, Length, PerAxis, Positive, Table, Triple, key, must
from tandemlift.core.types import Array
from tandemlift.core.vector import vec3
from tandemlift.parts.mechanics.rotation import rotation_from_euler

MOST_CORNERS = 32  # of a hull: contact with walls costs time for each
SIDES, SHORTEST_ROD = 8, 1e-3  # of the prism that a rod touches as; m, a rod

Sides = Annotated[tuple[Length, Length, Length], PerAxis(3)]
Metre = Annotated[float, Field(ge=-1e3, le=1e3)]
Place = Annotated[tuple[Metre, Metre, Metre], PerAxis(3, single=False)]


class ConvexHull(NamedTuple):
    """A convex body: corners (n, 3) [m], edges as pairs of them (m, 2), faces as tuples of them, and their planes.

    The corners of a face are counterclockwise, seen from outside. A face is where normal · x = offset, with unit
    `normals` (f, 3) that point outside and `offsets` (f) [m].
    """

    corners: Array
    edges: Array
    faces: tuple[tuple[int, ...], ...]
    normals: Array
    offsets: Array

    @property
    def triangles(self) -> Array:
        """Corners of triangles that make up the surface (t, 3), counterclockwise seen from outside."""
        return np.array([(face[0], a, b) for face in self.faces for a, b in pairwise(face[1:])])

    @property
    def areas(self) -> Triple:
        """Areas [m²] seen along x, y and z."""
        a, b, c = self.corners[self.triangles].transpose(1, 0, 2)
        x, y, z = (0.25 * np.abs(np.cross(b - a, c - a)).sum(axis=0)).tolist()  # each is seen from two sides
        return x, y, z

    @property
    def width(self) -> float:
        """The smallest distance of a face from the corner farthest behind it [m]."""
        return float(np.min(self.offsets - np.min(self.corners @ self.normals.T, axis=0)))

    def inset(self, depth: float) -> Array:
        """The corners (n, 3) [m] moved inwards, so that each is so deep under its faces [m]."""
        rows = [self.normals[[i in face for face in self.faces]] for i in range(len(self.corners))]
        return self.corners - depth * np.array([np.linalg.pinv(n) @ np.ones(len(n)) for n in rows])


@lru_cache(maxsize=64)
def convex_hull(corners: tuple[Triple, ...]) -> ConvexHull:
    """The convex hull of the corners of a convex body [m]: its faces are the planes with no corner above them.

    Raises:
        ValueError: the points are not the corners of a convex body: fewer than four, in a plane, or within the others.
    """
    points = np.array(corners)
    normals, offsets, faces = convex_faces(points)
    edges = sorted({(min(e), max(e)) for face in faces for e in zip(face, (*face[1:], face[0]), strict=True)})
    if len(points) - len(edges) + len(faces) != 2 or {i for face in faces for i in face} != set(range(len(points))):
        raise ValueError("not the corners of a convex body")
    return ConvexHull(points, np.array(edges), tuple(faces), normals, offsets)


def box_hull(size: Triple, middle: Array | float = 0.0, R: Array | None = None) -> ConvexHull:
    """The hull of a box with edges [m] about a middle (3) [m], rotated by R (3 × 3)."""
    corners = list(product(*[(-0.5 * side, 0.5 * side) for side in size]))
    return convex_hull(tuple(corners if R is None else map(tuple, (middle + np.array(corners) @ R.T).tolist())))


def check_corners(corners: tuple[Triple, ...]) -> None:
    """Refuse what are not the corners of a convex body, or too many."""
    if not 4 <= len(corners) <= MOST_CORNERS:
        raise must("payload", f"have 4 to {MOST_CORNERS} corners, here are {len(corners)}")
    try:
        convex_hull(corners)
    except ValueError as error:
        raise must("payload", f"have the corners of a convex body; these {len(corners)} are {error}") from None


class Body(Table):
    """`[[vehicle.payload.bodies]]`: the convex bodies of a payload with shape "bodies", each evenly filled.

    It is a rod (`ends` and `radius`), a box (`size`) or any other (`corners`). Places are from the payload's origin,
    along the body axes. A rod touches as a prism of eight sides, which is off the rod by 4 % of its radius.
    """

    mass: Positive = key(..., "kg", "mass of the body", example=0.25)
    ends: tuple[Place, Place] | None = key(
        None, "m", "both ends of a rod's axis", unset="the body is no rod", example=[[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]
    )
    radius: Length | None = key(None, "m", "radius of a rod", unset="the body is no rod", example=0.03)
    size: Sides | None = key(None, "m", "edges of a box", unset="the body is no box", example=[0.3, 0.4, 0.1])
    position: Place = key((0.0, 0.0, 0.0), "m", "middle of a box", source="at the origin")
    euler: Exactly3 = key(
        (0.0, 0.0, 0.0), "rad", "roll, pitch and yaw of a box; R = Rz(yaw) Rx(roll) Ry(pitch)", source="level"
    )
    corners: tuple[Place, ...] | None = key(
        None,
        "m",
        "corners of any other body",
        rule=f"4 to {MOST_CORNERS} corners of a convex body",
        unset="the body is a rod or a box",
        example=[[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]],
    )

    @model_validator(mode="after")
    def _complete(self) -> Body:
        if [self.ends, self.size, self.corners].count(None) != 2:
            raise must("body", "have either ends and radius (a rod), size (a box), or corners")
        if (self.ends is None) != (self.radius is None):
            raise must("body", "have ends and radius together, of a rod")
        if self.size is None and any((*self.position, *self.euler)):
            raise must("body", "have no position and no euler without size: they are those of a box")
        if self.ends is not None and math.dist(*self.ends) < SHORTEST_ROD:
            raise must("body", f"have ends that are {SHORTEST_ROD} m or more apart")
        if self.corners is not None:
            check_corners(self.corners)
        return self

    @property
    def hull(self) -> ConvexHull:
        """Its convex hull, from the payload's origin: of a rod a prism, half of it outside and half inside the rod."""
        if self.size is not None:
            return box_hull(self.size, np.array(self.position), np.array(rotation_from_euler(vec3(self.euler))))
        if self.ends is None or self.radius is None:
            return convex_hull(self.corners or ())
        start, end = np.array(self.ends)
        along = (end - start) / np.linalg.norm(end - start)
        side = np.cross([0.0, 0.0, 1.0] if abs(along[2]) < 0.9 else [1.0, 0.0, 0.0], along)
        frame = np.array([side, np.cross(along, side)]) / np.linalg.norm(side)
        turn = (np.arange(SIDES) + 0.5) * (2.0 * np.pi / SIDES)
        radius = 2.0 * self.radius / (1.0 + math.cos(np.pi / SIDES))
        ring = radius * np.column_stack([np.cos(turn), np.sin(turn)]) @ frame
        return convex_hull(tuple(map(tuple, np.concatenate([start + ring, end + ring]).tolist())))
