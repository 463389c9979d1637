"""What goes through delay lines: readings on their way to the pilot, commands to the rotors, what a person sees."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.vector import Nothing


class Delayed(NamedTuple):
    """Marks what is delayed; by how many steps is data of the loop."""


class DelayLines(NamedTuple):
    """Of the readings of the IMU and of the motion measurement, of the rotors' commands, of what a person sees.

    Each is `Delayed` or `Nothing`; those of additional sensors' readings by name.
    """

    imu: Any
    motion: Any
    command: Any
    seen: Any
    additional: Any = Nothing()
