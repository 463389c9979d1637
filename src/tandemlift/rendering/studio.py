"""Rendering of a scene: opaque parts, lines and translucent parts in front of the background.

The foreground is supersampled, which smooths edges; the background needs no supersampling.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.common.types import Array
from tandemlift.rendering.camera import ANGLE, View
from tandemlift.rendering.ground import background
from tandemlift.rendering.light import Shadow, reflected_light, to_srgb
from tandemlift.rendering.mesh import EMPTY, Mesh
from tandemlift.rendering.raster import blend, rasterize

FOCAL = 360.0 / np.tan(ANGLE / 2.0)  # focal length [pixels] of a picture of 720 rows
AT_ONCE = 1_500_000  # largest number of samples of a strip; strips limit the memory of a large picture
CLOSER = 1.002  # depth bias of lines: factor on nearness, so that the surface below does not hide them


class SceneLine(NamedTuple):
    """A line through points (n, 3) [m], with its width [pixels of a picture of 720 rows] and colours (n, 3)."""

    points: Array
    width: float
    colors: Array


class Pane(NamedTuple):
    """A translucent mesh, with its opacity."""

    mesh: Mesh
    opacity: float


class Scene(NamedTuple):
    """A scene: opaque mesh, lines, translucent meshes, height of the floor [m], and size of its grid cells [m]."""

    solid: Mesh
    lines: list[SceneLine]
    panes: list[Pane]
    floor: float
    cell: float


def render_scene(scene: Scene, view: View, distance: float, fine: int) -> NDArray[np.uint8]:
    """The picture (H, W, 3) of a scene.

    Args:
        scene: to render.
        view: the camera's view.
        distance: from the camera to its target [m].
        fine: samples of a pixel of the foreground, in each direction.
    """
    shadow = Shadow(scene.solid.corners, scene.floor)
    picture = np.empty((view.height, view.width, 3), np.uint8)
    rows = max(1, AT_ONCE // (view.width * fine**2))
    for first in range(0, view.height, rows):
        strip = view.strip(first, min(rows, view.height - first))
        light = background(strip, scene.floor, distance, shadow, scene.cell)
        front = _downsampled(_foreground(scene, strip.magnified(fine), shadow), fine)
        picture[first : first + rows] = to_srgb(front[..., :3] + light * (1.0 - front[..., 3:]))
    return picture


def _downsampled(picture: Array, fine: int) -> Array:
    """A picture averaged over blocks of `fine` × `fine` samples."""
    parts = [picture[i::fine, j::fine] for i in range(fine) for j in range(fine)]
    return np.add.reduce(parts) / fine**2


def _foreground(scene: Scene, view: View, shadow: Shadow) -> Array:
    """The foreground (H, W, 4): premultiplied light, and opacity."""
    ribbons = [_ribbon(line, view) for line in scene.lines]
    flat = Mesh(*map(np.concatenate, zip(EMPTY, *ribbons, strict=True)))
    solid = scene.solid
    corners = np.concatenate([view.project(solid.corners), flat.corners])
    size = view.height, view.width
    depth, face, weights = np.zeros(size), np.zeros(size, np.int64), np.zeros((*size, 2))
    rasterize(corners, depth, face, weights)
    picture = np.zeros((*size, 4))
    rows, columns = np.nonzero(depth)
    seen, share = face[rows, columns], weights[rows, columns]
    normals = np.concatenate([solid.normals, flat.normals])[seen]
    colors = np.concatenate([solid.colors, flat.colors])[seen]
    share = np.column_stack([1.0 - share.sum(axis=1), share])
    ahead = view.rays(rows, columns)
    points = view.eye + ahead / depth[rows, columns, None]
    ahead = ahead / np.linalg.norm(ahead, axis=1)[:, None]
    normals = (normals * share[..., None]).sum(axis=1)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    picture[rows, columns, :3] = reflected_light(colors, normals, ahead, shadow.shade_on(points))
    picture[rows, columns, 3] = 1.0
    _blend_panes(scene.panes, view, depth, picture)
    return picture


def _blend_panes(panes: list[Pane], view: View, depth: Array, picture: Array) -> None:
    """Blend translucent meshes over the picture, the farthest first."""
    corners = [pane.mesh.corners for pane in panes]
    far = [float(-np.linalg.norm(c.mean(axis=(0, 1)) - view.eye)) for c in corners]
    for i in np.argsort(far):
        colors = np.column_stack([panes[i].mesh.colors, np.full(len(corners[i]), panes[i].opacity)])
        blend(view.project(corners[i]), colors, depth, picture)


def _ribbon(line: SceneLine, view: View) -> Mesh:
    """A line as triangles of constant width on the screen; corners as from `View.project`."""
    seen, width = view.project(line.points), line.width * view.focal / FOCAL
    seen[:, 2] *= CLOSER
    start, end = seen[:-1], seen[1:]
    along = end[:, :2] - start[:, :2]
    length = np.linalg.norm(along, axis=1)
    kept = length > 1e-6  # false for NaN
    start, end, along = start[kept], end[kept], along[kept] / length[kept, None]
    across = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(along))]) * width / 2.0
    on = np.column_stack([along, np.zeros(len(along))]) * width / 4.0  # closes gaps at bends
    a, b, c, d = start - across - on, start + across - on, end + across + on, end - across + on
    corners = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return Mesh(corners, np.zeros_like(corners), np.tile(line.colors[:-1][kept], (2, 1)))
