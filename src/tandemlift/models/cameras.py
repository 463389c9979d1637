"""Fixed cameras in a world of Gazebo that save pictures periodically.

They need a server with a display (or Xvfb). With `--lockstep`, a camera saves a picture in every period.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from tandemlift.common.types import Array
from tandemlift.models.sdf_elements import numbers
from tandemlift.rendering.camera import ANGLE, NEAR

FAR = 300.0  # m, of the drawn range
PICTURES = "pictures"  # folder of pictures, where the server runs


class FixedCamera(NamedTuple):
    """A fixed camera.

    Attributes:
        name: of its model and of the folder of its pictures; letters, digits and underscores.
        position: (3,) [m, world axes].
        target: (3,) the point that it looks at [m, world axes].
        size: width and height of a picture [pixels].
    """

    name: str
    position: Array
    target: Array
    size: tuple[int, int] = (1024, 576)


def add_cameras(world: str, eyes: Sequence[FixedCamera], every: float) -> str:
    """Add cameras to a world.

    Args:
        world: text of the world, from `models.sdf.world`.
        eyes: the cameras.
        every: time between pictures [s].

    Returns:
        The text of the new world.
    """
    top = ElementTree.fromstring(world.encode())
    place = top.find("world")
    assert place is not None
    for eye in eyes:
        place.append(_model(eye, every))
    ElementTree.indent(top)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(top, "unicode")}\n'


def _model(eye: FixedCamera, every: float) -> ElementTree.Element:
    width, height = eye.size
    across = 2.0 * np.arctan(np.tan(ANGLE / 2.0) * width / height)
    x, y, z = eye.target - eye.position
    turned = [0.0, -np.arctan2(z, np.hypot(x, y)), np.arctan2(y, x)]
    return ElementTree.fromstring(
        f"""<model name="{eye.name}"><static>true</static><pose>{numbers([*eye.position, *turned], 6)}</pose>
<link name="{eye.name}"><sensor name="{eye.name}" type="camera"><always_on>true</always_on>
<update_rate>{numbers([1.0 / every])}</update_rate>
<camera><horizontal_fov>{numbers([across], 6)}</horizontal_fov>
<image><width>{width}</width><height>{height}</height><format>R8G8B8</format></image>
<clip><near>{NEAR}</near><far>{FAR}</far></clip>
<save enabled="true"><path>{PICTURES}/{eye.name}</path></save></camera></sensor></link></model>"""
    )
