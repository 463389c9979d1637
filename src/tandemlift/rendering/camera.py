"""The eye: from where it looks, and where points of space appear in the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.common.errors import InputError, unknown
from tandemlift.common.types import Array

NEAR = 0.05  # m: what is nearer is not drawn
ANGLE = np.radians(30.0)  # of view, from the lower to the upper edge


class View(NamedTuple):
    """A perspective view: `eye` [m, world axes]; `axes` (3 × 3), rows right, up, ahead; `focal` length [pixels].

    `width` and `height` [pixels]; `middle`: the row [pixels] straight ahead, outside of some strips of a picture.
    """

    eye: Array
    axes: Array
    focal: float
    width: int
    height: int
    middle: float

    def seen(self, points: Array) -> Array:
        """Points (…, 3) as column, row [pixels] and the inverse of their distance ahead [1/m]; NaN where too near."""
        local = (points - self.eye) @ self.axes.T
        ahead = local[..., 2]
        inverse = 1.0 / np.where(ahead > NEAR, ahead, np.nan)
        column = self.width / 2.0 + self.focal * local[..., 0] * inverse
        row = self.middle - self.focal * local[..., 1] * inverse
        return np.stack([column, row, inverse], axis=-1)

    def rays(self, rows: ArrayLike, columns: ArrayLike) -> Array:
        """Directions (…, 3), one long ahead, in which the eye looks through the centres of pixels."""
        x = (np.asarray(columns)[..., None] + 0.5 - self.width / 2.0) / self.focal
        y = (self.middle - np.asarray(rows)[..., None] - 0.5) / self.focal
        right, up, ahead = self.axes
        return x * right + y * up + ahead

    def finer(self, times: int) -> View:
        """The same view in so many times as many pixels each way."""
        focal, width, height = self.focal * times, self.width * times, self.height * times
        return View(self.eye, self.axes, focal, width, height, self.middle * times)

    def strip(self, first: int, height: int) -> View:
        """The rows from a first one on, as a view of their own."""
        return self._replace(height=height, middle=self.middle - first)


def look_at(target: ArrayLike, azimuth: float, elevation: float, distance: float, width: int, height: int) -> View:
    """The view of a target [m] from a direction (azimuth, elevation [rad]) and a distance [m]."""
    c, s = np.cos(elevation), np.sin(elevation)
    back = np.array([c * np.cos(azimuth), c * np.sin(azimuth), s])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    axes = np.array([right, np.cross(back, right), -back])
    focal = min(height, 0.75 * width) / 2.0 / np.tan(ANGLE / 2.0)
    return View(np.asarray(target) + distance * back, axes, float(focal), width, height, height / 2.0)


@dataclass(frozen=True)
class Camera:
    """From where the vehicle is looked at: azimuth and elevation [deg]; it follows, or stays and shows the whole way.

    `distance` [m] of a following eye; near enough to fill the picture if not given.
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
