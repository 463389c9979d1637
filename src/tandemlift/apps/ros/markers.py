"""Shapes as messages that RViz draws: `visualization_msgs/Marker`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tandemlift.apps.export.messages import MessageTypes
from tandemlift.core.types import Array
from tandemlift.engines.models.visuals import LEVEL, VisualShape

MARKER, MARKERS = "visualization_msgs/Marker", "visualization_msgs/MarkerArray"
ARROW, CUBE, SPHERE, CYLINDER, LINES, TEXT = 0, 1, 2, 3, 5, 9
DELETE = 2
KINDS = {"box": CUBE, "sphere": SPHERE, "cylinder": CYLINDER}
UNTURNED = (1.0, 0.0, 0.0, 0.0)


def quaternion_from(R: Array) -> tuple[float, float, float, float]:
    """The quaternion w, x, y, z of a rotation (3 × 3): the eigenvector of Bar-Itzhack's K (2000) for its value 1."""
    K = np.empty((4, 4))
    K[0, 0], K[1:, 1:] = np.trace(R), R + R.T - np.trace(R) * np.eye(3)
    K[0, 1:] = K[1:, 0] = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    w, x, y, z = np.linalg.eigh(K)[1][:, -1].tolist()
    return w, x, y, z


class MarkerWriter:
    """Draws markers of one namespace in a frame, each with a number of its own.

    Args:
        types: of the messages.
        frame: in which places are.
        name: of the namespace, which RViz can switch off.
        locked: whether markers move with the frame once they are drawn.
    """

    def __init__(self, types: MessageTypes, frame: str, name: str, *, locked: bool = False) -> None:
        self._types, self._name, self._locked = types, name, locked
        self._header, self._Marker = types.headers(frame), types[MARKER]
        self._Pose, self._Color = types["geometry_msgs/Pose"], types["std_msgs/ColorRGBA"]

    def shape(self, number: int, shape: VisualShape, stamp: int = 0) -> object:
        """A box, sphere or cylinder."""
        size = shape.size
        edges = {"box": size, "sphere": 3 * (2.0 * size[0],), "cylinder": (2.0 * size[0],) * 2 + size[1:]}[shape.kind]
        attitude = UNTURNED if shape.axes is LEVEL else quaternion_from(shape.axes)
        return self._mark(number, KINDS[shape.kind], stamp, shape.position, attitude, edges, shape.color, shape.opacity)

    def arrow(self, number: int, stamp: int, start: Array, end: Array, color: str, width: float) -> object:
        """An arrow from one point to another; its shaft is so wide [m]."""
        marker = self._mark(number, ARROW, stamp, np.zeros(3), UNTURNED, (width, 2.2 * width, 3.0 * width), color, 1.0)
        marker.points = [self._types.Point(*p.tolist()) for p in (start, end)]
        return marker

    def lines(self, number: int, pairs: Array, color: str, width: float) -> object:
        """Straight lines (n, 2, 3) from point to point, so wide [m]."""
        marker = self._mark(number, LINES, 0, np.zeros(3), UNTURNED, (width, 0.0, 0.0), color, 1.0)
        marker.points = [self._types.Point(*p) for p in pairs.reshape(-1, 3).tolist()]
        return marker

    def text(self, number: int, stamp: int, at: Array, words: str, color: str, height: float) -> object:
        """Words that face the viewer."""
        marker = self._mark(number, TEXT, stamp, at, UNTURNED, (0.0, 0.0, height), color, 1.0)
        marker.text = words
        return marker

    def nothing(self, number: int) -> object:
        """A message that removes a marker."""
        return self._Marker(header=self._header(0), ns=self._name, id=number, action=DELETE)

    def _mark(
        self,
        number: int,
        kind: int,
        stamp: int,
        at: Array,
        attitude: Sequence[float],
        size: Sequence[float],
        color: str,
        opacity: float,
    ) -> Any:
        red, green, blue = (int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
        return self._Marker(
            header=self._header(stamp),
            ns=self._name,
            id=number,
            type=kind,
            pose=self._Pose(self._types.Point(*np.asarray(at).tolist()), self._types.quaternion(attitude)),
            scale=self._types.Vector(*map(float, size)),
            color=self._Color(red, green, blue, float(opacity)),
            frame_locked=self._locked,
        )
