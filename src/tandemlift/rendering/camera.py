"""The perspective camera: its pose, and the projection of points in space into the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.common.errors import InputError, unknown
from tandemlift.common.types import Array

NEAR = 0.05  # m, distance of the near clipping plane
ANGLE = np.radians(30.0)  # vertical field of view [rad]


class View(NamedTuple):
    """A perspective view.

    Attributes:
        eye: position of the camera (3) [m, world axes].
        axes: its axes (3 × 3) as rows: right, up, forward.
        focal: focal length [pixels].
        width: of the picture [pixels].
        height: of the picture [pixels].
        middle: the row of the optical axis [pixels]; it may lie outside of a strip of a picture.
    """

    eye: Array
    axes: Array
    focal: float
    width: int
    height: int
    middle: float

    def project(self, points: Array) -> Array:
        """Project points (…, 3): column, row [pixels] and inverse depth [1/m]; NaN nearer than the near plane."""
        local = (points - self.eye) @ self.axes.T
        ahead = local[..., 2]
        inverse = 1.0 / np.where(ahead > NEAR, ahead, np.nan)
        column = self.width / 2.0 + self.focal * local[..., 0] * inverse
        row = self.middle - self.focal * local[..., 1] * inverse
        return np.stack([column, row, inverse], axis=-1)

    def rays(self, rows: ArrayLike, columns: ArrayLike) -> Array:
        """Ray directions (…, 3) through the centres of pixels, with a forward component of 1."""
        x = (np.asarray(columns)[..., None] + 0.5 - self.width / 2.0) / self.focal
        y = (self.middle - np.asarray(rows)[..., None] - 0.5) / self.focal
        right, up, ahead = self.axes
        return x * right + y * up + ahead

    def magnified(self, times: int) -> View:
        """The same view with `times` as many pixels in each direction."""
        focal, width, height = self.focal * times, self.width * times, self.height * times
        return View(self.eye, self.axes, focal, width, height, self.middle * times)

    def strip(self, first: int, height: int) -> View:
        """The view of `height` rows of the picture, from row `first` on."""
        return self._replace(height=height, middle=self.middle - first)


def look_at(target: ArrayLike, azimuth: float, elevation: float, distance: float, width: int, height: int) -> View:
    """The view of a target (3) [m] from a direction (azimuth, elevation [rad]) at a distance [m]."""
    c, s = np.cos(elevation), np.sin(elevation)
    back = np.array([c * np.cos(azimuth), c * np.sin(azimuth), s])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    axes = np.array([right, np.cross(back, right), -back])
    focal = min(height, 0.75 * width) / 2.0 / np.tan(ANGLE / 2.0)
    return View(np.asarray(target) + distance * back, axes, float(focal), width, height, height / 2.0)


@dataclass(frozen=True)
class Camera:
    """The direction from which the vehicle is viewed.

    Attributes:
        azimuth: of the camera as seen from the vehicle [deg].
        elevation: likewise [deg].
        follows: whether the camera follows the vehicle; otherwise it is fixed and shows the whole path.
        distance: of a following camera [m]; if not given, the vehicle fills the picture.
    """

    azimuth: float
    elevation: float
    follows: bool = True
    distance: float | None = None


CAMERAS = {
    "follow": Camera(-52.0, 17.0),
    "overview": Camera(-64.0, 27.0, follows=False),
    "front": Camera(0.0, 8.0),
    "side": Camera(-90.0, 8.0),
    "top": Camera(180.0, 89.0),
}


def camera_of(text: str) -> Camera:
    """A camera by name, or by AZIMUTH,ELEVATION[,DISTANCE] in degrees and metres.

    Raises:
        InputError: it is neither.
    """
    if text in CAMERAS:
        return CAMERAS[text]
    parts = text.split(",")
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        raise unknown("camera", text, [*CAMERAS, "AZIMUTH,ELEVATION[,DISTANCE]"]) from None
    sound = len(numbers) in (2, 3) and all(map(np.isfinite, numbers))
    if not sound or not 2.0 <= numbers[1] <= 89.0 or not 0.2 <= (*numbers, 1.0)[2] <= 1000.0:
        raise InputError(
            f"camera {text!r} must be AZIMUTH,ELEVATION[,DISTANCE]: degrees from x to y, degrees above the horizon "
            "from 2 to 89, and metres from 0.2 to 1000, such as -55,20,4"
        )
    return Camera(numbers[0], numbers[1], distance=numbers[2] if len(numbers) == 3 else None)
