"""The reference of interactive guidance stays above the ground from which it was lifted.

Otherwise a push downwards, or wind on the beam that looks like one, would move the reference into the floor. The feet
then press, the floor's force is misclassified as a disturbance, and the vehicle may overturn.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import clip
from tandemlift.core.law import law
from tandemlift.core.part import Part
from tandemlift.core.types import Number
from tandemlift.parts.guidance.compliance import Compliance, with_speed

APPROACH_GAIN = 2.0  # 1/s: largest speed downwards over the height that is left


class GroundClearance(NamedTuple):
    """Height above a floor [m] below which a push does not move the reference further down."""

    height: Number


@law(absent=0.0)
def has_floor(k: GroundClearance) -> Number:
    """1 where there is a floor, else 0."""
    return 1.0


@law(absent="compliance")
def above_ground(k: GroundClearance, compliance: Compliance, height: Number) -> Compliance:
    """The compliance with a limit of the speed downwards; `height` [m] of the reference above the ground."""
    speed, down = compliance.limits.speed, compliance.limits.speed_back
    slower = clip(APPROACH_GAIN * (height - k.height), 0.0, down.z)
    return with_speed(compliance, speed, down._replace(z=slower))


CLEARANCE = Part(
    *("clearance", "guidance", "compliance.min_height", 'ground.model = "floor"', lambda table: GroundClearance(table)),
    remembers=False,
)
