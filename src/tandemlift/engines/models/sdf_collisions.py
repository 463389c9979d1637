"""Collision shapes of the vehicle in SDF: those of the contact laws, each with the spring of its contact.

| shape | of | touches | in the laws |
|---|---|---|---|
| `foot_J` | a quadrotor | the floor | `parts.contact.feet`: the sole of a foot |
| `rotor_J`, `guard_ring` | a quadrotor | the floor | `parts.contact.hull`: a flat disc |
| `beam_tip_K` | the payload | the floor | the same: an end of the beam |
| `guard`, `rotor_J_sphere` | a quadrotor | walls | `parts.contact.walls`: a sphere |
| `beam`, `beam_end_K` | the payload | walls | the same: a capsule |
| `beam_box`, `beam_edge_K`, `beam_body_K_…` | the payload | walls | `parts.contact.polyhedron`: a box, edges, bodies |

Gazebo has no flat ellipsoid: a disc is a cylinder of the same radius and thickness, which reaches up to 4 mm farther
where it leans. Shapes without a common bit do not touch, so no shape touches the same surface twice.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Absent
from tandemlift.engines.models.links import Link
from tandemlift.engines.models.scene import Scene, feet_and_floor_from, wall_contact_from
from tandemlift.engines.models.sdf_elements import Element, add, fill, geometry, pose
from tandemlift.engines.models.visuals import VisualShape, body_shapes, frame_along, hull_shapes
from tandemlift.parts.contact.feet import Floor
from tandemlift.parts.contact.hull import Ellipsoids, Hull
from tandemlift.parts.contact.walls import Beam, Walls
from tandemlift.parts.mechanics.payload import Payload
from tandemlift.parts.mechanics.vehicle import Vehicle

FLOOR_BIT, WALL_BIT = 1, 2  # of collide_bitmask
CONTACT_STIFFNESS = 1e15  # N/m, of floor and walls: large compared with the vehicle's stiffness
CREEP = 1e-7  # (m/s)/N, slip of friction: without it ODE's exact solver fails on redundant feet
CORRECTION_SPEED = 100.0  # m/s, limit of contact correction; Gazebo's default of 0.01 m/s would limit the springs


class CollisionSurface(NamedTuple):
    """The contact of a shape: bit of its partners, friction, stiffness [N/m], damping [N·s/m]."""

    bit: int
    friction: float
    stiffness: float = CONTACT_STIFFNESS
    damping: float = 0.0


def add_collision(link: Element, shape: VisualShape, surface: CollisionSurface, points: int | None = None) -> None:
    """Add a shape to a link; `points`: of contact with another shape at most."""
    collision = add(link, "collision", name=shape.name)
    pose(collision, shape.position, shape.axes)
    geometry(collision, shape.kind, shape.size)
    if points is not None:
        add(collision, "max_contacts", points)
    add_surface(collision, surface)


def add_surface(collision: Element, surface: CollisionSurface) -> None:
    """Add a surface to a shape."""
    spring = {"kp": surface.stiffness, "kd": surface.damping, "max_vel": CORRECTION_SPEED, "min_depth": 0.0}
    slip = {"mu": surface.friction, "mu2": surface.friction, "slip1": CREEP, "slip2": CREEP}
    contact = {"collide_bitmask": surface.bit, "ode": spring}
    fill(collision, {"surface": {"contact": contact, "friction": {"ode": slip}}})


class VehicleCollisions:
    """The collision shapes of a mission's vehicle, link by link.

    Args:
        mission: its `plant`, `ground` and step.
        vehicle: the pilot's model of it.
    """

    def __init__(self, scene: Scene, vehicle: Vehicle) -> None:
        self._floor, self._walls = feet_and_floor_from(scene, vehicle), wall_contact_from(scene, vehicle)
        self._payload = vehicle.payload
        floor, hull, walls = self._floor, self._floor.hull, self._walls
        assert isinstance(hull, Hull)
        self._parts = hull
        self._foot = CollisionSurface(FLOOR_BIT, floor.friction, floor.stiffness, floor.damping)
        self._hull = CollisionSurface(FLOOR_BIT, floor.friction, hull.stiffness, hull.damping)
        self._wall = CollisionSurface(WALL_BIT, walls.springs.friction, walls.springs.stiffness, walls.springs.damping)

    def add_to_payload(self, element: Element, link: Link) -> None:
        """Add the shapes of the payload; none if it has no shape."""
        for shape in [*_beam(self._walls), *_body(self._payload)]:
            add_collision(element, shape, self._wall)
        for tip in _shapes(self._parts.beam, "beam_tip", link.position):
            add_collision(element, tip, self._hull)

    def add_to_quadrotor(self, element: Element, link: Link, i: int) -> None:
        """Add the shapes of quadrotor i, from 0."""
        hull, four = self._parts, slice(4 * i, 4 * i + 4)
        add_collision(element, VisualShape("guard", "sphere", (self._walls.guards[i],), np.zeros(3)), self._wall)
        for ball in _rotor_balls(self._walls, four, link.position):
            add_collision(element, ball, self._wall)
        for foot in _feet(self._floor, i, link):
            add_collision(element, foot, self._foot)
        (ring,) = _shapes(hull.guards, "guard_ring", link.position, slice(i, i + 1))
        for disc in (ring._replace(name="guard_ring"), *_shapes(hull.rotors, "rotor", link.position, four)):
            add_collision(element, disc, self._hull, points=1)


def _shapes(shapes: Any, name: str, origin: Array, chosen: slice = slice(None)) -> Iterator[VisualShape]:
    """Flat ellipsoids as cylinders, round ones as spheres, in a link whose frame is at an origin [m, body axes]."""
    if not isinstance(shapes, Ellipsoids):
        return
    rows = list(zip(*shapes.center, shapes.radius, shapes.half_thickness, strict=True))[chosen]
    for j, (x, y, z, radius, half) in enumerate(rows, 1):
        place = np.array([x, y, z]) - origin
        if half < radius:
            yield VisualShape(f"{name}_{j}", "cylinder", (radius, 2.0 * half), place)
        else:
            yield VisualShape(f"{name}_{j}", "sphere", (radius,), place)


def _rotor_balls(walls: Walls, four: slice, origin: Array) -> Iterator[VisualShape]:
    """The spheres of rotors that stand out of their guard, with the numbers of the rotors."""
    if isinstance(walls.rotors, Absent):
        return
    rows = list(zip(*walls.rotors.hub, walls.rotors.radius, strict=True))[four]
    for j, (x, y, z, radius) in enumerate(rows, 1):
        if radius > 0.0:
            yield VisualShape(f"rotor_{j}_sphere", "sphere", (radius,), np.array([x, y, z]) - origin)


def _beam(walls: Walls) -> list[VisualShape]:
    """The capsule of a beam along y: a cylinder and a sphere at each end; none without a beam."""
    if not isinstance(walls.beam, Beam):
        return []
    ends, radius = sorted(walls.beam.ends), walls.beam.radius
    middle = VisualShape("beam", "cylinder", (radius, ends[1] - ends[0]), np.zeros(3), frame_along([0.0, 1.0, 0.0]))
    spheres = [
        VisualShape(f"beam_end_{k}", "sphere", (radius,), np.array([0.0, y, 0.0])) for k, y in enumerate(ends, 1)
    ]
    return [middle, *spheres]


def _body(payload: Payload) -> list[VisualShape]:
    """A box, bodies, or the edges of a convex hull as cylinders, for walls, which are thin."""
    if payload.size is not None:
        return [VisualShape("beam_box", "box", payload.size, np.zeros(3))]
    shapes = body_shapes(payload, solid=False)
    shapes += hull_shapes(payload.hulls[0], solid=False) if payload.corners is not None else []
    return [shape._replace(name=f"beam_{shape.name}") for shape in shapes]


def _feet(floor: Floor, i: int, link: Link) -> Iterator[VisualShape]:
    """The balls of a quadrotor's four feet."""
    for j, foot in enumerate(floor.feet, 1):
        place = np.array([foot.x[i], foot.y[i], foot.z[i]]) - link.position
        yield VisualShape(f"foot_{j}", "sphere", (floor.radius,), place)
