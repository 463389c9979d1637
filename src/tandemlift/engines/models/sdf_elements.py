"""Elements of SDF: XML with numbers, poses, colours and shapes; fixed cameras that save pictures periodically.

The Gazebo server needs a display (or Xvfb) for cameras. With `--lockstep`, one saves a picture in every period.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.types import Array
from tandemlift.engines.models.camera import ANGLE, NEAR
from tandemlift.engines.models.visuals import LEVEL
from tandemlift.parts.mechanics.vehicle import Vehicle

Element = ElementTree.Element


def numbers(values: ArrayLike, digits: int | None = None) -> str:
    """Numbers separated by spaces, with all digits of their float64, or rounded to `digits`."""
    flat = np.ravel(np.asarray(values, dtype=float))
    return " ".join(repr(float(v) + 0.0) for v in (flat if digits is None else np.round(flat, digits)))


def euler_of(R: Array) -> Array:
    """Roll, pitch, yaw (3) [rad] of R = Rz(yaw) Ry(pitch) Rx(roll), the order of SDF, not of missions."""
    yaw = np.arctan2(R[1, 0], R[0, 0])
    c, s = np.cos(yaw), np.sin(yaw)  # exact also at 90° of pitch
    roll = np.arctan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return np.array([roll, np.arctan2(-R[2, 0], c * R[0, 0] + s * R[1, 0]), yaw])


def add(parent: Element, tag: str, text: str | int | None = None, **attributes: str) -> Element:
    """Add a child with a text and attributes; the child."""
    child = ElementTree.SubElement(parent, tag, attributes)
    child.text = None if text is None else str(text)
    return child


def fill(parent: Element, content: dict[str, Any]) -> None:
    """Add children by name: numbers, text, or a dictionary of children."""
    for tag, value in content.items():
        if isinstance(value, dict):
            fill(add(parent, tag), value)
        else:
            add(parent, tag, value if isinstance(value, (str, int)) else numbers(value))


def pose(parent: Element, position: ArrayLike, R: Array = LEVEL, digits: int | None = None) -> None:
    """Add a pose: position (3) [m] and orientation R (3 × 3)."""
    add(parent, "pose", numbers([*np.asarray(position, dtype=float), *euler_of(R)], digits))


def rgba(color: str, opacity: float = 1.0) -> str:
    """A colour #rrggbb and an opacity as four numbers from 0 to 1."""
    return numbers([*(int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5)), opacity], 3)


def geometry(parent: Element, kind: str, size: Sequence[float], digits: int | None = None) -> None:
    """Add the geometry of a box, a sphere or a cylinder of a size [m]."""
    names = {"box": ["size"], "sphere": ["radius"], "cylinder": ["radius", "length"]}[kind]
    shape = add(add(parent, "geometry"), kind)
    for name, values in zip(names, [size] if kind == "box" else [[number] for number in size], strict=True):
        add(shape, name, numbers(values, digits))


FAR = 300.0  # m, distance of the far clipping plane
PICTURES = "pictures"  # folder of pictures, relative to the working directory of the server
MARGIN = 0.5  # m, around the outermost quadrotor


class FixedCamera(NamedTuple):
    """A fixed camera.

    Attributes:
        name: of its model and of its picture folder; letters, digits and underscores.
        position: (3,) [m, world axes].
        target: (3,) the point at the centre of the picture [m, world axes].
        size: width and height of a picture [pixels].
    """

    name: str
    position: Array
    target: Array
    size: tuple[int, int] = (1024, 576)


def add_cameras(world: str, cameras: Sequence[FixedCamera], every: float) -> str:
    """Add cameras to a world.

    Args:
        world: SDF text, from `engines.models.sdf.world`.
        cameras: to add.
        every: time between pictures [s].

    Returns:
        The SDF text with the cameras.
    """
    top = ElementTree.fromstring(world.encode())
    place = top.find("world")
    assert place is not None
    for camera in cameras:
        place.append(_model(camera, every))
    ElementTree.indent(top)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(top, "unicode")}\n'


def _model(camera: FixedCamera, every: float) -> ElementTree.Element:
    width, height = camera.size
    across = 2.0 * np.arctan(np.tan(ANGLE / 2.0) * width / height)
    x, y, z = camera.target - camera.position
    turned = [0.0, -np.arctan2(z, np.hypot(x, y)), np.arctan2(y, x)]
    return ElementTree.fromstring(
        f"""<model name="{camera.name}"><static>true</static><pose>{numbers([*camera.position, *turned], 6)}</pose>
<link name="{camera.name}"><sensor name="{camera.name}" type="camera"><always_on>true</always_on>
<update_rate>{numbers([1.0 / every])}</update_rate>
<camera><horizontal_fov>{numbers([across], 6)}</horizontal_fov>
<image><width>{width}</width><height>{height}</height><format>R8G8B8</format></image>
<clip><near>{NEAR}</near><far>{FAR}</far></clip>
<save enabled="true"><path>{PICTURES}/{camera.name}</path></save></camera></sensor></link></model>"""
    )


def reach_of(mission: Mapping[str, Any]) -> float:
    """Distance [m] from the vehicle's centre of mass that cameras must show, from a resolved mission's tables."""
    return float(np.linalg.norm(Vehicle.from_mission(mission).lever_arms, axis=1).max()) + MARGIN
