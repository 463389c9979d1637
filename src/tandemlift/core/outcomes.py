"""The outcomes of a flight, and the reasons to stop a flight before its end, each in one record.

The laws in `simulation.loop.ending` detect these reasons; `simulation.outcome` forms the outcome.
"""

from __future__ import annotations

from typing import NamedTuple

FAR = 1000.0  # m
HARD = 2.0  # m/s: a blow that stops the vehicle from this speed is a crash, unless `crash.impulse` says otherwise
INTERRUPTED = "interrupted"
FLIES, DIVERGED, TURNED_OVER, STRUCK, LEFT_FENCE = map(float, range(5))  # values of `FlightState.ended`


class OutcomeKind(NamedTuple):
    """An outcome: its name in metrics.json, its meaning, and whether it is a failure (exit code 3)."""

    name: str
    meaning: str
    failed: bool


class EndingKind(NamedTuple):
    """A reason to stop a flight: its number, the outcome, the measured quantity, and the condition."""

    number: float
    outcome: str
    quantity: str
    condition: str


OUTCOMES = (
    OutcomeKind(
        "landed",
        "at the end the floor bears at least half of the weight and the speed is below `outcome.landed_speed`; without "
        "a floor, the landing is over and the vehicle is within `outcome.landed_height` of its start in z",
        False,
    ),
    OutcomeKind("flying", "in the air at the end", False),
    OutcomeKind(
        "not-lifted",
        "a lift of the mission should be over, but the vehicle never rose by `outcome.lifted_height`, or "
        "half of a lower lift",
        True,
    ),
    OutcomeKind("crashed", "turned over, struck something, or left the fence; the flight is stopped there", True),
    OutcomeKind("diverged", "the state is not finite, or too far away; the flight is stopped there", True),
    OutcomeKind(INTERRUPTED, "the engine ended, or no longer answered; the flight is recorded until there", True),
)
ENDINGS = (
    EndingKind(
        DIVERGED, "diverged", "distance from the origin [m]", f"it exceeds {FAR:g} m, or a number is not finite"
    ),
    EndingKind(TURNED_OVER, "crashed", "tilt [deg]", "body z is more than `crash.tilt` from world z"),
    EndingKind(
        STRUCK, "crashed", "impulse of contact [N s]", "contact beyond the weight gives more than `crash.impulse`"
    ),
    EndingKind(
        LEFT_FENCE,
        "crashed",
        "distance outside the fence [m]",
        "the vehicle is outside `supervision.fence` by more than `crash.fence_margin`",
    ),
)
ENDING_OF = {kind.number: kind for kind in ENDINGS}
FAILURES = {kind.name: f"{kind.name}: {kind.meaning}" for kind in OUTCOMES if kind.failed}
"""The outcomes of failed flights, with their meanings."""
