"""Cameras: the directions from which a vehicle is viewed, by name or by angles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tandemlift.core.errors import InputError, unknown

NEAR = 0.05  # m, distance of the near clipping plane
ANGLE = np.radians(30.0)  # vertical field of view [rad]


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
