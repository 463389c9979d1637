"""A mission as a world of Gazebo 11: SDF 1.7, made of boxes, spheres and cylinders.

The model `tandemlift` has its frame at the centre of mass of the system and its axes along the body axes; so have its
links, `payload` and `quadrotor_1` …, each at its part's centre of mass. `joint_1` … are fixed joints from the payload
(parent) to the quadrotors (child), at the quadrotors' joint positions.

Contacts are those of the contact laws (`sdf_collisions`). The vehicle has the stiffness and damping of the laws; floor
and walls are hard, and Gazebo combines the two in series. Friction is Gazebo's own, with the same coefficient.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.types import GRAVITY, Array
from tandemlift.core.vector import vec3
from tandemlift.engines.models.links import Link, links_of
from tandemlift.engines.models.scene import Scene, floor_from
from tandemlift.engines.models.sdf_collisions import (
    CORRECTION_SPEED,
    FLOOR_BIT,
    WALL_BIT,
    CollisionSurface,
    VehicleCollisions,
    add_collision,
    add_surface,
)
from tandemlift.engines.models.sdf_elements import Element, add, fill, geometry, numbers, pose, rgba
from tandemlift.engines.models.visuals import (
    CAMERAS,
    GLASS,
    LEVEL,
    SUN,
    WALL,
    VisualShape,
    payload_shapes,
    quadrotor_shapes,
    rotation_about_z,
)
from tandemlift.parts.contact.corridor import WallTable
from tandemlift.parts.contact.feet import Floor
from tandemlift.parts.mechanics.rotation import quaternion_from_euler, rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

MODEL = "tandemlift"
PLUGIN, OVER_ROS = "libtandemlift_gazebo.so", "libtandemlift_gazebo_ros.so"
CORRECTED_SHARE = 0.8  # fraction of a joint's error that is corrected in a step
WALL_THICKNESS, SHOWN_THICKNESS = 1e-4, 0.02  # m, thickness of a wall's collision shape and of its visual
LINE_SPACING, LINE_WIDTH, LINE_HEIGHT = 1.0, 0.015, 5e-4  # m, spacing, width and height of the lines on the floor
WALL_DEPTH = 0.1  # m, depth of the walls below the floor
MARGIN = 15.0  # m, of visible floor around everything
GROUND, LINE, SKY, AMBIENT = "#b9bdc3", "#9ba0a8", "#dbe6f2", "#595959"
DIGITS = 6  # decimals [m, rad] of visuals
VIEW_DISTANCE = 3.5  # distance of the first view, as a multiple of the vehicle's reach


def world(scene: Scene, plugin: int | str | None = None) -> str:
    """The text of a mission's world.

    Args:
        mission: its vehicle, start, floor, walls and step.
        plugin: UDP port of the plugin that exchanges rotor forces and states, or "ros" for the one driven over ROS 1;
            None for no plugin.

    Raises:
        InputError: the true vehicle has no such model (`links_of`).
    """
    vehicle = Vehicle.from_settings(scene.vehicle)
    root = Element("sdf", version="1.7")
    top = add(root, "world", name="default")
    _add_environment(top, scene, vehicle)
    if scene.ground.model != "none":
        _add_floor(top, floor_from(scene, vehicle), scene)
    if scene.all_walls:
        _add_walls(top, scene, floor_from(scene, vehicle))
    _add_vehicle(top, scene, vehicle, plugin)
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, "unicode")}\n'


def _add_environment(top: Element, scene: Scene, vehicle: Vehicle) -> None:
    """Add gravity, physics steps, light and the camera of the window."""
    step = scene.mission.step
    fill(top, {"gravity": [0.0, 0.0, -GRAVITY]})
    physics = add(top, "physics", name="ode", type="ode", default="1")
    fill(physics, {"max_step_size": step, "real_time_factor": 1.0, "real_time_update_rate": 1.0 / step})
    contact: dict[str, float] = {
        "cfm": 0.0,
        "erp": CORRECTED_SHARE,
        "contact_max_correcting_vel": CORRECTION_SPEED,
        "contact_surface_layer": 0.0,
    }
    fill(physics, {"ode": {"solver": {"type": "world"}, "constraints": contact}})  # the exact solver
    fill(top, {"scene": {"ambient": rgba(AMBIENT), "background": rgba(SKY), "shadows": "true", "grid": "false"}})
    light = add(top, "light", name="sun", type="directional")
    pose(light, 20.0 * SUN, digits=DIGITS)
    shining = {"diffuse": rgba("#d1c7b5"), "specular": rgba("#333333"), "direction": numbers(-SUN, DIGITS)}
    fill(light, {"cast_shadows": "true", **shining})
    camera = add(add(top, "gui"), "camera", name="user_camera")
    view, reach = CAMERAS["follow"], float(np.linalg.norm(vehicle.lever_arms, axis=1).max()) + 0.5
    azimuth, height = np.radians([view.azimuth, view.elevation])
    back = np.array([np.cos(height) * np.cos(azimuth), np.cos(height) * np.sin(azimuth), np.sin(height)])
    eye = scene.initial.position + VIEW_DISTANCE * reach * back
    add(camera, "pose", numbers([*eye, 0.0, height, azimuth + np.pi], DIGITS))
    add(camera, "view_controller", "orbit")
    near, far = 0.8 * VIEW_DISTANCE * reach, 1.2 * VIEW_DISTANCE * reach
    fill(add(camera, "track_visual"), {"name": MODEL, "min_dist": near, "max_dist": far, "static": "false"})


def _add_visual(link: Element, shape: VisualShape) -> None:
    """Add a visual; a translucent one casts no shadow."""
    visual = add(link, "visual", name=shape.name)
    pose(visual, shape.position, shape.axes, DIGITS)
    geometry(visual, shape.kind, shape.size, DIGITS)
    _set_color(visual, shape.color)
    if shape.opacity < 1.0:
        fill(visual, {"transparency": 1.0 - shape.opacity, "cast_shadows": "false"})


def _set_color(visual: Element, color: str) -> None:
    fill(visual, {"material": {"ambient": rgba(color), "diffuse": rgba(color), "specular": rgba("#1a1a1a")}})


def _add_static_link(top: Element, name: str, position: ArrayLike) -> Element:
    """Add a static model; its link."""
    model = add(top, "model", name=name)
    add(model, "static", "true")
    pose(model, position)
    return add(model, "link", name=name)


def _add_floor(top: Element, floor: Floor, scene: Scene) -> None:
    """Add a horizontal plane, visible below the initial position and all walls."""
    ends = [end for w in scene.all_walls for end in (w.start, w.end)]
    places = np.array([scene.initial.position[:2], *ends])
    low, high = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
    low, high = np.floor(low / LINE_SPACING) * LINE_SPACING, np.ceil(high / LINE_SPACING) * LINE_SPACING
    link = _add_static_link(top, "floor", [*(low + high) / 2.0, floor.height])
    for kind in ("collision", "visual"):
        part = add(link, kind, name="floor")
        fill(part, {"geometry": {"plane": {"normal": [0.0, 0.0, 1.0], "size": high - low}}})
        if kind == "collision":
            add_surface(part, CollisionSurface(FLOOR_BIT, floor.friction))
        else:
            _set_color(part, GROUND)
    for line in _grid_lines(high - low):
        _add_visual(link, line)


def _grid_lines(size: Array) -> Iterator[VisualShape]:
    """The lines of a grid on a floor of a size (2) [m]."""
    for i, (along, letter) in enumerate(zip(size[::-1], "xy", strict=True)):
        for k, place in enumerate(np.arange(0.0, size[i] + LINE_SPACING / 2.0, LINE_SPACING) - size[i] / 2.0):
            middle, sides = np.array([0.0, 0.0, LINE_HEIGHT]), [LINE_WIDTH, LINE_WIDTH, LINE_HEIGHT]
            middle[i], sides[1 - i] = place, along
            yield VisualShape(f"line_{letter}_{k}", "box", (sides[0], sides[1], sides[2]), middle, LEVEL, LINE)


def _add_walls(top: Element, scene: Scene, floor: Floor) -> None:
    """Add each wall: a thin box for contact and a thicker one as visual."""
    link, surface = _add_static_link(top, "walls", np.zeros(3)), CollisionSurface(WALL_BIT, scene.ground.friction)
    for k, wall in enumerate(scene.all_walls, 1):
        shape = _wall(f"wall_{k}", wall, floor.height)
        add_collision(link, shape, surface)
        _add_visual(link, shape._replace(size=(shape.size[0], SHOWN_THICKNESS, shape.size[2])))


def _wall(name: str, wall: WallTable, floor: float) -> VisualShape:
    """The box of a wall, from below the floor to its top."""
    start, along = np.array(wall.start), np.subtract(wall.end, wall.start)
    foot, length = min(floor, wall.top) - WALL_DEPTH, float(np.hypot(*along))
    axes = rotation_about_z(np.arctan2(along[1], along[0]))
    middle = np.array([*(start + along / 2.0), (foot + wall.top) / 2.0])
    return VisualShape(name, "box", (length, WALL_THICKNESS, wall.top - foot), middle, axes, WALL, GLASS)


def _add_vehicle(top: Element, scene: Scene, vehicle: Vehicle, plugin: int | str | None) -> None:
    """Add the vehicle in the initial state of the mission; Gazebo never disables it when it rests."""
    model = add(top, "model", name=MODEL)
    R = np.array(rotation_from_quaternion(quaternion_from_euler(vec3(scene.initial.euler))))
    pose(model, scene.initial.position, R)
    fill(model, {"allow_auto_disable": "false", "self_collide": "false"})
    payload, *quadrotors = links_of(scene, vehicle)
    collisions, fleet, depth = VehicleCollisions(scene, vehicle), vehicle.quadrotors, float(vehicle.payload.box[1][2])
    element = _add_link(model, payload, payload_shapes(vehicle.payload, tuple(fleet), solid=False))
    collisions.add_to_payload(element, payload)
    for i, (link, q) in enumerate(zip(quadrotors, fleet, strict=True)):
        collisions.add_to_quadrotor(_add_link(model, link, quadrotor_shapes(q, depth)), link, i)
    for i, q in enumerate(fleet, 1):
        joint = add(model, "joint", name=f"joint_{i}", type="fixed")
        pose(joint, np.subtract(q.joint_position, q.position))
        fill(joint, {"parent": "payload", "child": f"quadrotor_{i}"})
    if plugin == "ros":
        fill(add(model, "plugin", name="tandemlift", filename=OVER_ROS), {"rotors": rotors_of(vehicle)})
    elif plugin is not None:
        fill(add(model, "plugin", name="tandemlift", filename=PLUGIN), {"port": plugin})


def _add_link(model: Element, link: Link, visuals: Iterable[VisualShape]) -> Element:
    """Add a body with inertia and visuals."""
    element = add(model, "link", name=link.name)
    pose(element, link.position)
    inertial, J = add(element, "inertial"), link.inertia
    fill(inertial, {"mass": link.mass})
    pose(inertial, link.center)
    parts = {f"i{a}{b}": J["xyz".index(a), "xyz".index(b)] for a, b in ("xx", "xy", "xz", "yy", "yz", "zz")}
    fill(inertial, {"inertia": parts})
    for shape in visuals:
        _add_visual(element, shape)
    return element


def rotors_of(vehicle: Vehicle) -> Array:
    """Array (3, 4N): x and y of each rotor [m] from its quadrotor's centre of mass, signed torque per thrust [m]."""
    places = np.array([place for q in vehicle.quadrotors for place in q.rotors])
    torques = [q.torque_per_thrust * spin for q in vehicle.quadrotors for spin in q.spins]
    return np.array([*places.T, torques])
