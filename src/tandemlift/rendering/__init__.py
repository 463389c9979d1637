"""Pictures and animations of a flight, by a software renderer that needs no display and no graphics library.

`mesh` makes triangle meshes of basic shapes, `aircraft` makes the vehicle's mesh, and `stage` makes the scene of a
flight at a given time. `camera` projects points, `raster` finds the visible triangle in each pixel, `light` and
`ground` compute colours, `studio` renders a scene, and `film` writes files.
"""

from tandemlift.rendering.camera import Camera, camera_of
from tandemlift.rendering.film import Animation, Shot, picture, render

__all__ = ["Animation", "Camera", "Shot", "camera_of", "picture", "render"]
