"""The phases of a flight by hand: their names, their numbers in the channel `phase`, and what each allows.

`laws.guidance.phases` moves from one to another. Numbers are those of recorded flights: a new phase goes to the end.
"""

from __future__ import annotations

from typing import NamedTuple


class Phase(NamedTuple):
    """A phase: its name, the state of the rotors, what the vehicle does with a push, and the reference."""

    name: str
    rotors: str
    pushes: str
    reference: str


PHASES = (
    Phase("idle", 'off (on with `phases.rotors = "always"`)', "ignored", "stays at the vehicle"),
    Phase("lift", "on", "compensated", "rises by `phases.height`"),
    Phase("guided", "on", "followed and compensated", "follows the push"),
    Phase("land", "on", "compensated", "descends, at most at `compliance.max_descent_speed`"),
    Phase("hold", "on", "compensated", "brakes and stays in place"),
    Phase("stopped", "off", "ignored", "stays at the vehicle"),
    Phase("contact", "on", "followed along and away from the wall, and compensated", "stays out of the wall"),
)
PHASE_NAMES = tuple(phase.name for phase in PHASES)
IDLE, LIFT, GUIDED, LAND, HOLD, STOPPED, CONTACT = map(float, range(len(PHASES)))
PHASE_NUMBERS = ", ".join(f"{number} {name}" for number, name in enumerate(PHASE_NAMES))
"""The numbers with their names, as the meaning of the channel `phase`."""
