"""The reference of a guidance by hand stays above the ground from which it was lifted.

A push downwards, or wind on the beam that looks like one, would else carry the reference into the floor. The feet then
press, what presses back is taken for a disturbance, and the vehicle may turn over.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice
from tandemlift.algebra.ops import clip, where
from tandemlift.algebra.vector import Vec3

APPROACH_GAIN = 2.0  # 1/s: largest speed downwards over the height that is left


class GroundClearance(NamedTuple):
    """Where there is a floor: height above it [m] below which a push does not move the reference further down."""

    height: Any


@choice(absent=0.0)
def has_floor(k: Any) -> Any:
    """1 where there is a floor, else 0."""


@has_floor.register(GroundClearance)
def _floor(k: GroundClearance) -> Any:
    return 1.0


@choice(absent="speed")
def above_ground(k: Any, speed: Vec3, velocity: Any, pull: Any, height: Any) -> Any:
    """The largest speeds of the reference [m/s], with a limit of that downwards.

    Args:
        k: the `GroundClearance`, or `Nothing`.
        speed: largest along each axis [m/s].
        velocity: of the reference along z [m/s].
        pull: what moves it along z [N].
        height: of the reference above the ground [m].
    """


@above_ground.register(GroundClearance)
def _above(k: GroundClearance, speed: Vec3, velocity: Any, pull: Any, height: Any) -> Vec3:
    down = where(pull == 0.0, velocity, pull)
    slower = clip(APPROACH_GAIN * (height - k.height), 0.0, speed.z)
    return speed._replace(z=where(down < 0.0, slower, speed.z))
