"""A mission as a world of Gazebo 11: SDF 1.7, of boxes, spheres and cylinders alone.

The model `tandemlift` has its frame at the centre of mass of the system and its axes along the body axes; so have its
links, `payload` and `quadrotor_1` …, each at its part's centre of mass. `joint_1` … are fixed joints from the payload
(parent) to the quadrotors (child), each where that quadrotor is fixed.

Shapes touch what they touch in our contact laws: feet the floor, guards and the beam the walls. Each pair has the
stiffness and damping of these laws, which are the vehicle's: floor and walls are stiff (`HARD`), and Gazebo puts the
two in series. Friction is Gazebo's own, of the same coefficient.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.vector import vec3
from tandemlift.common.types import Array
from tandemlift.laws.mechanics.contact import Floor
from tandemlift.laws.mechanics.rotation import quaternion_from_euler, rotation_from_quaternion
from tandemlift.laws.mechanics.walls import Beam, Walls
from tandemlift.models.sensor_frames import Link, links_of
from tandemlift.models.surroundings import feet_and_floor_from, floor_from, wall_contact_from
from tandemlift.models.visuals import ALONG_Y, LEVEL, VisualShape, payload_shapes, quadrotor_shapes
from tandemlift.rendering.camera import CAMERAS
from tandemlift.rendering.light import SUN
from tandemlift.rendering.stage import GLASS, WALL
from tandemlift.settings import Mission, WallTable
from tandemlift.vehicle import Vehicle

Element = ElementTree.Element

MODEL = "tandemlift"
PLUGIN, OVER_ROS = "libtandemlift_gazebo.so", "libtandemlift_gazebo_ros.so"
FLOOR_BIT, WALL_BIT = 1, 2  # of collide_bitmask: what has none in common does not touch
HARD = 1e15  # N/m, of floor and walls: the vehicle's own stiffness is next to nothing beside it
CREEP = 1e-7  # (m/s)/N, of what holds by friction: without it ODE's exact solver fails on more feet than are needed
CORRECTED = 0.8  # share of a joint's gap that is closed in a step: what holds quadrotors on a curve lags the less
FASTEST = 100.0  # m/s, at which contacts may push apart; Gazebo's own 0.01 m/s would cut their springs
THIN, SHOWN = 1e-4, 0.02  # m, thickness of a wall that touches, and of one to look at
MESH, BROAD, RAISED = 1.0, 0.015, 5e-4  # m, between the lines on the floor, their width, and their height over it
BURIED = 0.1  # m, how far walls go into the floor
MARGIN = 15.0  # m, of the floor that is shown around all there is
GROUND, LINE, SKY, AMBIENT = "#b9bdc3", "#9ba0a8", "#dbe6f2", "#595959"
DIGITS = 6  # after the point, in m and rad, of what is only looked at
FAR = 3.5  # reaches of the vehicle, from where the eye looks at it first


def world(mission: Mission, plugin: int | str | None = None) -> str:
    """The text of a mission's world.

    Args:
        mission: its vehicle, start, floor, walls and step.
        plugin: of the plugin that carries rotor forces in and states out, the UDP port, or "ros" for the one that is
            led over ROS 1; without it, there is no plugin.

    Raises:
        InputError: its true vehicle cannot be a model (`links_of`).
    """
    vehicle = Vehicle.from_settings(mission.vehicle)
    root = Element("sdf", version="1.7")
    top = _add(root, "world", name="default")
    _surroundings(top, mission, vehicle)
    if mission.ground.model != "none":
        _add_floor(top, floor_from(mission, vehicle), mission)
    if mission.all_walls:
        _add_walls(top, mission, floor_from(mission, vehicle))
    _add_vehicle(top, mission, vehicle, plugin)
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, "unicode")}\n'


def numbers(values: ArrayLike, digits: int | None = None) -> str:
    """Numbers with a space between, each with the digits that bring the same float64 back, or rounded to so many."""
    flat = np.ravel(np.asarray(values, dtype=float))
    return " ".join(repr(float(v) + 0.0) for v in (flat if digits is None else np.round(flat, digits)))


def euler_of(R: Array) -> Array:
    """Roll, pitch, yaw (3) of R = Rz(yaw) Ry(pitch) Rx(roll), which SDF has [rad]; ours are another three."""
    yaw = np.arctan2(R[1, 0], R[0, 0])
    c, s = np.cos(yaw), np.sin(yaw)  # with R turned back by any such yaw, the rest is exact, at 90° of pitch too
    roll = np.arctan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return np.array([roll, np.arctan2(-R[2, 0], c * R[0, 0] + s * R[1, 0]), yaw])


def _add(parent: Element, tag: str, text: str | int | None = None, **attributes: str) -> Element:
    child = ElementTree.SubElement(parent, tag, attributes)
    child.text = None if text is None else str(text)
    return child


def _fill(parent: Element, content: dict[str, Any]) -> None:
    """Children by name: numbers, text, or children of their own."""
    for tag, value in content.items():
        if isinstance(value, dict):
            _fill(_add(parent, tag), value)
        else:
            _add(parent, tag, value if isinstance(value, (str, int)) else numbers(value))


def _pose(parent: Element, position: ArrayLike, R: Array = LEVEL, digits: int | None = None) -> None:
    _add(parent, "pose", numbers([*np.asarray(position, dtype=float), *euler_of(R)], digits))


def _rgba(color: str, opacity: float = 1.0) -> str:
    return numbers([*(int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5)), opacity], 3)


def _surroundings(top: Element, mission: Mission, vehicle: Vehicle) -> None:
    """Gravity, the steps of the physics, light, and the eye."""
    step = mission.mission.step
    _fill(top, {"gravity": [0.0, 0.0, -GRAVITY]})
    physics = _add(top, "physics", name="ode", type="ode", default="1")
    _fill(physics, {"max_step_size": step, "real_time_factor": 1.0, "real_time_update_rate": 1.0 / step})
    contact: dict[str, float] = {
        "cfm": 0.0,
        "erp": CORRECTED,
        "contact_max_correcting_vel": FASTEST,
        "contact_surface_layer": 0.0,
    }
    _fill(physics, {"ode": {"solver": {"type": "world"}, "constraints": contact}})  # exact, and fast for so few bodies
    _fill(top, {"scene": {"ambient": _rgba(AMBIENT), "background": _rgba(SKY), "shadows": "true", "grid": "false"}})
    light = _add(top, "light", name="sun", type="directional")
    _pose(light, 20.0 * SUN, digits=DIGITS)
    shining = {"diffuse": _rgba("#d1c7b5"), "specular": _rgba("#333333"), "direction": numbers(-SUN, DIGITS)}
    _fill(light, {"cast_shadows": "true", **shining})
    camera = _add(_add(top, "gui"), "camera", name="user_camera")
    view, reach = CAMERAS["follow"], float(np.linalg.norm(vehicle.lever_arms, axis=1).max()) + 0.5
    azimuth, height = np.radians([view.azimuth, view.elevation])
    back = np.array([np.cos(height) * np.cos(azimuth), np.cos(height) * np.sin(azimuth), np.sin(height)])
    eye = mission.initial.position + FAR * reach * back
    _add(camera, "pose", numbers([*eye, 0.0, height, azimuth + np.pi], DIGITS))
    _add(camera, "view_controller", "orbit")
    near, far = 0.8 * FAR * reach, 1.2 * FAR * reach
    _fill(_add(camera, "track_visual"), {"name": MODEL, "min_dist": near, "max_dist": far, "static": "false"})


def _geometry(parent: Element, kind: str, size: Sequence[float], digits: int | None = None) -> None:
    names = {"box": ["size"], "sphere": ["radius"], "cylinder": ["radius", "length"]}[kind]
    shape = _add(_add(parent, "geometry"), kind)
    for name, values in zip(names, [size] if kind == "box" else [[number] for number in size], strict=True):
        _add(shape, name, numbers(values, digits))


def _look(link: Element, shape: VisualShape) -> None:
    """A visual; what is translucent casts no shadow."""
    visual = _add(link, "visual", name=shape.name)
    _pose(visual, shape.position, shape.axes, DIGITS)
    _geometry(visual, shape.kind, shape.size, DIGITS)
    _paint(visual, shape.color)
    if shape.opacity < 1.0:
        _fill(visual, {"transparency": 1.0 - shape.opacity, "cast_shadows": "false"})


def _paint(visual: Element, color: str) -> None:
    _fill(visual, {"material": {"ambient": _rgba(color), "diffuse": _rgba(color), "specular": _rgba("#1a1a1a")}})


def _touching(link: Element, shape: VisualShape, surface: dict[str, Any]) -> None:
    collision = _add(link, "collision", name=shape.name)
    _pose(collision, shape.position, shape.axes)
    _geometry(collision, shape.kind, shape.size)
    _fill(collision, {"surface": surface})


def _surface(bit: int, friction: float, stiffness: float = HARD, damping: float = 0.0) -> dict[str, Any]:
    """Of what touches with these [N/m, N·s/m], and only what shares the bit."""
    spring = {"kp": stiffness, "kd": damping, "max_vel": FASTEST, "min_depth": 0.0}
    slip = {"mu": friction, "mu2": friction, "slip1": CREEP, "slip2": CREEP}
    return {"contact": {"collide_bitmask": bit, "ode": spring}, "friction": {"ode": slip}}


def _still(top: Element, name: str, position: ArrayLike) -> Element:
    """The link of a model that never moves."""
    model = _add(top, "model", name=name)
    _add(model, "static", "true")
    _pose(model, position)
    return _add(model, "link", name=name)


def _add_floor(top: Element, floor: Floor, mission: Mission) -> None:
    """A level plane; shown below the start and all walls."""
    ends = [end for w in mission.all_walls for end in (w.start, w.end)]
    places = np.array([mission.initial.position[:2], *ends])
    low, high = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
    low, high = np.floor(low / MESH) * MESH, np.ceil(high / MESH) * MESH
    link = _still(top, "floor", [*(low + high) / 2.0, floor.height])
    for kind in ("collision", "visual"):
        part = _add(link, kind, name="floor")
        _fill(part, {"geometry": {"plane": {"normal": [0.0, 0.0, 1.0], "size": high - low}}})
        if kind == "collision":
            _fill(part, {"surface": _surface(FLOOR_BIT, floor.friction)})
        else:
            _paint(part, GROUND)
    for line in _lines(high - low):
        _look(link, line)


def _lines(size: Array) -> Iterator[VisualShape]:
    """Lines on a floor of a size (2) [m] that show how far things are."""
    for i, (along, letter) in enumerate(zip(size[::-1], "xy", strict=True)):
        for k, place in enumerate(np.arange(0.0, size[i] + MESH / 2.0, MESH) - size[i] / 2.0):
            middle, sides = np.array([0.0, 0.0, RAISED]), [BROAD, BROAD, RAISED]
            middle[i], sides[1 - i] = place, along
            yield VisualShape(f"line_{letter}_{k}", "box", (sides[0], sides[1], sides[2]), middle, LEVEL, LINE)


def _add_walls(top: Element, mission: Mission, floor: Floor) -> None:
    """A thin box for each wall; a thicker one to look at."""
    link, surface = _still(top, "walls", np.zeros(3)), _surface(WALL_BIT, mission.ground.friction)
    for k, wall in enumerate(mission.all_walls, 1):
        shape = _wall(f"wall_{k}", wall, floor.height)
        _touching(link, shape, surface)
        _look(link, shape._replace(size=(shape.size[0], SHOWN, shape.size[2])))


def _wall(name: str, wall: WallTable, floor: float) -> VisualShape:
    """A wall as a box, from below the floor to its top."""
    start, along = np.array(wall.start), np.subtract(wall.end, wall.start)
    foot, length = min(floor, wall.top) - BURIED, float(np.hypot(*along))
    turn = np.arctan2(along[1], along[0])
    c, s = np.cos(turn), np.sin(turn)
    middle = np.array([*(start + along / 2.0), (foot + wall.top) / 2.0])
    axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return VisualShape(name, "box", (length, THIN, wall.top - foot), middle, axes, WALL, GLASS)


def _add_vehicle(top: Element, mission: Mission, vehicle: Vehicle, plugin: int | str | None) -> None:
    """The model as the mission starts; it never goes to sleep."""
    model = _add(top, "model", name=MODEL)
    R = np.array(rotation_from_quaternion(quaternion_from_euler(vec3(mission.initial.euler))))
    _pose(model, mission.initial.position, R)
    _fill(model, {"allow_auto_disable": "false", "self_collide": "false"})
    payload, *quadrotors = links_of(mission, vehicle)
    pads, pressing = feet_and_floor_from(mission, vehicle), wall_contact_from(mission, vehicle)
    fleet, depth = vehicle.quadrotors, vehicle.payload.radius or 0.0
    _add_link(model, payload, payload_shapes(vehicle.payload, tuple(fleet)), _beam(pressing), pressing, WALL_BIT)
    for i, (link, q) in enumerate(zip(quadrotors, fleet, strict=True)):
        element = _add_link(model, link, quadrotor_shapes(q, depth), [_guard(pressing, i)], pressing, WALL_BIT)
        for foot in _feet(pads, i, link):
            _touching(element, foot, _surface(FLOOR_BIT, pads.friction, pads.stiffness, pads.damping))
    for i, q in enumerate(fleet, 1):
        joint = _add(model, "joint", name=f"joint_{i}", type="fixed")
        _pose(joint, np.subtract(q.joint_position, q.position))
        _fill(joint, {"parent": "payload", "child": f"quadrotor_{i}"})
    if plugin == "ros":
        _fill(_add(model, "plugin", name="tandemlift", filename=OVER_ROS), {"rotors": rotors_of(vehicle)})
    elif plugin is not None:
        _fill(_add(model, "plugin", name="tandemlift", filename=PLUGIN), {"port": plugin})


def _add_link(
    model: Element, link: Link, looks: Iterable[VisualShape], touching: Iterable[VisualShape], how: Any, bit: int
) -> Element:
    """A body with its weight, its looks, and what of it touches as `how` tells."""
    element = _add(model, "link", name=link.name)
    _pose(element, link.position)
    inertial, J = _add(element, "inertial"), link.inertia
    _fill(inertial, {"mass": link.mass})
    _pose(inertial, link.center)
    parts = {f"i{a}{b}": J["xyz".index(a), "xyz".index(b)] for a, b in ("xx", "xy", "xz", "yy", "yz", "zz")}
    _fill(inertial, {"inertia": parts})
    for shape in touching:
        _touching(element, shape, _surface(bit, how.friction, how.stiffness, how.damping))
    for shape in looks:
        _look(element, shape)
    return element


def _guard(walls: Walls, i: int) -> VisualShape:
    return VisualShape("guard", "sphere", (walls.guards[i],), np.zeros(3))


def _beam(walls: Walls) -> list[VisualShape]:
    """A capsule along y: a cylinder, and a sphere at each end; nothing of a payload without a shape."""
    if not isinstance(walls.beam, Beam):
        return []
    ends, radius = sorted(walls.beam.ends), walls.beam.radius
    middle = VisualShape("beam", "cylinder", (radius, ends[1] - ends[0]), np.zeros(3), ALONG_Y)
    spheres = [
        VisualShape(f"beam_end_{k}", "sphere", (radius,), np.array([0.0, y, 0.0])) for k, y in enumerate(ends, 1)
    ]
    return [middle, *spheres]


def _feet(floor: Floor, i: int, link: Link) -> list[VisualShape]:
    """The balls of a quadrotor's four feet."""
    places = [np.array([foot.x[i], foot.y[i], foot.z[i]]) - link.position for foot in floor.feet]
    return [VisualShape(f"foot_{j}", "sphere", (floor.radius,), place) for j, place in enumerate(places, 1)]


def rotors_of(vehicle: Vehicle) -> Array:
    """(3, 4N) of every rotor: x and y [m] from its quadrotor's centre of mass, signed torque over thrust [m]."""
    places = np.array([place for q in vehicle.quadrotors for place in q.rotors])
    torques = [q.torque_per_thrust * spin for q in vehicle.quadrotors for spin in q.spins]
    return np.array([*places.T, torques])
