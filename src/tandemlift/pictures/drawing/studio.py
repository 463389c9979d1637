"""The scene of a flight in VTK, drawn off screen: a display is not needed, EGL or OSMesa is."""

from __future__ import annotations

import ctypes
import os
import sys
import weakref
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
from PIL import Image

from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array
from tandemlift.engines.models.visuals import (
    GLASS,
    PUSH_COLOR,
    SUN,
    WALL,
    VisualShape,
    rotation_about_z,
    vehicle_shapes,
)
from tandemlift.pictures.drawing import ground
from tandemlift.pictures.drawing.ground import Painted, View, rgb
from tandemlift.pictures.drawing.stage import FlightStage

PATH, AHEAD, FALL, FRAME = "#1f5fbf", "#9db7d6", "#8a9097", "#4d5a6b"  # flown, to come, on the floor; edges of walls
SHADE = "#9a9fa6"
NEAR = 0.05  # m, distance of the near clipping plane
ROWS = 720  # of the picture for which widths of lines are given [pixels]
OVERSAMPLING = 2  # a picture is drawn with so many times its pixels each way, and then reduced
SPINNING = 40.0  # rad/s, drawn speed of the blades; at the true speed they would alias
SHAFT = 0.022  # m, radius of an arrow
LAYER = 4e-4  # height of shadow, grid and path, one above the other, over the floor / distance of the vehicle
WINDOWS = {  # drawing without a display: a library, and VTK's window for it
    "libEGL.so.1": "vtkEGLRenderWindow",
    "libOSMesa.so.8": "vtkOSOpenGLRenderWindow",
    "libOSMesa.so.6": "vtkOSOpenGLRenderWindow",
}


@cache
def pyvista() -> ModuleType:
    """The module pyvista.

    Raises:
        InputError: it is not installed, or the system has nothing that draws without a display.
    """
    with extra("video", "drawing a flight"):
        import pyvista
    if sys.platform == "linux":
        window = next((window for library, window in WINDOWS.items() if _is_there(library)), None)
        if window is None:
            raise InputError("drawing a flight needs EGL or OSMesa: apt-get install libegl1 libgl1-mesa-dri")
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", window)
    return pyvista


def _is_there(library: str) -> bool:
    try:
        return bool(ctypes.CDLL(library))
    except OSError:
        return False


class Studio:
    """Draws a flight.

    Args:
        stage: the flight.
        size: of the pictures: width, height [pixels].
    """

    def __init__(self, stage: FlightStage, size: tuple[int, int]) -> None:
        self._stage, self._size, self._pv = stage, size, pyvista()
        self._plotter = self._pv.Plotter(off_screen=True, window_size=[OVERSAMPLING * n for n in size], lighting="none")
        weakref.finalize(self, self._plotter.close)  # pyvista keeps a plotter, of tens of megabytes, until it is closed
        self._plotter.render_window.SetMultiSamples(0)  # FINE smooths the edges; both would take twice the time
        self._blend_in_order()
        self._shown: dict[str, Any] = {}  # meshes that change from picture to picture
        for direction, strength in ((SUN, 0.72), (SUN * [-1.0, -1.0, 0.4], 0.25)):  # the sun, and what the sky sends
            light = self._pv.Light(position=100.0 * direction, light_type="scene light", intensity=strength)
            light.positional = False
            self._plotter.add_light(light)
        shapes = vehicle_shapes(stage.vehicle)
        blades = [s for s in shapes if s.name.startswith("blades")]
        solid = [s for s in shapes if s.opacity == 1.0 and not s.name.startswith("blades")]
        spins = np.concatenate([q.spins for q in stage.vehicle.quadrotors])
        self._blades = [(_pose(s.position, s.axes), spin) for s, spin in zip(blades, spins, strict=True)]
        centred = [VisualShape(s.name, s.kind, s.size, np.zeros(3), color=s.color) for s in blades]
        meshes = [self._mesh(solid), *(self._mesh([blade]) for blade in centred)]
        self._solids = [self._add_coloured(mesh, ambient=0.3, specular=0.15, specular_power=20.0) for mesh in meshes]
        self._shadows = [self._add(mesh.copy(), color=SHADE, lighting=False) for mesh in meshes]
        discs = [s for s in shapes if s.opacity < 1.0]
        self._discs = self._add_coloured(self._mesh(discs), opacity=discs[0].opacity, lighting=False)
        for wall in stage.walls:
            self._add_wall(wall)

    def picture(self, time: float, view: View, cell: float) -> Image.Image:
        """The picture at a time [s]; `cell` is the size of a grid cell [m]."""
        self._move(time, view)
        self._paint_surroundings(view, cell)
        camera, height = self._plotter.camera, self._size[1]
        camera.position, camera.focal_point, camera.up = view.eye, view.target, view.up
        camera.view_angle = 2.0 * np.degrees(np.arctan(height / 2.0 / view.focal))
        camera.clipping_range = (NEAR, 2.0 * ground.DOME * ground.EDGE * view.distance)
        self._plotter.render_window.Render()
        return self._fine_picture().reduce(OVERSAMPLING).convert("RGB")

    def _blend_in_order(self) -> None:
        """Draw what is farther first, so that each wall and disc is blended over what is behind it.

        By default VTK averages all that is translucent at a pixel, whatever its order, in buffers as large as the
        picture: without a graphics card that takes as long as all else.
        """
        renderer = self._plotter.renderer
        if hasattr(renderer, "UseOITOff"):  # from VTK 9.4 on
            renderer.UseOITOff()
            renderer.GetCullers().GetLastItem().SetSortingStyleToBackToFront()

    def _fine_picture(self) -> Image.Image:
        """What the window shows, with `FINE` times the pixels each way; a screenshot would copy it twice more."""
        from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

        size, pixels = (OVERSAMPLING * self._size[0], OVERSAMPLING * self._size[1]), vtkUnsignedCharArray()
        self._plotter.render_window.GetRGBACharPixelData(0, 0, size[0] - 1, size[1] - 1, 1, pixels)
        return Image.frombuffer(
            "RGBX", size, self._pv.convert_array(pixels), "raw", "RGBX", 0, -1
        )  # the lowest row comes first

    def _move(self, time: float, view: View) -> None:
        """Put vehicle, shadow, path and push where they are at a time."""
        stage, layer = self._stage, LAYER * view.distance
        position = stage.position(time)
        body, flat = _pose(position, stage.rotation(time)), ground.shadow_on(stage.floor + layer)
        spun = (pose @ _turned(-spin * SPINNING * time) for pose, spin in self._blades)  # opposite to their torque
        for solid, shadow, pose in zip(self._solids, self._shadows, [body, *(body @ s for s in spun)], strict=True):
            solid.user_matrix, shadow.user_matrix = pose, flat @ pose
        self._discs.user_matrix = body
        flown, apart = stage.time < time, 3.0 * view.distance / view.focal
        past = np.vstack([_thinned(stage.path[flown], apart), position])
        self._draw_line("past", past, PATH, 3.0)
        self._draw_line("ahead", np.vstack([position, _thinned(stage.path[~flown], apart)]), AHEAD, 1.2)
        fall = np.column_stack([past[:, :2], np.full(len(past), stage.floor + 3.0 * layer)])
        self._draw_line("fall", fall, FALL, 1.6)
        self._draw_arrow(stage.arrow(time))

    def _draw_arrow(self, arrow: tuple[Array, Array] | None) -> None:
        mesh = self._pv.PolyData()
        if arrow:
            start, tip = arrow
            length = float(np.linalg.norm(tip - start))
            radii = {"tip_length": 7.0 * SHAFT, "tip_radius": 2.6 * SHAFT, "shaft_radius": SHAFT}
            parts = {name: value / length for name, value in radii.items()}
            mesh = self._pv.Arrow(start=start, direction=tip - start, scale=length, **parts)
        self._show("push", mesh, color=PUSH_COLOR, ambient=0.35)

    def _paint_surroundings(self, view: View, cell: float) -> None:
        """Floor, grid and sky, as they are seen from the camera."""
        low = self._stage.floor
        for name, painted in (("floor", ground.floor(view, low)), ("sky", ground.sky(view))):
            self._add_painted(name, painted)
        for name, step, width in (("cells", cell, 1.0), ("fives", 5.0 * cell, 2.0)):
            lines = ground.grid(view, step, low + 2.0 * LAYER * view.distance)
            self._add_painted(name, lines, width)

    def _add_painted(self, name: str, painted: Painted, width: float | None = None) -> None:
        """Add a surface, or lines of a width [pixels], in place of one with the same name."""
        mesh = self._pv.PolyData(painted.points, **{"lines" if width else "faces": painted.cells})
        mesh["colors"] = painted.colors.round().astype(np.uint8)
        mesh.set_active_scalars("colors")
        self._show(name, mesh, scalars="colors", rgb=True, lighting=False, line_width=self._dots(width or 1.0))

    def _draw_line(self, name: str, points: Array, color: str, width: float) -> None:
        mesh = self._pv.lines_from_points(points) if len(points) > 1 else self._pv.PolyData()
        self._show(name, mesh, color=color, line_width=self._dots(width), lighting=False)

    def _show(self, name: str, mesh: Any, **look: Any) -> None:
        """Show a mesh, which may be empty, in place of the one with the same name; its look is that of the first."""
        if name in self._shown:
            self._shown[name].shallow_copy(mesh)
        elif mesh.n_points:
            self._add(mesh, **look)
            self._shown[name] = mesh

    def _add_wall(self, wall: dict[str, Any]) -> None:
        foot = [np.array([*wall[end], self._stage.floor]) for end in ("start", "end")]
        head = [np.array([*wall[end], wall["top"]]) for end in ("start", "end")]
        corners = np.array([foot[0], foot[1], head[1], head[0]])
        self._add(self._pv.PolyData(corners, faces=[4, 0, 1, 2, 3]), color=WALL, opacity=GLASS, lighting=False)
        frame = self._pv.lines_from_points(corners, close=True)
        self._add(frame, color=FRAME, line_width=self._dots(2.0), lighting=False)

    def _mesh(self, shapes: list[VisualShape]) -> Any:
        """One mesh of shapes, with their colours."""
        meshes = []
        for shape in shapes:
            mesh = self._surface(shape).triangulate().compute_normals(split_vertices=True, feature_angle=50.0)
            mesh.transform(_pose(shape.position, shape.axes), inplace=True)
            mesh["colors"] = np.tile(rgb(shape.color), (mesh.n_points, 1)).astype(np.uint8)
            meshes.append(mesh)
        return meshes[0].append_polydata(*meshes[1:]) if len(meshes) > 1 else meshes[0]

    def _surface(self, shape: VisualShape) -> Any:
        """The surface of a shape, centred and upright."""
        if shape.kind == "box":
            return self._pv.Cube(**dict(zip(("x_length", "y_length", "z_length"), shape.size, strict=True)))
        if shape.kind == "sphere":
            return self._pv.Sphere(radius=shape.size[0])
        if shape.kind == "hull":
            corners = np.reshape(shape.size, (-1, 3))
            return self._pv.PolyData.from_regular_faces(corners, np.arange(len(corners)).reshape(-1, 3))
        radius, length = shape.size
        return self._pv.Cylinder(direction=(0.0, 0.0, 1.0), radius=radius, height=length, resolution=28)

    def _add(self, mesh: Any, **look: Any) -> Any:
        return self._plotter.add_mesh(mesh, show_scalar_bar=False, reset_camera=False, render=False, **look)

    def _add_coloured(self, mesh: Any, **look: Any) -> Any:
        return self._add(mesh, scalars="colors", rgb=True, **look)

    def _dots(self, width: float) -> float:
        """A width of a line in dots as they are drawn, from pixels of a picture of `ROWS` rows."""
        return width * OVERSAMPLING * self._size[1] / ROWS


def _thinned(points: Array, apart: float) -> Array:
    """Points (n, 3) of a path, so far apart [m] along it; wide lines between nearer ones would have gaps."""
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return points[np.unique(np.searchsorted(way, np.arange(0.0, way[-1], apart)))] if len(points) > 2 else points


def _pose(position: Array, rotation: Array) -> Array:
    """A homogeneous transformation (4 × 4)."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, position
    return pose


def _turned(angle: float) -> Array:
    """A rotation about z by an angle [rad], as a transformation (4 × 4)."""
    return _pose(np.zeros(3), rotation_about_z(angle))
