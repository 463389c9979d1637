"""Rotation matrices of logged attitudes."""

from __future__ import annotations

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import Quat
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion


def body_to_world(attitude: Array) -> Array:
    """R (…, 3, 3) that turns body axes into world axes, of unit quaternions w, x, y, z (…, 4)."""
    rows = rotation_from_quaternion(Quat(*np.moveaxis(attitude, -1, 0)))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
