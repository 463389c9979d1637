"""Looks of a vehicle and its surroundings: boxes, spheres and cylinders, which every simulator has, their colours, and
the cameras that view them.

The hull of a mesh is one more, of triangles; where there are none, its edges are drawn as cylinders.

Front parts are orange and rear parts blue, so that each quadrotor's heading is visible. Pictures, the live page,
MuJoCo, Gazebo and RViz draw this one list.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.errors import InputError, unknown
from tandemlift.core.types import Array
from tandemlift.core.vector import vec3
from tandemlift.parts.mechanics.bodies import ConvexHull
from tandemlift.parts.mechanics.payload import Payload
from tandemlift.parts.mechanics.rotation import rotation_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import Quadrotor

CARBON, METAL, SHELL, WOOD = "#2b2f36", "#8d949e", "#d9dce0", "#c2853f"
FRONT, REAR, JOINT, GUARD = "#e8641b", "#2f6fb0", "#f0b429", "#5b636e"
PUSH_COLOR, WALL = "#d5281b", "#7f8fa3"
BLUR, GLASS = 0.3, 0.35  # opacity of rotors and of walls
SUN = np.array([0.35, -0.42, 0.84]) / np.linalg.norm([0.35, -0.42, 0.84])  # unit vector towards the sun
SHAPELESS = 0.2  # m, edge of the box that represents a payload without length
BEAM_RADIUS = 0.03  # m, of a beam whose radius is not given
EDGE_RADIUS = 0.005  # m, of the edges of a hull
SEGMENTS = 16  # straight pieces of a guard ring
LEVEL = np.eye(3)
SHORTEST_CYLINDER = 1e-6  # m, a shorter cylinder is left out


def rgba_of(color: str, opacity: float = 1.0) -> list[float]:
    """A colour #rrggbb and an opacity as four numbers from 0 to 1."""
    return [*(int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5)), opacity]


def mean_arm(quadrotor: Quadrotor) -> float:
    """Mean distance of the rotors from the quadrotor's centre [m], a measure of its size."""
    return float(np.linalg.norm(quadrotor.rotors, axis=1).mean())


def frame_along(direction: ArrayLike) -> Array:
    """A rotation (3 × 3) whose third column points along a direction."""
    z = np.asarray(direction, dtype=float)
    z = z / np.linalg.norm(z)
    x = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


class VisualShape(NamedTuple):
    """A named shape.

    Attributes:
        name: unique among the shapes of its link.
        kind: `box`, `sphere`, `cylinder` (along its z) or `hull`.
        size: edges of a box (3), radius of a sphere (1), radius and length of a cylinder (2), corners of a hull's
            triangles, counterclockwise from outside (9 each) [m].
        position: of its centre [m] (3).
        axes: rotation (3 × 3).
        color: #rrggbb.
        opacity: 1 for an opaque shape.
    """

    name: str
    kind: Literal["box", "sphere", "cylinder", "hull"]
    size: tuple[float, ...]
    position: Array
    axes: Array = LEVEL
    color: str = SHELL
    opacity: float = 1.0


def cylinder(name: str, start: ArrayLike, end: ArrayLike, radius: float, color: str) -> list[VisualShape]:
    """A cylinder from one point to another; none if the points coincide."""
    a, b = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    length = float(np.linalg.norm(b - a))
    if length < SHORTEST_CYLINDER:
        return []
    return [VisualShape(name, "cylinder", (radius, length), (a + b) / 2.0, frame_along(b - a), color)]


def _box(name: str, center: ArrayLike, edges: ArrayLike, color: str) -> VisualShape:
    x, y, z = np.asarray(edges, dtype=float).tolist()
    return VisualShape(name, "box", (x, y, z), np.asarray(center, dtype=float), LEVEL, color)


def hull_shapes(hull: ConvexHull, *, solid: bool) -> list[VisualShape]:
    """A convex hull as one shape, or its edges."""
    if solid:
        corners = hull.corners[hull.triangles].ravel().tolist()
        return [VisualShape("payload", "hull", tuple(corners), np.zeros(3), LEVEL, WOOD)]
    ends = enumerate(hull.corners[hull.edges], 1)
    return [piece for k, (a, b) in ends for piece in cylinder(f"edge_{k}", a, b, EDGE_RADIUS, WOOD)]


def body_shapes(payload: Payload, *, solid: bool) -> list[VisualShape]:
    """Each of several bodies: a rod, a box, or any other as by `hull_shapes`; their names begin with their number."""
    shapes = list[VisualShape]()
    for k, body in enumerate(payload.bodies, 1):
        if body.ends is not None and body.radius is not None:
            own = cylinder("rod", *body.ends, body.radius, WOOD)
        elif body.size is not None:
            axes = np.array(rotation_from_euler(vec3(body.euler)))
            own = [_box("box", body.position, body.size, WOOD)._replace(axes=axes)]
        else:
            own = hull_shapes(body.hull, solid=solid)
        shapes += [shape._replace(name=f"body_{k}_{shape.name}") for shape in own]
    return shapes


def payload_shapes(payload: Payload, quadrotors: tuple[Quadrotor, ...], *, solid: bool = True) -> list[VisualShape]:
    """The payload about its origin: a beam with end caps, a box or a hull, and struts to joints that lie beside it.

    Not `solid`: a hull is drawn as its edges.
    """
    low, high = payload.box
    if payload.bodies:
        shapes = body_shapes(payload, solid=solid)
    elif payload.hulls and payload.size is None:
        shapes = hull_shapes(payload.hulls[0], solid=solid)
    elif payload.size is not None:
        shapes = [_box("payload", np.zeros(3), payload.size, WOOD)]
    elif not payload.length:
        shapes = [_box("payload", np.zeros(3), [SHAPELESS] * 3, WOOD)]
    else:
        radius, half = payload.radius or BEAM_RADIUS, payload.length / 2.0
        low, high = np.array([0.0, -half, 0.0]), np.array([0.0, half, 0.0])
        shapes = cylinder("beam", [0.0, -half, 0.0], [0.0, half, 0.0], radius, WOOD)
        for i, end in enumerate((half, -half), 1):
            cap = 0.25 * radius
            shapes += cylinder(f"cap_{i}", [0.0, end - cap, 0.0], [0.0, end + cap, 0.0], 1.1 * radius, CARBON)
    for i, q in enumerate(quadrotors, 1):
        joint = q.joint_position
        shapes += cylinder(f"strut_{i}", np.clip(joint, low, high), joint, 0.072 * mean_arm(q), METAL)
    return shapes


def vehicle_shapes(vehicle: Vehicle, *, solid: bool = True) -> list[VisualShape]:
    """A whole vehicle, as by `payload_shapes`; positions are relative to the system's centre of mass."""
    payload, depth = vehicle.origin, float(vehicle.payload.box[1][2])
    placed = [(shape, payload) for shape in payload_shapes(vehicle.payload, tuple(vehicle.quadrotors), solid=solid)]
    for q, center in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        placed += [(shape, center) for shape in quadrotor_shapes(q, depth)]
    return [shape._replace(position=shape.position + at) for shape, at in placed]


def quadrotor_shapes(q: Quadrotor, depth: float) -> list[VisualShape]:
    """One quadrotor; positions are relative to its centre of mass.

    Args:
        q: the quadrotor.
        depth: of the joint below the payload's surface [m]; the sensor's collar is at the surface.
    """
    own = [*_hull(mean_arm(q)), *_rotors(q), *_ring(q), *_legs(q)]
    if q.heading:
        turn = rotation_about_z(q.heading)
        own = [shape._replace(position=turn @ shape.position, axes=turn @ shape.axes) for shape in own]
    return [*_mount(q, depth), *own]


def rotation_about_z(angle: float) -> Array:
    """The rotation (3 × 3) about z by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _mount(q: Quadrotor, depth: float) -> list[VisualShape]:
    """The strut to the joint, and the sensor's collar where the strut leaves the payload."""
    s, joint = mean_arm(q), np.subtract(q.joint_position, q.position)
    length = float(np.linalg.norm(joint))
    if length < SHORTEST_CYLINDER:
        return []
    first = min(depth, 0.8 * length)
    start, end = joint * (1.0 - first / length), joint * (1.0 - min(first + 0.16 * s, length) / length)
    return cylinder("strut", joint, np.zeros(3), 0.09 * s, METAL) + cylinder("sensor", start, end, 0.16 * s, JOINT)


def _hull(s: float) -> list[VisualShape]:
    """A long body with a deck; nose and tail in the colours of front and rear."""
    return [
        _box("hull", [0.0, 0.0, 0.02 * s], [0.84 * s, 0.4 * s, 0.2 * s], SHELL),
        _box("deck", [0.0, 0.0, 0.16 * s], [0.5 * s, 0.3 * s, 0.1 * s], CARBON),
        _box("nose", [0.46 * s, 0.0, 0.02 * s], [0.1 * s, 0.3 * s, 0.14 * s], FRONT),
        _box("tail", [-0.46 * s, 0.0, 0.02 * s], [0.1 * s, 0.3 * s, 0.14 * s], REAR),
    ]


def _rotors(q: Quadrotor) -> list[VisualShape]:
    """Arms up to the guard, motors, hubs, blades and rotor discs."""
    s, shapes = mean_arm(q), list[VisualShape]()
    for j, (x, y) in enumerate(q.own_rotors, 1):
        color, reach = FRONT if x > 1e-9 else REAR, max(float(np.hypot(x, y)), 1e-9)
        low, mid, hub, high = (np.array([x, y, z * s]) for z in (-0.05, 0.12, 0.2, 0.24))
        tip = np.array([x, y, 0.0]) * max(q.guard_radius / reach, 1.0)
        shapes += cylinder(f"arm_{j}", np.zeros(3), tip, 0.05 * s, CARBON)
        shapes += cylinder(f"motor_{j}", low, mid, 0.1 * s, METAL)
        shapes += cylinder(f"hub_{j}", mid, high, 0.05 * s, color)
        blades = (1.9 * q.rotor_radius, 0.16 * q.rotor_radius, 0.02 * q.rotor_radius)
        shapes.append(VisualShape(f"blades_{j}", "box", blades, hub, rotation_about_z(0.7 + j), CARBON))
        shapes.append(VisualShape(f"rotor_{j}", "cylinder", (q.rotor_radius, 0.01 * s), hub, LEVEL, color, BLUR))
    return shapes


def _ring(q: Quadrotor) -> list[VisualShape]:
    """The guard as a ring of cylinders, at the radius of the sphere that touches walls."""
    s, turn = mean_arm(q), np.linspace(0.0, 2.0 * np.pi, SEGMENTS + 1)
    radius, height = q.guard_radius / np.cos(np.pi / SEGMENTS), np.full(SEGMENTS + 1, 0.02 * s)
    corners = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])
    return [
        piece
        for k, (a, b) in enumerate(pairwise(corners), 1)
        for piece in cylinder(f"guard_{k}", a, b, 0.035 * s, GUARD)
    ]


def _legs(q: Quadrotor) -> list[VisualShape]:
    s, shapes = mean_arm(q), list[VisualShape]()
    for j, (x, y) in enumerate(((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)), 1):
        foot = np.array([q.feet_spread * x, q.feet_spread * y, 0.03 * s - q.feet_depth])
        shapes += cylinder(f"leg_{j}", foot * [0.55, 0.55, 0.0], foot, 0.03 * s, CARBON)
        shapes.append(VisualShape(f"foot_{j}", "sphere", (0.05 * s,), foot, LEVEL, CARBON))
    return shapes


def wall_shape(wall: Mapping[str, Any]) -> VisualShape:
    """A wall as a thin box, from its table in the scene: `size` (3), `center` (3) [m, world axes], `heading` [rad]."""
    axes = rotation_about_z(wall["heading"])
    return VisualShape("wall", "box", tuple(wall["size"]), np.array(wall["center"]), axes, WALL, GLASS)


# ---- Cameras: the directions from which a vehicle is viewed, by name or by angles


@dataclass(frozen=True)
class Camera:
    """The direction from which the vehicle is viewed.

    Attributes:
        azimuth: of the camera as seen from the vehicle [deg].
        elevation: likewise [deg].
        follows: whether the camera follows the vehicle; otherwise it is fixed and shows the whole path.
        distance: of a following camera [m]; if not given, the vehicle fills the picture.
    """

    azimuth: float
    elevation: float
    follows: bool = True
    distance: float | None = None


CAMERAS = {
    "follow": Camera(-52.0, 17.0),
    "overview": Camera(-64.0, 27.0, follows=False),
    "front": Camera(0.0, 8.0),
    "side": Camera(-90.0, 8.0),
    "top": Camera(180.0, 89.0),
}


def camera_of(text: str) -> Camera:
    """A camera by name, or by AZIMUTH,ELEVATION[,DISTANCE] in degrees and metres.

    Raises:
        InputError: it is neither.
    """
    if text in CAMERAS:
        return CAMERAS[text]
    parts = text.split(",")
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        raise unknown("camera", text, [*CAMERAS, "AZIMUTH,ELEVATION[,DISTANCE]"]) from None
    sound = len(numbers) in (2, 3) and all(map(np.isfinite, numbers))
    if not sound or not 2.0 <= numbers[1] <= 89.0 or not 0.2 <= (*numbers, 1.0)[2] <= 1000.0:
        raise InputError(
            f"camera {text!r} must be AZIMUTH,ELEVATION[,DISTANCE]: degrees from x to y, degrees above the horizon "
            "from 2 to 89, and metres from 0.2 to 1000, such as -55,20,4"
        )
    return Camera(numbers[0], numbers[1], distance=numbers[2] if len(numbers) == 3 else None)
