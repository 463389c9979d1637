"""The eye: where it is, what it looks at, and where points of space appear in the picture."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

NEAR = 0.05  # m: what is nearer is not drawn
ANGLE = np.radians(30.0)  # of view, from the lower to the upper edge


class View(NamedTuple):
    """A perspective view: `eye` [m, world axes]; `axes` (3 × 3), rows right, up, ahead; `focal` length [pixels]."""

    eye: Array
    axes: Array
    focal: float
    width: int
    height: int

    def seen(self, points: Array) -> Array:
        """Points (…, 3) as column, row [pixels] and the inverse of their distance ahead [1/m]; NaN where too near."""
        local = (points - self.eye) @ self.axes.T
        ahead = local[..., 2]
        inverse = 1.0 / np.where(ahead > NEAR, ahead, np.nan)
        column = self.width / 2.0 + self.focal * local[..., 0] * inverse
        row = self.height / 2.0 - self.focal * local[..., 1] * inverse
        return np.stack([column, row, inverse], axis=-1)

    def rays(self) -> Array:
        """Directions (height, width, 3) in which the pixels' centres look, one long ahead."""
        x = (np.arange(self.width) + 0.5 - self.width / 2.0) / self.focal
        y = (self.height / 2.0 - np.arange(self.height) - 0.5) / self.focal
        right, up, ahead = self.axes
        return x[None, :, None] * right + y[:, None, None] * up + ahead

    def finer(self, times: int) -> View:
        """The same view in so many times as many pixels each way."""
        return View(self.eye, self.axes, self.focal * times, self.width * times, self.height * times)


def look_at(target: ArrayLike, azimuth: float, elevation: float, distance: float, width: int, height: int) -> View:
    """The view of a target [m] from a direction (azimuth, elevation [rad]) and a distance [m]."""
    c, s = np.cos(elevation), np.sin(elevation)
    back = np.array([c * np.cos(azimuth), c * np.sin(azimuth), s])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    axes = np.array([right, np.cross(back, right), -back])
    focal = min(height, 0.75 * width) / 2.0 / np.tan(ANGLE / 2.0)
    return View(np.asarray(target) + distance * back, axes, float(focal), width, height)
