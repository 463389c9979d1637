"""Floor, grid and sky as a camera sees them: VTK has no haze, so meshes get the colours that are seen there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.types import Array
from tandemlift.engines.models.visuals import SUN

FLOOR, LINE, HAZE, ZENITH = "#d7d9dc", "#a3abb3", "#e9edf1", "#a9c4de"
HAZE_DISTANCE = 9.0  # distance at which haze hides half of the floor / distance of the vehicle
EDGE, GRID = 120.0, 14.0  # radius of the floor, and of its grid / distance of the vehicle
FADE_PIXELS = 6.0  # pixels between two lines, below which a grid begins to fade
RINGS, SIDES, PIECES = 40, 96, 24  # of the floor: rings, sectors; of a line of the grid
DOME = 1.5  # radius of the sky / radius of the floor
SLOPE = 2.2  # gradient of the sky's colour over the sine of the elevation


class View(NamedTuple):
    """A camera.

    Attributes:
        eye: its place (3) [m].
        target: the point (3) at the centre of the picture [m].
        up: a unit vector (3), upward in the picture.
        focal: focal length [pixels].
        distance: of the target [m], which sets how far floor and haze reach.
    """

    eye: Array
    target: Array
    up: Array
    focal: float
    distance: float


class Painted(NamedTuple):
    """Points (n, 3) [m] with their colours (n, 3), 0 to 255, and the faces or lines between them as VTK has them."""

    points: Array
    cells: NDArray[np.int64]
    colors: Array


def rgb(color: str) -> Array:
    """A colour #rrggbb as three numbers, 0 to 255."""
    return np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)], dtype=float)


def hazy(color: str, points: Array, view: View) -> Array:
    """A colour (n, 3) of the floor as it is seen at points (n, 3), 0 to 255."""
    way = np.linalg.norm(points - view.eye, axis=1) / (HAZE_DISTANCE * view.distance)
    return rgb(HAZE) + (rgb(color) - rgb(HAZE)) * np.exp2(-(way**2))[:, None]


def floor(view: View, height: float) -> Painted:
    """The floor at a height [m], as rings around the point below the camera."""
    radii = np.concatenate([[0.0], view.distance * np.geomspace(0.05, EDGE, RINGS)])
    points = np.array([*view.eye[:2], height]) + radii[:, None, None] * _circle()
    return Painted(points.reshape(-1, 3), _faces(len(radii)), hazy(FLOOR, points.reshape(-1, 3), view))


def sky(view: View) -> Painted:
    """The sky, as a dome around the camera."""
    rise = np.sin(np.radians(np.concatenate([[-3.0], np.linspace(0.0, 90.0, RINGS)])))
    dome = np.sqrt(1.0 - rise**2)[:, None, None] * _circle() + rise[:, None, None] * [0.0, 0.0, 1.0]
    points = view.eye + DOME * EDGE * view.distance * dome.reshape(-1, 3)
    high = np.clip(SLOPE * np.repeat(rise, SIDES), 0.0, 1.0)[:, None]
    return Painted(points, _faces(len(rise)), rgb(HAZE) + (rgb(ZENITH) - rgb(HAZE)) * high)


def grid(view: View, step: float, height: float) -> Painted:
    """Lines along x and y at the multiples of a step [m] around the target, in pieces; dense ones fade."""
    reach, points = GRID * view.distance, []
    for axis in (0, 1):  # across which the lines stand side by side
        middle, other = view.target[axis], view.target[1 - axis]
        places = np.arange(np.ceil((middle - reach) / step), np.floor((middle + reach) / step) + 1.0) * step
        ends = other + np.linspace(-reach, reach, PIECES + 1)
        along = np.column_stack([ends[:-1], ends[1:]]).ravel()
        flat = np.column_stack([np.repeat(places, len(along)), np.tile(along, len(places))])
        points.append(np.column_stack([flat if axis == 0 else flat[:, ::-1], np.full(len(flat), height)]))
    lines = np.concatenate(points)
    away = np.linalg.norm(lines - view.eye, axis=1)
    spaced = view.focal * step * (view.eye[2] - height) / away**2  # pixels between two lines that lie across
    strength = np.clip(spaced / FADE_PIXELS, 0.0, 1.0)[:, None]
    colors = hazy(FLOOR, lines, view) * (1.0 - strength) + hazy(LINE, lines, view) * strength
    cells = np.column_stack([np.full(len(lines) // 2, 2), np.arange(len(lines)).reshape(-1, 2)]).ravel()
    return Painted(lines, cells, colors)


def shadow_on(height: float) -> Array:
    """The transformation (4 × 4) that moves points along the sun's rays to a height [m]."""
    flat = np.eye(4)
    flat[:3, 2] -= SUN / SUN[2]
    flat[:3, 3] = height * SUN / SUN[2]
    return flat


def _circle() -> Array:
    turn = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    return np.column_stack([np.cos(turn), np.sin(turn), np.zeros(SIDES)])


def _faces(rings: int) -> NDArray[np.int64]:
    """The quadrilaterals between neighbouring rings of points."""
    i = np.arange(rings * SIDES).reshape(rings, SIDES)
    j = np.roll(i, -1, axis=1)
    return np.stack([np.full_like(i[1:], 4), i[:-1], j[:-1], j[1:], i[1:]], axis=-1).ravel()
