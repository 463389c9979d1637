"""The displays of RViz: vehicle, floor and walls once, push and reference as they move."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from tandemlift.apps.export.coordinate_frames import ALIGNED, BASE, WORLD, quaternions, to_world
from tandemlift.apps.export.messages import MessageTypes
from tandemlift.apps.live.session.frames import points_of
from tandemlift.apps.ros.markers import MARKERS, MarkerWriter
from tandemlift.core.types import Array
from tandemlift.engines.models.visuals import PUSH_COLOR, VisualShape, payload_shapes, vehicle_shapes, wall_shape
from tandemlift.parts.mechanics.vehicle import Vehicle

GROUND, LINE = "#ffffff", "#c3c9d1"
THICK = 0.02  # m, of the floor as drawn
MARGIN = 4.0  # m, of the floor around all there is
REFERENCE, OPACITY = "#2f6fb0", 0.45
APART = 0.02  # m: a reference that is nearer to the vehicle is not shown
PER_NEWTON, WIDTH, TEXT = 0.22, 0.05, 0.2  # m/N and m: of the arrow of a push, and of its words
ABOVE = np.array([0.0, 0.0, TEXT])  # m
FAINTEST = 0.05  # N


def still(types: MessageTypes, scene: Mapping[str, Any], vehicle: Vehicle) -> object:
    """The markers of vehicle, floor and walls; the vehicle's move with its frame."""
    body, world = (
        MarkerWriter(types, BASE, "vehicle", locked=True),
        MarkerWriter(types, WORLD, "surroundings", locked=True),
    )
    made = [body.shape(i, shape) for i, shape in enumerate(vehicle_shapes(vehicle))]
    low, high = _around(scene)
    floor = np.array([*(low + high) / 2.0, scene["floor"] - THICK / 2.0])
    shapes = [
        VisualShape("floor", "box", (*(high - low).tolist(), THICK), floor, color=GROUND),
        *map(wall_shape, scene["walls"]),
    ]
    made += [world.shape(i, shape) for i, shape in enumerate(shapes)]
    made.append(world.lines(len(shapes), _grid(low, high, scene["floor"] + THICK / 10.0), LINE, 0.01))
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
        if not size > FAINTEST:
            return [self._push.nothing(0), self._push.nothing(1)]
        attitude = channels["attitude"]
        start = to_world(attitude, points_of(channels["push_force"], channels["push_moment"], attitude))[0]
        end = start + PER_NEWTON * force
        return [
            self._push.arrow(0, stamp, start, end, PUSH_COLOR, WIDTH),
            self._push.text(1, stamp, end + ABOVE, f"{size:.1f} N", PUSH_COLOR, TEXT),
        ]

    def _reference(self, channels: Mapping[str, Array], stamp: int) -> list[Any]:
        """The vehicle's outline where it is to be."""
        place, here = channels["reference_position"], channels["position"]
        if not np.linalg.norm(place - here) > APART:
            return [self._ghost.nothing(i) for i in range(len(self._shapes))]
        R = to_world(np.repeat(quaternions(channels["reference_euler"][:1]), 3, axis=0), np.eye(3)).T
        there = [s._replace(position=place[0] + R @ s.position, axes=R @ s.axes) for s in self._shapes]
        return [self._ghost.shape(i, shape, stamp) for i, shape in enumerate(there)]


def _ghost(vehicle: Vehicle) -> Iterator[VisualShape]:
    """Its payload, and a disc for each quadrotor."""
    payload, at = vehicle.payload, 0.0 - vehicle.center_of_mass
    for shape in payload_shapes(payload, tuple(vehicle.quadrotors))[:1]:
        yield shape._replace(position=at + shape.position, color=REFERENCE, opacity=OPACITY)
    for q, center in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        yield VisualShape("disc", "cylinder", (q.guard_radius, 0.02), center, color=REFERENCE, opacity=OPACITY)
