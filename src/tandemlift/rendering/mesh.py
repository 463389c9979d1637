"""Triangle meshes of basic shapes: surfaces of revolution, boxes and parallelograms.

Triangles share no vertices: each corner has its own normal, so that a mesh may have both smooth surfaces and sharp
edges. Lengths in m.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.common.types import Array

SIDES = 20  # of the polygon that approximates a circle


class Mesh(NamedTuple):
    """Triangles: `corners` (F, 3, 3) [m], unit `normals` at them (F, 3, 3), and a linear colour each (F, 3), 0 to 1."""

    corners: Array
    normals: Array
    colors: Array

    def placed(self, position: ArrayLike, R: Array) -> Mesh:
        """The mesh rotated by R (3 × 3) and translated by `position` (3)."""
        return Mesh(self.corners @ R.T + np.asarray(position), self.normals @ R.T, self.colors)


EMPTY = Mesh(np.zeros((0, 3, 3)), np.zeros((0, 3, 3)), np.zeros((0, 3)))


def merged(meshes: list[Mesh]) -> Mesh:
    """One mesh with all triangles of some meshes."""
    return Mesh(*map(np.concatenate, zip(EMPTY, *meshes, strict=True)))


def linear(color: str) -> Array:
    """An sRGB colour #rrggbb as linear RGB (3)."""
    coded = np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1


def _quads(corners: Array, normals: Array, color: str) -> Mesh:
    """Two triangles for each quadrilateral (n, 4, 3)."""
    split = [[0, 1, 2], [0, 2, 3]]
    faces, lit = corners[:, split].reshape(-1, 3, 3), normals[:, split].reshape(-1, 3, 3)
    return Mesh(faces, lit, np.broadcast_to(linear(color), (len(faces), 3)).copy())


def frame_along(direction: ArrayLike) -> Array:
    """A rotation (3 × 3) whose third column points along a direction."""
    z = np.asarray(direction, dtype=float)
    z = z / np.linalg.norm(z)
    x = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _outward(points: Array, *, smooth: bool) -> tuple[Array, Array]:
    """Outward normals of the segments of a profile (n, 2), at the start and at the end of each."""
    along = np.diff(points, axis=0)
    across = np.column_stack([along[:, 1], -along[:, 0]]) / np.maximum(np.linalg.norm(along, axis=1), 1e-12)[:, None]
    if not smooth:
        return across, across
    closed = np.allclose(points[0], points[-1])
    before, after = (across[-1:], across[:1]) if closed else (across[:1], across[-1:])
    mean = np.concatenate([before, across]) + np.concatenate([across, after])
    mean /= np.maximum(np.linalg.norm(mean, axis=1), 1e-12)[:, None]
    return mean[:-1], mean[1:]


def revolved(profile: ArrayLike, color: str, *, smooth: bool = False, sides: int = SIDES) -> Mesh:
    """A surface of revolution: a profile (n, 2) of (radius, height) revolved about z, its outside to the right.

    Args:
        profile: points in order; straight between them.
        color: #rrggbb.
        smooth: whether normals are interpolated across the points of the profile; otherwise each is an edge.
        sides: of the polygon that approximates the circle.
    """
    points = np.asarray(profile, dtype=float)
    start, end = _outward(points, smooth=smooth)
    turn = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])

    def around(rows: Array, directions: Array) -> Array:  # (segments, sides, 3)
        return np.concatenate(
            [rows[:, None, :1] * directions, np.broadcast_to(rows[:, None, 1:], (len(rows), sides, 1))], axis=2
        )

    here, there = circle[:-1], circle[1:]
    low, high = points[:-1], points[1:]
    corners = np.stack([around(low, here), around(low, there), around(high, there), around(high, here)], axis=2)
    normals = np.stack([around(start, here), around(start, there), around(end, there), around(end, here)], axis=2)
    return _quads(corners.reshape(-1, 4, 3), normals.reshape(-1, 4, 3), color)


def sphere(center: ArrayLike, radius: float, color: str, flatness: float = 1.0) -> Mesh:
    """A sphere, or one flattened along z."""
    turn = np.linspace(-np.pi / 2.0, np.pi / 2.0, 11)
    profile = np.column_stack([radius * np.cos(turn), flatness * radius * np.sin(turn)])
    return revolved(profile, color, smooth=True).placed(center, np.eye(3))


def cylinder(
    start: ArrayLike, end: ArrayLike, radius: float, color: str, tip: float | None = None, sides: int = 12
) -> Mesh:
    """A cylinder from one point to another, or a truncated cone that ends with the radius `tip`."""
    a, b = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    length, last = float(np.linalg.norm(b - a)), radius if tip is None else tip
    if length < 1e-9:
        return EMPTY
    profile = [(0.0, 0.0), (radius, 0.0), (last, length), (0.0, length)]
    return revolved(profile, color, sides=sides).placed(a, frame_along(b - a))


def torus(center: ArrayLike, radius: float, thickness: float, color: str) -> Mesh:
    """A torus about z; `thickness` is the radius of its tube."""
    turn = np.linspace(0.0, 2.0 * np.pi, 9)
    profile = np.column_stack([radius + thickness * np.cos(turn), thickness * np.sin(turn)])
    return revolved(profile, color, smooth=True, sides=48).placed(center, np.eye(3))


def disc(center: ArrayLike, radius: float, color: str) -> Mesh:
    """A flat disc with its normal along z."""
    return revolved([(radius, 0.0), (0.0, 0.0)], color, sides=32).placed(center, np.eye(3))


def box(center: ArrayLike, size: ArrayLike, color: str, R: Array | None = None) -> Mesh:
    """A box of a size (3), rotated by R (3 × 3) if given."""
    axes = np.eye(3)
    corners, normals = [], []
    for k in range(3):
        u, v, w = axes[k], axes[(k + 1) % 3], axes[(k + 2) % 3]
        for side in (1.0, -1.0):
            face = [side * u + p * v + side * q * w for p, q in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            corners.append(np.array(face) * np.asarray(size) / 2.0)
            normals.append(np.broadcast_to(side * u, (4, 3)))
    return _quads(np.array(corners), np.array(normals), color).placed(center, np.eye(3) if R is None else R)


def panel(corner: ArrayLike, along: ArrayLike, up: ArrayLike, color: str) -> Mesh:
    """A parallelogram from a corner (3) and its two edge vectors (3)."""
    a, u, v = (np.asarray(p, dtype=float) for p in (corner, along, up))
    across = np.cross(u, v) / max(float(np.linalg.norm(np.cross(u, v))), 1e-12)
    return _quads(np.array([[a, a + u, a + u + v, a + v]]), np.broadcast_to(across, (1, 4, 3)), color)
