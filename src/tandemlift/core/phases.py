"""The phases of interactive guidance with their numbers in the channel `phase`, and the reasons for phase "limited".

`parts.guidance.phases` has the transitions. Recorded flights contain the numbers, so a new phase is added at the end.
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
    Phase("contact", "on", "followed along and away from the wall, and compensated", "stays outside the wall"),
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
