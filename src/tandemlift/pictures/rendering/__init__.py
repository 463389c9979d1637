"""Pictures and animations of a flight, drawn off screen by VTK.

`stage` computes the places of all parts of a flight, `studio` draws them from a camera, and `film` writes files.
"""

from tandemlift.engines.models.camera import Camera, camera_of
from tandemlift.pictures.rendering.film import Animation, Shot, picture, render, size_of

__all__ = ["Animation", "Camera", "Shot", "camera_of", "picture", "render", "size_of"]
