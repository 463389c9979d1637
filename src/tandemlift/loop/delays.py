"""What goes through delay lines: readings on their way to the pilot, commands to the rotors, what a person sees."""

from __future__ import annotations

from typing import Any, NamedTuple


class Delayed(NamedTuple):
    """Marks what is delayed; by how many steps is data of the loop."""


class DelayLines(NamedTuple):
    """Of the readings of the unit on board, of those of the motion, of the rotors' commands, of what a person sees.

    `Delayed` or `Nothing` each.
    """

    unit: Any
    motion: Any
    command: Any
    seen: Any
