"""Contact in a MuJoCo model: the shapes of the contact laws, in pairs with floor and walls.

With a small impedance d, MuJoCo's contact constraint (Computation: Parameters) is a spring and damper:
f = (−b v − k r − a)/R with R = (1 − d)/d Â. Its inertia 1/R is a ten-thousandth of the vehicle's effective inertia at
the contact, so a foot of stiffness K sinks by exactly f/K. Friction is MuJoCo's own: a sticking foot creeps by
micrometres per second.

To the floor, rotors and guards are flat ellipsoids; to walls, guards and the rotors out of them are spheres; the beam
is a capsule to both, a box a box, and a mesh its convex hull.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.engines.models.mujoco_import import mujoco
from tandemlift.parts.contact.corridor import WallTable
from tandemlift.parts.contact.feet import Floor
from tandemlift.parts.contact.hull import Ellipsoids, Hull
from tandemlift.parts.contact.spheres import RotorSpheres
from tandemlift.parts.contact.walls import Beam, Walls
from tandemlift.parts.mechanics.vehicle import Vehicle

IMPEDANCE = 1e-4  # impedance d of contacts, MuJoCo's smallest: almost a pure spring and damper
STICKING = 0.2  # fraction of a foot's sliding speed that friction below its limit removes in one step
POINT = 1e-4  # m, radius of the sphere that represents a foot's ball joint
GROUND = "ground"  # the floor, for everything but feet
WALL_THICKNESS = 1e-4  # m, thickness of a wall
KINDS = mujoco.mjtGeom
HULL = "hull"  # begins the names of a payload's box, mesh or bodies
WALL_HEIGHT = 1e3  # m, height of the walls, which reach below any floor


def _add_shape(body: Any, name: str, kind: Any, **attributes: Any) -> None:
    """Add a massless shape that collides only with the shapes that it is paired with."""
    body.add_geom(name=name, type=kind, mass=0.0, contype=0, conaffinity=0, **attributes)


def _add_contact_pair(spec: Any, one: str, other: str, friction: float) -> None:
    """Let two shapes collide, with friction unless its coefficient is zero."""
    flat = [friction, friction, 1.0, 1.0, 1.0]
    spec.add_pair(
        name=f"{one} {other}",
        geomname1=one,
        geomname2=other,
        condim=3 if friction else 1,
        friction=flat,
        solimp=[IMPEDANCE, IMPEDANCE, 1.0, 0.5, 1.0],
    )


class VehicleShapes(NamedTuple):
    """The names of the vehicle's contact shapes: feet; others that touch the floor; those that touch walls."""

    feet: list[str]
    on_floor: list[str]
    on_walls: list[str]


def add_vehicle_shapes(spec: Any, floor: Any, walls: Any, vehicle: Vehicle) -> VehicleShapes:
    """Add the shapes of the vehicle: balls at the feet's joints, ellipsoids, spheres, and the shape of the payload.

    Args:
        spec: the `mujoco.MjSpec`.
        floor: a `parts.contact.feet.Floor`, or `Absent`.
        walls: a `parts.contact.walls.Walls`, or `Absent`.
        vehicle: the vehicle.
    """
    shapes = VehicleShapes([], [], [])
    hull = floor.hull if isinstance(floor, Floor) else None
    if isinstance(floor, Floor):
        _add_feet(spec, floor, vehicle, shapes.feet)
    if isinstance(hull, Hull):
        _add_discs(spec, hull, vehicle, shapes.on_floor)
        if isinstance(hull.beam, Ellipsoids) and vehicle.beam:
            _add_beam(spec, np.array(hull.beam.center).T, hull.beam.radius[0])
            shapes.on_floor.append("beam")
    if isinstance(hull, Hull) or isinstance(walls, Walls):
        names = _add_bodies(spec, vehicle)
        shapes.on_floor.extend(names * isinstance(hull, Hull))
        shapes.on_walls.extend(names * isinstance(walls, Walls))
    if isinstance(walls, Walls):
        _add_spheres(spec, walls, vehicle, shapes.on_walls)
        if isinstance(walls.beam, Beam):
            if "beam" not in shapes.on_floor:
                ends = np.array([[0.0, end, 0.0] for end in walls.beam.ends]) + vehicle.origin
                _add_beam(spec, ends, walls.beam.radius)
            shapes.on_walls.append("beam")
    return shapes


def _add_feet(spec: Any, floor: Floor, vehicle: Vehicle, names: list[str]) -> None:
    """Add a small sphere at the ball joint of every foot; the pads' radius is left out of it and of the floor."""
    centers = np.array(floor.feet).transpose(2, 0, 1)  # (N, 4, 3)
    for i, (feet, center) in enumerate(zip(centers, vehicle.lever_arms, strict=True), 1):
        for j, place in enumerate(feet - center, 1):
            names.append(f"quadrotor{i} foot{j}")
            _add_shape(spec.body(f"quadrotor{i}"), names[-1], KINDS.mjGEOM_SPHERE, size=[POINT, 0.0, 0.0], pos=place)


def _add_discs(spec: Any, hull: Hull, vehicle: Vehicle, names: list[str]) -> None:
    """Add every rotor and guard as a flat ellipsoid."""
    for part, discs, each in (("rotor", hull.rotors, 4), ("ring", hull.guards, 1)):
        centers = np.array(discs.center).T
        for k, (center, radius, half) in enumerate(zip(centers, discs.radius, discs.half_thickness, strict=True)):
            i, j = divmod(k, each)
            names.append(f"quadrotor{i + 1} {part}{j + 1} disc" if each > 1 else f"quadrotor{i + 1} {part}")
            _add_shape(
                spec.body(f"quadrotor{i + 1}"),
                names[-1],
                KINDS.mjGEOM_ELLIPSOID,
                size=[radius, radius, half],
                pos=center - vehicle.lever_arms[i],
            )


def _add_spheres(spec: Any, walls: Walls, vehicle: Vehicle, names: list[str]) -> None:
    """Add a sphere around each quadrotor, and one around each rotor that stands out of its guard."""
    for i, radius in enumerate(walls.guards, 1):
        names.append(f"quadrotor{i} guard")
        _add_shape(spec.body(f"quadrotor{i}"), names[-1], KINDS.mjGEOM_SPHERE, size=[radius, 0.0, 0.0])
    if isinstance(walls.rotors, RotorSpheres):
        for k, (hub, radius) in enumerate(zip(np.array(walls.rotors.hub).T, walls.rotors.radius, strict=True)):
            i, j = divmod(k, 4)
            if radius:
                names.append(f"quadrotor{i + 1} rotor{j + 1} sphere")
                place, size = hub - vehicle.lever_arms[i], [radius, 0.0, 0.0]
                _add_shape(spec.body(f"quadrotor{i + 1}"), names[-1], KINDS.mjGEOM_SPHERE, size=size, pos=place)


def _add_beam(spec: Any, ends: Array, radius: float) -> None:
    """Add a capsule between two ends (2, 3) [m, body axes]."""
    size = [radius, 0.0, 0.0]
    _add_shape(spec.body("payload"), "beam", KINDS.mjGEOM_CAPSULE, size=size, fromto=ends.ravel())


def hull_name(k: int) -> str:
    """The name of a payload's hull k, from 0, as a mesh and as a shape."""
    return f"{HULL}{k + 1}" if k else HULL


def _add_bodies(spec: Any, vehicle: Vehicle) -> list[str]:
    """Add a box, or the convex hulls of a mesh or of bodies, with their origin at the payload's; their names."""
    names, size = [hull_name(k) for k in range(len(vehicle.payload.hulls))], vehicle.payload.size
    for name in names:
        kind = KINDS.mjGEOM_MESH if size is None else KINDS.mjGEOM_BOX
        attributes: dict[str, Any] = {"meshname": name} if size is None else {"size": 0.5 * np.array(size)}
        _add_shape(spec.body("payload"), name, kind, pos=vehicle.origin, **attributes)
    return names


def add_floor(spec: Any, floor: Floor, shapes: VehicleShapes) -> None:
    """Add the floor twice: to the feet, whose radius is left out, and to everything else."""
    flat = {"floor": (floor.height + floor.radius - POINT, shapes.feet), GROUND: (floor.height, shapes.on_floor)}
    for name, (height, parts) in flat.items():
        if parts:
            place = [0.0, 0.0, height]
            _add_shape(spec.worldbody, name, KINDS.mjGEOM_PLANE, size=[0.0, 0.0, 1.0], pos=place)
        for part in parts:
            _add_contact_pair(spec, name, part, floor.friction)


def add_walls(spec: Any, walls: Walls, upright: Sequence[WallTable], shapes: VehicleShapes) -> None:
    """Add walls as thin boxes."""
    for k, wall in enumerate(upright, 1):
        (x1, y1), (x2, y2), along = wall.start, wall.end, np.subtract(wall.end, wall.start)
        turn = np.arctan2(along[1], along[0]) / 2.0
        box: dict[str, Any] = {
            "pos": [(x1 + x2) / 2.0, (y1 + y2) / 2.0, wall.top - WALL_HEIGHT / 2.0],
            "size": [np.hypot(*along) / 2.0, WALL_THICKNESS / 2.0, WALL_HEIGHT / 2.0],
            "quat": [np.cos(turn), 0.0, 0.0, np.sin(turn)],
        }
        _add_shape(spec.worldbody, f"wall{k}", KINDS.mjGEOM_BOX, **box)
        for part in shapes.on_walls:
            _add_contact_pair(spec, f"wall{k}", part, walls.springs.friction)


def set_contact_stiffness(model: Any, floor: Any, walls: Any) -> None:
    """Set stiffness [N/m] and damping [N·s/m] of every contact pair, from the contact parameters of floor and walls."""
    feet, ground = (mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name) for name in ("floor", GROUND))
    for p in range(model.npair):
        shapes = int(model.pair_geom1[p]), int(model.pair_geom2[p])
        side = floor if feet in shapes else floor.hull if ground in shapes else walls.springs
        part = max(shapes, key=lambda shape: model.geom_bodyid[shape])  # the other is fixed to the world
        R_d = (1.0 - IMPEDANCE) * model.body_invweight0[model.geom_bodyid[part], 0]
        model.pair_solref[p] = -np.array([side.stiffness, side.damping]) * R_d
        model.pair_solreffriction[p] = [-1.0, -STICKING / model.opt.timestep * IMPEDANCE]


def touching_parts(model: Any) -> dict[tuple[int, int], tuple[str, str, int]]:
    """Of every pair of shapes (ascending ids) whose contact is a touch: surface, kind and index (`engines.touches`)."""
    found = {}
    for pair in zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True):
        one, other = (model.geom(shape).name for shape in pair)
        surface, part = (one, other) if one in ("floor", GROUND) or one.startswith("wall") else (other, one)
        if surface == "floor":
            continue
        numbers = [int("".join(filter(str.isdigit, word))) for word in part.split() if word[-1].isdigit()]
        kind = "beam" if part.startswith(("beam", HULL)) else "rotor" if " rotor" in part else "guard"
        index = 4 * (numbers[0] - 1) + numbers[1] - 1 if kind == "rotor" else numbers[0] - 1 if kind == "guard" else 0
        found[min(pair), max(pair)] = "floor" if surface == GROUND else "wall", kind, index
    return found
