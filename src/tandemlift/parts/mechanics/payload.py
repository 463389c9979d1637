"""The payload: a beam along body y, a box, a mesh, several bodies, or any body with a mass and an inertia.

All that others need of the shape of a box, a mesh or bodies are its `hulls`, in body axes from the payload's origin.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from tandemlift.core.errors import shown
from tandemlift.core.keys import (
    Exactly3,
    Length,
    PerAxis,
    Positive,
    Positive3,
    Share,
    Size,
    Table,
    Triple,
    key,
    must,
)
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.beam_material import MATERIALS, MaterialName, RoundSection
from tandemlift.parts.mechanics.bodies import Body, ConvexHull, Place, Sides, box_hull, check_corners, convex_hull

DAMPING = 0.01  # ratio, of a beam whose material is not named
SLENDER = 10.0  # diameters, from which a beam is the thin rod of the paper's Table II: its inertia is 0.8 % less


def _principal(inertia: Triple) -> Triple:
    x, y, z = sorted(inertia)
    if z > (x + y) * (1.0 + 1e-9):
        raise must("inertia", "be principal moments of a body, none greater than the sum of the other two")
    return inertia


Inertia = Annotated[Positive3, AfterValidator(_principal)]
Areas = Annotated[tuple[Size, Size, Size], PerAxis(3)]
ELASTIC = (  # whether modes are flown
    "vehicle.payload.material is given or vehicle.payload.bending_stiffness is given "
    "or vehicle.quadrotors.0.joint_stiffness is given"
)
OF_BEAM = ("material", "wall", "bending_stiffness", "torsional_stiffness", "damping")  # keys of a beam that bends
OWN = {  # keys of one shape
    **{"beam": ("length", "radius", *OF_BEAM), "box": ("size",), "mesh": ("mesh", "density", "corners")},
    "bodies": ("bodies",),
}


class Payload(
    Table,
    keys_act={
        "drag_area drag_coefficient": 'wind.model = "air" or estimator.confirmation = "motion"',
        "modes": ELASTIC,
    },
):
    """`[vehicle.payload]`: a beam along body y, a box, a mesh, bodies, or any with a mass and moments of inertia.

    Positions on the vehicle are from the payload's origin: the middle of a beam or a box, whether its mass is even or
    not, and the origin of a mesh's file. A mesh touches as its convex hull of at most 32 corners. Mass, centre of mass,
    inertia and products of bodies come from them.
    """

    shape: Literal["beam", "box", "mesh", "bodies"] = key(
        "beam",
        None,
        "shape of the payload",
        choices={
            "beam": "a beam with length and radius, or without them a body without shape",
            "box": "a box with edges along the body axes, such as a plate",
            "mesh": "the body in the file of a mesh",
            "bodies": "several convex bodies: rods of any direction, boxes and others",
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
        rule="4 to 32 corners of a convex body; with shape 'mesh'",
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
    material: MaterialName | None = key(
        None,
        None,
        "material of a beam that bends and twists",
        choices={name: m.words for name, m in MATERIALS.items()},
        rule="with length and radius; mass, if it is left out, and inertia come from material and section",
        unset="the payload is rigid, unless it has a bending_stiffness",
        example="pine",
    )
    section: Literal["solid", "tube"] = key(
        "solid", None, "section of a beam", choices={"solid": "a full rod", "tube": "a tube with a wall"}
    )
    wall: Length | None = key(None, "m", "thickness of the wall of a tube", unset="the beam is no tube", example=0.001)
    bending_stiffness: Positive | None = key(
        None, "N m²", "E I of a beam, in both planes", unset="that of material and section", example=115.0
    )
    torsional_stiffness: Positive | None = key(
        None, "N m²", "G J of a beam", rule="with bending_stiffness", unset="that of material and section", example=16.0
    )
    damping: Share | None = key(
        None, "1", "damping ratio of a beam's modes", unset="that of the material", example=0.01
    )
    modes: Annotated[int, Field(ge=1, le=12)] = key(
        6, "1", "elastic modes that are flown, the lowest ones", source="two of bending in each plane, torsion, and one"
    )
    drag_area: Areas | None = key(
        None,
        "m²",
        "area A seen along each body axis; drag in moving air is ½ ρ c A v²",
        unset="that of the shape, or none",
        example=[0.2, 0.008, 0.2],
    )
    drag_coefficient: Size = key(1.0, "1", "drag coefficient c", source="chosen: a bluff body")
    bodies: tuple[Body, ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _mass_of_material(cls, data: Any) -> Any:
        """Put in the mass of a beam of a material whose mass is left out."""
        if not isinstance(data, dict) or data.get("mass") is not None or data.get("material") not in MATERIALS:
            return data
        length, radius, wall = (data.get(name, other) for name, other in (("length", 0), ("radius", 0), ("wall", 0)))
        if not all(type(x) in (int, float) and x >= 0.0 for x in (length, radius, wall)) or not length * radius:
            return data  # which is refused by itself
        section = RoundSection(radius, max(radius - wall, 0.0) if wall else 0.0)
        return {**data, "mass": MATERIALS[data["material"]].density * section.area * length}

    @model_validator(mode="after")
    def _complete(self) -> Payload:
        self._check_beam()
        for shape, names in OWN.items():
            for name in names:
                if shape != self.shape and getattr(self, name) not in (None, ()):
                    given = f"{name} = {shown(getattr(self, name))}"
                    raise must("payload", f'have no {given} with shape = "{self.shape}", or shape must be "{shape}"')
        if self.mesh_scale != 1.0:
            raise must("payload", f"have no mesh_scale = {shown(self.mesh_scale)} without mesh")
        if self.shape == "box" and self.size is None:
            raise must("payload", 'have size with shape = "box": its edges along the body axes [m]')
        if self.shape == "mesh" and (self.corners is None or self.inertia is None):
            raise must("payload", 'have mesh and density with shape = "mesh", or corners, mass and inertia')
        if self.shape == "bodies" and (not self.bodies or self.inertia is None):
            raise must("payload", 'have one table of bodies or more with shape = "bodies"')
        if self.corners is not None:
            check_corners(self.corners)
        if self.shape == "beam" and self.inertia is None and (self.length is None or self.radius is None):
            raise must("payload", "have either inertia, or length and radius (of a beam)")
        if any(self.products):
            least, middle, most = np.linalg.eigvalsh(self.tensor)
            if least <= 0.0 or least + middle < most * (1.0 - 1e-9):
                moments = f"{least:.4g}, {middle:.4g}, {most:.4g} kg m²"
                raise must("payload", f"have products of inertia of a body; its principal moments would be {moments}")
        return self

    def _check_beam(self) -> None:
        """Refuse a beam that bends without what its modes need, and keys of such a beam on a rigid one."""
        if (self.section == "tube") != (self.wall is not None):
            raise must("payload", 'have wall with section = "tube", and only with it')
        if self.wall is not None and self.radius is not None and self.wall >= self.radius:
            raise must("payload", f"have a wall below the radius, and not {shown(self.wall)} of {shown(self.radius)} m")
        if (self.bending_stiffness is None) != (self.torsional_stiffness is None):
            raise must("payload", "have bending_stiffness and torsional_stiffness together")
        if self.damping is not None and not self.is_elastic:
            raise must("payload", "have no damping without material or bending_stiffness")
        if not self.is_elastic or self.shape != "beam":
            return
        if self.length is None or self.radius is None:
            raise must("payload", "have length and radius if the beam bends")
        if self.inertia is not None or any((*self.products, *self.center_of_mass)):
            raise must("payload", "have no inertia, products or center_of_mass if the beam bends: they come from it")

    @property
    def is_elastic(self) -> bool:
        """Whether it is a beam that bends and twists."""
        return self.material is not None or self.bending_stiffness is not None

    @property
    def round_section(self) -> RoundSection:
        """The section of a beam."""
        _, radius = self._rod
        return RoundSection(radius, 0.0 if self.wall is None else radius - self.wall)

    @property
    def stiffnesses(self) -> tuple[float, float]:
        """E I and G J of a beam [N m²]; 0 of a rigid one."""
        made, I = MATERIALS.get(self.material or ""), self.round_section.second_moment  # noqa: E741
        bending, torsional = (0.0, 0.0) if made is None else (made.E * I, 2.0 * made.G * I)
        return self.bending_stiffness or bending, self.torsional_stiffness or torsional

    @property
    def beam_damping(self) -> float:
        """The damping ratio of the modes of a beam."""
        made = MATERIALS.get(self.material or "")
        return self.damping if self.damping is not None else made.damping if made else DAMPING

    @property
    def _rod(self) -> tuple[float, float]:
        """Length and radius [m] of a beam; 0 for one that it does not have."""
        return (self.length or 0.0, self.radius or 0.0)

    @property
    def moments(self) -> Triple:
        """Jx, Jy, Jz [kg m²]: as given, of an even box, or of an even cylinder along y, a thin rod if slender."""
        if self.inertia is not None:
            return self.inertia
        if self.size is not None:
            x, y, z = (self.mass * side**2 / 12.0 for side in self.size)
            return (y + z, x + z, x + y)
        length, radius = self._rod
        across, around = self.mass * length**2 / 12.0, self.mass * self.round_section.gyration_squared
        if length < 2.0 * SLENDER * radius or self.is_elastic or self.wall is not None:
            across += around
        return (across, 2.0 * around, across)

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
        if self.hulls:
            x, y, z = map(sum, zip(*[hull.areas for hull in self.hulls], strict=True))
            return x, y, z
        length, radius = self._rod
        return (2.0 * radius * length, math.pi * radius**2, 2.0 * radius * length)

    @property
    def hulls(self) -> tuple[ConvexHull, ...]:
        """The convex hull of a box, a mesh or every body, from the payload's origin; none of any other payload."""
        if self.size is not None:
            return (box_hull(self.size),)
        return tuple(body.hull for body in self.bodies) if self.corners is None else (convex_hull(self.corners),)

    @property
    def box(self) -> tuple[Array, Array]:
        """The lowest and the highest corner of the shape [m], body axes, from the payload's origin (3 each)."""
        if self.hulls:
            corners = np.concatenate([hull.corners for hull in self.hulls])
            return corners.min(axis=0), corners.max(axis=0)
        length, radius = self._rod
        half = np.array([radius, 0.5 * length, radius])
        return -half, half

    @property
    def span(self) -> float | None:
        """Length along body y [m]: of a beam, or twice the largest distance of a hull from the origin, or None."""
        return 2.0 * max(float(np.abs(hull.corners[:, 1]).max()) for hull in self.hulls) if self.hulls else self.length

    @property
    def outline(self) -> Array:
        """Points of lines that show the shape (n, 3) [m], from its origin; NaN between two lines.

        The axis of a beam, the edges of hulls, or a single point.
        """
        if self.hulls:
            ends = np.concatenate([hull.corners[hull.edges] for hull in self.hulls])
            return np.concatenate([ends, np.full((len(ends), 1, 3), np.nan)], axis=1).reshape(-1, 3)
        half = 0.5 * (self.length or 0.0)
        return np.array([[0.0, -half, 0.0], [0.0, half, 0.0]])[: 2 if half else 1]
