"""Fixed cameras in a Gazebo world that save pictures periodically.

The Gazebo server needs a display (or Xvfb). With `--lockstep`, a camera saves a picture in every period.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from tandemlift.core.types import Array
from tandemlift.engines.models.camera import ANGLE, NEAR
from tandemlift.engines.models.sdf_elements import numbers
from tandemlift.parts.mechanics.vehicle import Vehicle

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
