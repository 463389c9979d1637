"""Pictures and animations of a flight, drawn by ourselves, so that no display and no graphics library is needed.

`rendering.mesh` makes shapes of triangles, `aircraft` a vehicle of shapes, `stage` a scene of a flight at a time;
`camera` looks at it, `raster` finds what is seen in each pixel, `light` and `ground` give it its colour, `studio` puts
it together, and `film` writes files.
"""

from tandemlift.rendering.camera import Camera, camera_of
from tandemlift.rendering.film import Animation, Shot, picture, render

__all__ = ["Animation", "Camera", "Shot", "camera_of", "picture", "render"]
