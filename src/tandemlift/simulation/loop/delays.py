"""Delay lines: of readings on their way to the pilot, of commands to the rotors, of the view of a person."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.vector import Absent


class Delayed(NamedTuple):
    """Marks a delayed signal; the number of steps is data of the loop."""


class DelayLines(NamedTuple):
    """Delays of the IMU and motion readings, of the rotor commands and of the person's view.

    Each is `Delayed` or `Absent`; those of additional sensors' readings by name.
    """

    imu: Delayed | Absent
    motion: Delayed | Absent
    command: Delayed | Absent
    view: Delayed | Absent
    additional: tuple[Delayed | Absent, ...] = Absent()
