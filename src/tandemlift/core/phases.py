"""The phases of interactive guidance, the reasons for phase "limited", and the outcomes and endings of a flight.

`parts.guidance.phases` has the transitions, `simulation.outcome` forms the outcome. Recorded flights contain the
numbers of phases, so a new phase is added at the end.
"""

from __future__ import annotations

from typing import NamedTuple


class Phase(NamedTuple):
    """A phase: its name, the state of the rotors, the effect of a push, and the motion of the reference."""

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
    Phase(
        "contact", "on", "followed along the wall (a guard: away from it, too); compensated", "stays outside the wall"
    ),
    Phase("limited", "on", "compensated", "brakes and stays in place, as the vehicle cannot follow"),
)
PHASE_NAMES = tuple(phase.name for phase in PHASES)
IDLE, LIFT, GUIDED, LAND, HOLD, STOPPED, CONTACT, LIMITED = map(float, range(len(PHASES)))
PHASE_NUMBERS = ", ".join(f"{number} {name}" for number, name in enumerate(PHASE_NAMES))
"""The numbers with their names, as the meaning of the channel `phase`."""


class Reason(NamedTuple):
    """A reason why the vehicle cannot follow its reference: its key in the law, its text, and its detection."""

    key: str
    text: str
    detection: str


REASONS = (  # by priority: the first that is present is reported
    Reason(
        "thrust",
        "no thrust left",
        "weight, disturbance and push need more than `compliance.thrust_fraction` of the largest thrust",
    ),
    Reason(
        "tilt",
        "pushed aside too hard",
        "disturbance and push need more tilt than `compliance.max_tilt`, or than the controller's `max_tilt`",
    ),
    Reason("heading", "heading lost", "the heading is off by 90 % of `compliance.yaw.max_lead_angle`"),
    Reason("position", "too far from the reference", "the position is off by `compliance.following.max_error`"),
)
REASON_NUMBERS = ", ".join(f"{number} {reason.text}" for number, reason in enumerate(REASONS, start=1))
"""The numbers with their texts, as the meaning of the channel `limited_reason`."""


LARGEST_DISTANCE = 1000.0  # m
CRASH_SPEED = 2.0  # m/s: an impact that stops the vehicle from this speed is a crash, unless `crash.impulse` is set
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
        "at the end the floor carries at least half the weight and the speed is below `outcome.landed_speed`; without "
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
        DIVERGED,
        "diverged",
        "distance from the origin [m]",
        f"it exceeds {LARGEST_DISTANCE:g} m, or a number is not finite",
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
