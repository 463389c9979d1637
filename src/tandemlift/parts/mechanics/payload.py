"""The payload: a beam along body y, a box, or the convex hull of a mesh, or any body with a mass and an inertia.

All that others need of a box or a mesh is its `ConvexHull`, in body axes from the payload's origin.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import combinations, pairwise, product
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from tandemlift.core.errors import shown
from tandemlift.core.keys import Exactly3, Length, PerAxis, Positive, Positive3, Size, Table, Triple, key, must
from tandemlift.core.types import Array

FLAT = 1e-6  # of the extent of a body: corners as near to a plane as this lie in it
SLIVER = 1e-5  # of the square of the extent: a smaller triangle determines no plane
MOST_CORNERS = 32  # of a payload's hull: contact with walls costs time for each


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
    extent = float(np.ptp(points, axis=0).max())
    triples = np.array(list(combinations(range(len(points)), 3))).reshape(-1, 3)
    a, b, c = points[triples].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    sizes = np.linalg.norm(normals, axis=1)
    wide = sizes > SLIVER * extent * extent
    normals, a = normals[wide] / sizes[wide, None], a[wide]
    normals, a = np.vstack([normals, -normals]), np.vstack([a, a])
    offsets = np.sum(normals * a, axis=1)
    above, planes = normals @ points.T - offsets[:, None], dict[frozenset[int], int]()
    for i in np.flatnonzero(above.max(axis=1, initial=-np.inf) <= FLAT * extent).tolist():
        planes.setdefault(frozenset(np.flatnonzero(above[i] >= -FLAT * extent).tolist()), i)
    outer = [i for on, i in planes.items() if not any(on < other for other in planes)]
    normals, offsets = normals[outer], offsets[outer]
    faces = tuple(
        _around(points, np.flatnonzero(above[i] >= -FLAT * extent).tolist(), n)
        for i, n in zip(outer, normals, strict=True)
    )
    edges = sorted({(min(e), max(e)) for face in faces for e in zip(face, (*face[1:], face[0]), strict=True)})
    if len(points) - len(edges) + len(faces) != 2 or {i for face in faces for i in face} != set(range(len(points))):
        raise ValueError("not the corners of a convex body")
    return ConvexHull(points, np.array(edges), faces, normals, offsets)


def _around(points: Array, face: list[int], normal: Array) -> tuple[int, ...]:
    """The corners of a face, counterclockwise about its normal."""
    away = points[face] - points[face].mean(axis=0)
    turn = np.arctan2(away @ np.cross(normal, away[0]), away @ away[0])
    return tuple(face[i] for i in np.argsort(turn))


def _principal(inertia: Triple) -> Triple:
    x, y, z = sorted(inertia)
    if z > (x + y) * (1.0 + 1e-9):
        raise must("inertia", "be principal moments of a body, none greater than the sum of the other two")
    return inertia


def _check_corners(corners: tuple[Triple, ...]) -> None:
    if not 4 <= len(corners) <= MOST_CORNERS:
        raise must("payload", f"have 4 to {MOST_CORNERS} corners, here are {len(corners)}")
    try:
        convex_hull(corners)
    except ValueError as error:
        raise must("payload", f"have the corners of a convex body; these {len(corners)} are {error}") from None


Inertia = Annotated[Positive3, AfterValidator(_principal)]
Areas = Annotated[tuple[Size, Size, Size], PerAxis(3)]
Sides = Annotated[tuple[Length, Length, Length], PerAxis(3)]
Metre = Annotated[float, Field(ge=-1e3, le=1e3)]
Place = Annotated[tuple[Metre, Metre, Metre], PerAxis(3, single=False)]
OWN = {"beam": ("length", "radius"), "box": ("size",), "mesh": ("mesh", "density", "corners")}  # keys of one shape


class Payload(Table):
    """`[vehicle.payload]`: a thin beam along body y, a box, a mesh, or any body with a mass and moments of inertia.

    Positions on the vehicle are from the payload's origin: the middle of a beam or a box, whether its mass is even or
    not, and the origin of a mesh's file. A mesh touches as its convex hull of at most 32 corners.
    """

    shape: Literal["beam", "box", "mesh"] = key(
        "beam",
        None,
        "shape of the payload",
        choices={
            "beam": "a beam with length and radius, or without them a body without shape",
            "box": "a box with edges along the body axes, such as a plate",
            "mesh": "the body in the file of a mesh",
        },
    )
    mass: Positive = key(..., "kg", "mass of the payload", example=0.5)
    center_of_mass: Exactly3 = key(
        (0.0, 0.0, 0.0),
        "m",
        "centre of mass of the payload from its origin, body axes",
        source="the middle of the beam",
    )
    length: Positive | None = key(
        None,
        "m",
        "length of the beam, along body y, with the origin in its middle",
        unset="inertia must be given",
        example=2.0,
    )
    radius: Positive | None = key(None, "m", "radius of the beam", unset="inertia must be given", example=0.05)
    size: Sides | None = key(
        None, "m", "edges of the box along the body axes", unset="the payload is no box", example=[0.5, 1.6, 0.04]
    )
    mesh: str | None = key(
        None,
        None,
        "file of a closed mesh (STL, OBJ or PLY) with z up; its path is relative to the mission file",
        rule="with density; mass, center_of_mass, inertia, products and corners then come from it",
        unset="the payload is no mesh, or has corners",
        example="gearbox.stl",
    )
    mesh_scale: Positive = key(1.0, "m", "length of the unit of the mesh's file", source="its unit is the metre")
    density: Positive | None = key(
        None, "kg/m³", "density of a mesh", unset="mass and inertia must be given", example=400.0
    )
    corners: tuple[Place, ...] | None = key(
        None,
        "m",
        "corners of the convex hull of a mesh, from the payload's origin, body axes",
        rule=f"4 to {MOST_CORNERS} corners of a convex body; with shape 'mesh'",
        unset="those of the mesh",
        example=[[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]],
    )
    inertia: Inertia | None = key(
        None,
        "kg m²",
        "moments of inertia Jx, Jy, Jz about the payload's centre of mass, body axes",
        rule="none above the sum of the other two",
        unset="that of the beam, of the box or of the mesh",
        example=[0.1667, 0.000625, 0.1667],
    )
    products: Exactly3 = key(
        (0.0, 0.0, 0.0),
        "kg m²",
        "products of inertia: the elements Jxy, Jxz, Jyz of the tensor",
        rule="with inertia, those of a body",
        source="the body axes are principal axes",
    )
    drag_area: Areas | None = key(
        None,
        "m²",
        "area A seen along each body axis; drag in moving air is ½ ρ c A v²",
        unset="that of the shape, or none",
        example=[0.2, 0.008, 0.2],
    )
    drag_coefficient: Size = key(1.0, "1", "drag coefficient c", source="chosen: a bluff body")

    @model_validator(mode="after")
    def _complete(self) -> Payload:
        for shape, names in OWN.items():
            for name in names:
                if shape != self.shape and getattr(self, name) is not None:
                    given = f"{name} = {shown(getattr(self, name))}"
                    raise must("payload", f'have no {given} with shape = "{self.shape}", or shape must be "{shape}"')
        if self.mesh_scale != 1.0:
            raise must("payload", f"have no mesh_scale = {shown(self.mesh_scale)} without mesh")
        if self.shape == "box" and self.size is None:
            raise must("payload", 'have size with shape = "box": its edges along the body axes [m]')
        if self.shape == "mesh" and (self.corners is None or self.inertia is None):
            raise must("payload", 'have mesh and density with shape = "mesh", or corners, mass and inertia')
        if self.corners is not None:
            _check_corners(self.corners)
        if self.shape == "beam" and self.inertia is None and (self.length is None or self.radius is None):
            raise must("payload", "have either inertia, or length and radius (of a beam)")
        if any(self.products):
            least, middle, most = np.linalg.eigvalsh(self.tensor)
            if least <= 0.0 or least + middle < most * (1.0 - 1e-9):
                moments = f"{least:.4g}, {middle:.4g}, {most:.4g} kg m²"
                raise must("payload", f"have products of inertia of a body; its principal moments would be {moments}")
        return self

    @property
    def moments(self) -> Triple:
        """Jx, Jy, Jz [kg m²]: as given, of an even box, or of a thin rod along y (m L²/12) with a solid section."""
        if self.inertia is not None:
            return self.inertia
        if self.size is not None:
            x, y, z = (self.mass * side**2 / 12.0 for side in self.size)
            return (y + z, x + z, x + y)
        length, radius = (0.0 if size is None else size for size in (self.length, self.radius))
        across = self.mass * length**2 / 12.0
        return (across, self.mass * radius**2 / 2.0, across)

    @property
    def tensor(self) -> Array:
        """The tensor of inertia about the centre of mass [kg m²], body axes (3 × 3)."""
        xy, xz, yz = self.products
        return np.diag(self.moments) + np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]])

    @property
    def areas(self) -> Triple:
        """Areas [m²] seen along the body axes: as given, or of the shape; zero for a payload without one."""
        if self.drag_area is not None:
            return self.drag_area
        if self.hull is not None:
            return self.hull.areas
        length, radius = (0.0 if size is None else size for size in (self.length, self.radius))
        return (2.0 * radius * length, math.pi * radius**2, 2.0 * radius * length)

    @property
    def hull(self) -> ConvexHull | None:
        """The convex hull of a box or a mesh, from the payload's origin; None for any other payload."""
        if self.size is not None:
            return convex_hull(tuple(product(*[(-0.5 * side, 0.5 * side) for side in self.size])))
        return None if self.corners is None else convex_hull(self.corners)

    @property
    def box(self) -> tuple[Array, Array]:
        """The lowest and the highest corner of the shape [m], body axes, from the payload's origin (3 each)."""
        if self.hull is not None:
            return self.hull.corners.min(axis=0), self.hull.corners.max(axis=0)
        length, radius = (0.0 if size is None else size for size in (self.length, self.radius))
        half = np.array([radius, 0.5 * length, radius])
        return -half, half

    @property
    def span(self) -> float | None:
        """Length along body y [m]: of a beam, or twice the largest distance of a hull from its origin, or None."""
        return self.length if self.hull is None else 2.0 * float(np.abs(self.hull.corners[:, 1]).max())

    @property
    def outline(self) -> Array:
        """Points of lines that show the shape (n, 3) [m], from its origin; NaN between two lines.

        The axis of a beam, the edges of a hull, or a single point.
        """
        if self.hull is not None:
            ends = self.hull.corners[self.hull.edges]
            return np.concatenate([ends, np.full((len(ends), 1, 3), np.nan)], axis=1).reshape(-1, 3)
        half = 0.5 * (self.length or 0.0)
        return np.array([[0.0, -half, 0.0], [0.0, half, 0.0]])[: 2 if half else 1]
