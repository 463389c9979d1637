"""A vehicle as URDF, for RViz 2 and other tools of ROS: its frames as ROS has them, its looks, masses and inertias.

The root `base_link` is at the centre of mass of the vehicle and has all looks; `payload` and `joint_1`, …, fixed to it
by the joints `to_payload`, …, are the frames of `/tf_static`, and have the masses of payload and quadrotors. It is the
vehicle that the pilot knows, without the differences in `plant`.
"""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from tandemlift.core.types import Array
from tandemlift.engines.models.sdf_elements import Element, add, euler_of, geometry, numbers, rgba
from tandemlift.engines.models.visuals import LEVEL, vehicle_shapes
from tandemlift.parts.mechanics.vehicle import Vehicle

ROOT = "base_link"
DIGITS = 6  # decimals [m, rad] of looks


def urdf(vehicle: Vehicle, name: str) -> str:
    """The text of a robot description.

    Args:
        vehicle: what is described.
        name: of the robot.
    """
    robot = Element("robot", name=name)
    root, colors = add(robot, "link", name=ROOT), set[tuple[str, float]]()
    for shape in vehicle_shapes(vehicle, solid=False):
        look, color = add(root, "visual"), (shape.color, shape.opacity)
        _origin(look, shape.position, shape.axes, DIGITS)
        add(look, "geometry").append(_solid(shape.kind, shape.size))
        material = add(look, "material", name=f"{shape.color[1:]}_{shape.opacity:g}")
        if color not in colors:  # the first of a name defines it
            colors.add(color)
            add(material, "color", rgba=rgba(*color))
    own, place = vehicle.payload, 0.0 + vehicle.origin
    _part(robot, "payload", place, own.mass, np.array(own.center_of_mass), own.tensor)
    for i, (q, center) in enumerate(zip(vehicle.quadrotors, vehicle.lever_arms, strict=True), 1):
        at = place + np.array(q.joint_position)
        _part(robot, f"joint_{i}", at, q.mass, center - at, q.tensor)
    ElementTree.indent(robot)
    return '<?xml version="1.0"?>\n' + ElementTree.tostring(robot, "unicode") + "\n"


def _part(robot: Element, name: str, place: Array, mass: float, center: Array, inertia: Array) -> None:
    """A link whose frame is fixed at a place of the root, with its mass [kg] at a centre in its frame [m]."""
    inertial = add(add(robot, "link", name=name), "inertial")
    _origin(inertial, center)
    add(inertial, "mass", value=numbers(mass))
    rows = {f"i{'xyz'[i]}{'xyz'[j]}": numbers(inertia[i, j]) for i in range(3) for j in range(i, 3)}
    add(inertial, "inertia", **rows)
    joint = add(robot, "joint", name=f"to_{name}", type="fixed")
    _origin(joint, place)
    add(joint, "parent", link=ROOT)
    add(joint, "child", link=name)


def _origin(parent: Element, position: Array, axes: Array = LEVEL, digits: int | None = None) -> None:
    add(parent, "origin", xyz=numbers(position, digits), rpy=numbers(euler_of(axes), digits))


def _solid(kind: str, size: tuple[float, ...]) -> Element:
    """A box, sphere or cylinder, whose sizes are attributes here, not elements as in SDF."""
    geometry(holder := Element("holder"), kind, size, DIGITS)
    return Element(kind, {child.tag: child.text or "" for child in holder[0][0]})
