"""What goes through delay lines: readings on their way to the pilot, commands to the rotors, what a person sees."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.law import choice, law
from tandemlift.laws.partner import seeing
from tandemlift.laws.rotors import Spinning
from tandemlift.laws.sensing import Readings
from tandemlift.vector import Nothing


class Late(NamedTuple):
    """Marks what is delayed; by how many steps is data of the loop."""


class Lines(NamedTuple):
    """Of the readings of the unit on board, of those of the motion, of the rotors' commands, of what a person sees.

    Of a flight: `Late` or `Nothing` each. Of a step: the values that are on their way, where they are late.
    """

    unit: Any
    motion: Any
    command: Any
    seen: Any


class Ends(NamedTuple):
    """Where the lines begin and end: the rotors' memory, the readings, a person's memory."""

    rotors: Any
    readings: Any
    partner: Any


@choice
def unit_of(late: Any, ends: Ends) -> Any:
    """The unit's readings, if they are late."""


@choice
def motion_of(late: Any, ends: Ends) -> Any:
    """The motion's readings, if they are late."""


@choice
def command_of(late: Any, ends: Ends) -> Any:
    """The rotors' commands, if they are late."""


@choice
def seen_of(late: Any, ends: Ends) -> Any:
    """What a person sees, if it is late."""


@choice
def with_unit(late: Any, value: Any, readings: Any) -> Any:
    """Readings with what has arrived from the unit."""


@choice
def with_motion(late: Any, value: Any, readings: Any) -> Any:
    """Readings with what has arrived of the motion."""


@choice
def with_command(late: Any, value: Any, rotors: Any) -> Any:
    """The rotors' memory with the command that has arrived."""


@choice
def with_seen(late: Any, value: Any, partner: Any) -> Any:
    """A person's memory with what they come to see."""


for part in (unit_of, motion_of, command_of, seen_of):

    @part.register(Nothing)
    def _not_late(late, ends):
        return late


@unit_of.register(Late)
def _unit(late, ends):
    return ends.readings.unit


@motion_of.register(Late)
def _motion(late, ends):
    return ends.readings.motion


@command_of.register(Late)
def _command(late, ends):
    return ends.rotors.arriving


for part in (with_unit, with_motion, with_command, with_seen):

    @part.register(Nothing)
    def _as_it_is(late, value, end):
        return end


@seen_of.register(Late)
def _seen(late, ends):
    return ends.partner.seen


@with_unit.register(Late)
def _unit_arrives(late, value, readings):
    return Readings(value, readings.motion)


@with_motion.register(Late)
def _motion_arrives(late, value, readings):
    return Readings(readings.unit, value)


@with_command.register(Late)
def _command_arrives(late, value, rotors):
    return Spinning(rotors.speed, value)


@with_seen.register(Late)
def _seen_arrives(late, value, partner):
    return seeing(partner, value)


@law
def departing(late: Lines, ends: Ends) -> Lines:
    """What goes into the lines."""
    return Lines(
        unit_of(late.unit, ends), motion_of(late.motion, ends), command_of(late.command, ends), seen_of(late.seen, ends)
    )


@law
def arrived(late: Lines, line: Lines, ends: Ends) -> Ends:
    """The ends with what comes out of the lines."""
    readings = with_motion(late.motion, line.motion, with_unit(late.unit, line.unit, ends.readings))
    rotors, partner = (
        with_command(late.command, line.command, ends.rotors),
        with_seen(late.seen, line.seen, ends.partner),
    )
    return Ends(rotors, readings, partner)
