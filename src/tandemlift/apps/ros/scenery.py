"""The scene in RViz: vehicle, floor and walls once, push and reference as they move; each shape a `Marker`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from tandemlift import Vehicle
from tandemlift.apps.export.coordinate_frames import ALIGNED, BASE, WORLD, quaternions, to_world
from tandemlift.apps.export.messages import MessageTypes
from tandemlift.apps.live.session.frames import points_of
from tandemlift.core.types import Array
from tandemlift.engines.models.visuals import LEVEL, PUSH_COLOR, VisualShape, payload_shapes, vehicle_shapes, wall_shape

MARKER, MARKERS = "visualization_msgs/Marker", "visualization_msgs/MarkerArray"
ARROW, CUBE, SPHERE, CYLINDER, LINES, TEXT = 0, 1, 2, 3, 5, 9
DELETE = 2
KINDS = {"box": CUBE, "sphere": SPHERE, "cylinder": CYLINDER}
UNTURNED = (1.0, 0.0, 0.0, 0.0)
GROUND, LINE = "#ffffff", "#c3c9d1"
FLOOR_THICKNESS = 0.02  # m, of the floor as drawn
MARGIN = 4.0  # m, of the floor around all there is
REFERENCE, OPACITY = "#2f6fb0", 0.45
MIN_OFFSET = 0.02  # m: a reference that is nearer to the vehicle is not shown
PER_NEWTON, WIDTH, TEXT_HEIGHT = 0.22, 0.05, 0.2  # m/N and m: of the arrow of a push, and of its words
LABEL_OFFSET = np.array([0.0, 0.0, TEXT_HEIGHT])  # m
MIN_FORCE = 0.05  # N


def quaternion_from(R: Array) -> tuple[float, float, float, float]:
    """The quaternion w, x, y, z of a rotation (3 × 3): the eigenvector of Bar-Itzhack's K (2000) for its value 1.

    Unlike Shepperd's formulas it needs no case for each largest component.
    """
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


def still(types: MessageTypes, scene: Mapping[str, Any], vehicle: Vehicle) -> object:
    """The markers of vehicle, floor and walls; the vehicle's move with its frame."""
    body = MarkerWriter(types, BASE, "vehicle", locked=True)
    world = MarkerWriter(types, WORLD, "surroundings", locked=True)
    made = [body.shape(i, shape) for i, shape in enumerate(vehicle_shapes(vehicle, solid=False))]
    low, high = _around(scene)
    floor = np.array([*(low + high) / 2.0, scene["floor"] - FLOOR_THICKNESS / 2.0])
    shapes = [
        VisualShape("floor", "box", (*(high - low).tolist(), FLOOR_THICKNESS), floor, color=GROUND),
        *map(wall_shape, scene["walls"]),
    ]
    made += [world.shape(i, shape) for i, shape in enumerate(shapes)]
    made.append(world.lines(len(shapes), _grid(low, high, scene["floor"] + FLOOR_THICKNESS / 10.0), LINE, 0.01))
    return types[MARKERS](markers=made)


def _around(scene: Mapping[str, Any]) -> tuple[Array, Array]:
    """The corners (2) of a rectangle around all there is, in whole metres."""
    ends = np.array([[0.0, 0.0], *(end for w in scene["walls"] for end in _ends(w))])
    return np.floor(ends.min(axis=0)) - MARGIN, np.ceil(ends.max(axis=0)) + MARGIN


def _grid(low: Array, high: Array, level: float) -> Array:
    """Lines (n, 2, 3) every metre."""
    xs, ys = (np.arange(a, b + 0.5) for a, b in zip(low, high, strict=True))
    along = [[[x, low[1], level], [x, high[1], level]] for x in xs]
    return np.array(along + [[[low[0], y, level], [high[0], y, level]] for y in ys])


def _ends(wall: Mapping[str, Any]) -> Array:
    middle, half = np.array(wall["center"][:2]), wall["size"][0] / 2.0
    along = half * np.array([np.cos(wall["heading"]), np.sin(wall["heading"])])
    return np.array([middle - along, middle + along])


class PushMarkers:
    """The markers of push and reference.

    Args:
        types: of the messages.
        vehicle: what is flown.
    """

    def __init__(self, types: MessageTypes, vehicle: Vehicle) -> None:
        self._types = types
        self._ghost, self._push = MarkerWriter(types, WORLD, "reference"), MarkerWriter(types, ALIGNED, "push")
        self._shapes = list(_ghost(vehicle))

    def of(self, channels: Mapping[str, Array], stamp: int) -> object:
        """The markers of a sample, channels (1, …), at a time [ns]."""
        return self._types[MARKERS](markers=[*self._arrow(channels, stamp), *self._reference(channels, stamp)])

    def _arrow(self, channels: Mapping[str, Array], stamp: int) -> list[Any]:
        """An arrow from where the push acts, and how strong it is."""
        force = channels["push_force"][0]
        size = float(np.linalg.norm(force))
        if not size > MIN_FORCE:
            return [self._push.nothing(0), self._push.nothing(1)]
        attitude = channels["attitude"]
        start = to_world(attitude, points_of(channels["push_force"], channels["push_moment"], attitude))[0]
        end = start + PER_NEWTON * force
        return [
            self._push.arrow(0, stamp, start, end, PUSH_COLOR, WIDTH),
            self._push.text(1, stamp, end + LABEL_OFFSET, f"{size:.1f} N", PUSH_COLOR, TEXT_HEIGHT),
        ]

    def _reference(self, channels: Mapping[str, Array], stamp: int) -> list[Any]:
        """The vehicle's outline where it is to be."""
        place, here = channels["reference_position"], channels["position"]
        if not np.linalg.norm(place - here) > MIN_OFFSET:
            return [self._ghost.nothing(i) for i in range(len(self._shapes))]
        R = to_world(np.repeat(quaternions(channels["reference_euler"][:1]), 3, axis=0), np.eye(3)).T
        there = [s._replace(position=place[0] + R @ s.position, axes=R @ s.axes) for s in self._shapes]
        return [self._ghost.shape(i, shape, stamp) for i, shape in enumerate(there)]


def _ghost(vehicle: Vehicle) -> Iterator[VisualShape]:
    """Its payload, and a disc for each quadrotor."""
    payload, at = vehicle.payload, 0.0 + vehicle.origin
    for shape in payload_shapes(payload, (), solid=False):
        yield shape._replace(position=at + shape.position, color=REFERENCE, opacity=OPACITY)
    for q, center in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        yield VisualShape("disc", "cylinder", (q.guard_radius, 0.02), center, color=REFERENCE, opacity=OPACITY)
