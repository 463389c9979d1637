"""A payload from its bodies or the file of a mesh: mass, centre of mass and inertia.

Bodies are evenly filled. A mesh is read by trimesh, and also gives a convex hull of few corners.
"""

from __future__ import annotations

import functools
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import FlightWarning, InputError, extra, shown
from tandemlift.core.keys import Triple
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.bodies import MOST_CORNERS, Body, ConvexHull, convex_hull
from tandemlift.parts.mechanics.vehicle import parallel_axis_term

SAME = 1e-9  # relative: a saved mission has the numbers of its bodies, too
KINDS = (".stl", ".obj", ".ply")
SMALLEST_EXTENT, LARGEST_EXTENT = 1e-3, 20.0  # m, extent of a payload
FINE_GAP = 1e-3  # of the extent: how far a mesh may stick out of its hull until corners are added
ROUGH_GAP = 0.02  # of the extent: and silently
ALIKE = 1e-5  # of the extent: points are as far as this out of a plane alike
PLACES = (16, 2048)  # under a mesh at which its layers are counted: how many
MOST_CROSSINGS = 2e6  # of these times its triangles
SPREAD = 0.7548776662466927, 0.5698402909980532  # steps of an even sequence in a square (Roberts' R2)
COMES = ("center_of_mass", "inertia", "products", "corners")  # keys that come from a mesh


class MeshBody(NamedTuple):
    """A closed mesh of density 1: volume [m³], centre of mass [m], inertia about it [m⁵], corners of its hull [m]."""

    volume: float
    center: Array
    tensor: Array
    corners: tuple[Triple, ...]


def with_mesh(payload: dict[str, Any]) -> dict[str, Any]:
    """The table of a payload with the numbers of its mesh in place of the file, so that nothing else reads it.

    Raises:
        InputError: the file is missing or is no closed mesh, keys are missing or contradict it, or trimesh is missing.
    """
    path, density = payload.get("mesh"), payload.get("density")
    if path is None and density is not None:
        raise InputError(f"density = {shown(density)}: must be left out without mesh; mass is given in kg")
    if not isinstance(path, str) or payload.get("shape") != "mesh":
        return payload
    for name in COMES:
        if name in payload:
            raise InputError(f"{name} = {shown(payload[name])}: must be left out, because it comes from mesh")
    if ("mass" in payload) == (density is not None):
        raise InputError("mesh needs either density [kg/m³] or mass [kg]" + (", not both" if "mass" in payload else ""))
    number: Any = payload.get("mass") if density is None else density
    scale = payload.get("mesh_scale", 1.0)
    for name, value in (("density" if density is not None else "mass", number), ("mesh_scale", scale)):
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < 1e12:
            raise InputError(f"{name} = {shown(value)}: must be a number above 0")
    body = _body(path, Path(path).stat().st_mtime_ns if Path(path).exists() else 0, float(scale))
    per_volume = number if density is not None else number / body.volume
    kept = {name: value for name, value in payload.items() if name not in ("mesh", "mesh_scale", "density")}
    found = _mass_keys(float(per_volume * body.volume), body.center, per_volume * body.tensor)
    return kept | found | {"corners": [list(corner) for corner in body.corners]}


def _mass_keys(mass: float, center: Array, tensor: Array) -> dict[str, Any]:
    """The keys of a payload for its mass [kg], centre of mass (3) [m] and inertia about it (3 × 3) [kg m²]."""
    (x, xy, xz), (_, y, yz), (_, _, z) = tensor.tolist()
    return {"mass": mass, "center_of_mass": center.tolist(), "inertia": [x, y, z], "products": [xy, xz, yz]}


@functools.lru_cache(maxsize=16)
def _body(path: str, changed: int, scale: float) -> MeshBody:
    """The mesh of a file in its version of a time, its unit so many metres."""
    given = f"mesh = {shown(path)}"
    if not Path(path).is_file():
        raise InputError(f"{given}: there is no such file")
    if Path(path).suffix.lower() not in KINDS:
        raise InputError(f"{given}: must be a file of {', '.join(KINDS)}")
    with extra("mesh", "a payload from a mesh"):
        import trimesh
    try:
        mesh = trimesh.load_mesh(path, process=True)
        if not len(mesh.faces):
            raise ValueError("it has no triangles")
        mesh.apply_scale(scale)
        extent = float(np.ptp(mesh.vertices, axis=0).max())
        closed, volume = bool(mesh.is_watertight and mesh.is_winding_consistent), float(mesh.volume)
    except Exception as error:  # of whatever kind a reader of files raises
        raise InputError(f"{given}: cannot be read as a mesh: {error}") from error
    if not SMALLEST_EXTENT <= extent <= LARGEST_EXTENT:
        hint = f"looks like millimetres; scale it with mesh_scale = {0.001 * scale:g}"
        size = f"its extent is {extent:g} m, and must be {SMALLEST_EXTENT:g} m to {LARGEST_EXTENT:g} m"
        raise InputError(
            f"{given}: {size}" + (f": {hint}" if extent > LARGEST_EXTENT else f", or mesh_scale = {scale:g} larger")
        )
    if not closed:
        raise InputError(f"{given}: must be closed, with all triangles turned outside, or it has no mass{_open(mesh)}")
    if volume <= 0.0:
        raise InputError(
            f"{given}: is inside out, with a volume of {volume:g} m³: its triangles must be turned outside"
        )
    if (deep := _layers(np.asarray(mesh.triangles, dtype=float))) is not None:
        why = "bodies overlap, or an inner surface is turned outside" if deep[0] > 0 else "a body is inside out"
        at = np.round(deep[1], 3).tolist()
        raise InputError(f"{given}: its {volume:.4g} m³ count the place {at} m {deep[0]} times: {why}")
    hull, out = few_corners(np.asarray(mesh.vertices, dtype=float))
    if out > ROUGH_GAP * extent:
        text = f"{given}: sticks out of its convex hull of {MOST_CORNERS} corners, which touches, by {out:.2g} m"
        warnings.warn(text, FlightWarning, stacklevel=2)
    tensor = np.asarray(mesh.moment_inertia, dtype=float) / float(mesh.density)
    return MeshBody(volume, np.asarray(mesh.center_mass, dtype=float), tensor, tuple(map(tuple, hull.corners.tolist())))


def _open(mesh: Any) -> str:
    """How many edges of a mesh have not two triangles, where, and what can be done."""
    edges, counts = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
    if not np.any(counts != 2):
        return ": some triangles are turned inside"
    places = np.round(mesh.vertices[edges[counts != 2].ravel()], 3)
    found = f"{int(np.sum(counts != 2))} of {len(edges)} edges have not two triangles"
    way = 'close it where it is drawn, or give mass, inertia and corners of its hull with shape = "mesh"'
    return f": {found}, from {places.min(0).tolist()} to {places.max(0).tolist()} m: {way}"


def _layers(triangles: Array) -> tuple[int, Array] | None:
    """(How many times a surface winds round a place under it, the place [m]), if that is not once anywhere.

    The winding number is the sum of the solid angles of all triangles over 4π (Jacobson et al., ACM Trans. Graph. 32,
    2013; of one by van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983). Places are spread evenly over the
    surface, under it by a hundred thousandth of a triangle's size: walls are thicker.
    """
    corners = np.ascontiguousarray(triangles.transpose(1, 0, 2))
    normals = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    sizes = np.linalg.norm(normals, axis=1)
    every = np.arange(int(np.clip(MOST_CROSSINGS / len(sizes), *PLACES)))
    chosen = np.searchsorted(np.cumsum(sizes), (every + 0.5) / len(every) * sizes.sum())
    u, v = (0.5 + np.outer(SPREAD, every)) % 1.0
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
    on = np.einsum("kn,kni->ni", np.stack([1.0 - u - v, u, v]), corners[:, chosen])
    for place in on - 1e-5 * normals[chosen] / np.sqrt(sizes[chosen, None]):
        a, b, c = corners - place
        x, y, z = np.sqrt(np.einsum("kni,kni->kn", (a, b, c), (a, b, c)))
        ab, bc, ca = (np.einsum("ni,ni->n", p, q) for p, q in ((a, b), (b, c), (c, a)))
        volume = np.einsum("ni,ni->n", a, np.cross(b, c))
        layers = round(float(np.arctan2(volume, x * y * z + ab * z + bc * x + ca * y).sum()) / (2.0 * np.pi))
        if layers != 1:
            return layers, place
    return None


def few_corners(points: Array) -> tuple[ConvexHull, float]:
    """The convex hull of at most `MOST_CORNERS` of some points, and how far others stick out of it at most [m].

    Corners are added where a point is farthest outside, until none sticks out by `FINE_GAP` of the extent.
    """
    extent = float(np.ptp(points, axis=0).max())
    away = np.linalg.norm(points - points.mean(axis=0), axis=1)

    def farthest(out: Array) -> int:
        """Of the points that are farthest out, the one farthest from the middle, which is a corner."""
        return int(np.where(out >= out.max() - ALIKE * extent, away, -1.0).argmax())

    # a first tetrahedron: two ends, the point farthest from their line, and from the plane of all three
    a = farthest(away)
    b = farthest(np.linalg.norm(points - points[a], axis=1))
    along, off = (points[b] - points[a]) / np.linalg.norm(points[b] - points[a]), points - points[a]
    c = farthest(np.linalg.norm(off - np.outer(off @ along, along), axis=1))
    normal = np.cross(along, off[c]) / np.linalg.norm(np.cross(along, off[c]))
    chosen = [a, b, c, farthest(np.abs(off @ normal))]
    while True:
        hull = convex_hull(tuple(map(tuple, points[chosen].tolist())))
        out = (points @ hull.normals.T - hull.offsets).max(axis=1)
        if out.max() <= FINE_GAP * extent or len(chosen) == MOST_CORNERS:
            return hull, max(float(out.max()), 0.0)
        chosen.append(farthest(out))


def with_bodies(payload: dict[str, Any]) -> dict[str, Any]:
    """The table of a payload with the mass, centre of mass and inertia of its bodies.

    Raises:
        InputError: the payload has another mass, centre of mass or inertia than its bodies.
    """
    given = payload.get("bodies")
    if payload.get("shape") != "bodies" or not isinstance(given, list | tuple):
        return payload
    try:
        bodies = [Body.model_validate(body) for body in given]
    except ValueError:  # the tables of the mission say what is wrong with it
        bodies = []
    if not bodies:
        return {"mass": 1.0, "inertia": [1.0, 1.0, 1.0]} | payload
    mass = sum(body.mass for body in bodies)
    parts = [(body.mass, *solid(body)) for body in bodies]
    center = sum((m * place for m, place, _ in parts), np.zeros(3)) / mass
    tensor = sum((J + parallel_axis_term(m, place - center) for m, place, J in parts), np.zeros((3, 3)))
    made = _mass_keys(mass, center, tensor)
    for name, value in made.items():
        if name in payload and not np.allclose(payload[name], value, SAME, SAME * np.max(np.abs(value))):
            raise InputError(f"{name} = {shown(payload[name])}: must be left out, because it comes from bodies")
    return payload | made


def solid(body: Body) -> tuple[Array, Array]:
    """Centre of mass (3) [m] and tensor of inertia about it (3 × 3) [kg m²] of an evenly filled body, body axes."""
    if body.ends is not None and body.radius is not None:
        start, end = np.array(body.ends)
        square, thick = float((end - start) @ (end - start)), body.radius**2
        outer = np.outer(end - start, end - start) / square
        across = body.mass * (3.0 * thick + square) / 12.0
        return 0.5 * (start + end), across * (np.eye(3) - outer) + 0.5 * body.mass * thick * outer
    corners = body.hull.corners[body.hull.triangles]  # of tetrahedra whose fourth corner is the origin
    volumes, sums = np.linalg.det(corners) / 6.0, corners.sum(axis=1)
    center = volumes @ sums / (4.0 * volumes.sum())
    squares = np.einsum("tki,tkj->tij", corners, corners) + np.einsum("ti,tj->tij", sums, sums)
    spread = np.einsum("t,tij->ij", volumes, squares) / (20.0 * volumes.sum()) - np.outer(center, center)
    return center, body.mass * (np.trace(spread) * np.eye(3) - spread)
