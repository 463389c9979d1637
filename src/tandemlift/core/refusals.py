"""The reasons for which a pilot refuses to lift or land, or does not follow a push, each with a remedy.

`simulation.refusals` computes the number of the reason and the numbers in its text. The texts come from here, so
Python, the live page and the ROS node show the same.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

from tandemlift.core.faults import ALARM_TEXTS as ALARM_TEXTS
from tandemlift.core.faults import CHECKS

Request = Literal["lift", "land", "push"]
REQUESTS: tuple[Request, ...] = get_args(Request)
OPENINGS: dict[Request, str] = {
    "lift": "Lift is refused",
    "land": "Landing is refused",
    "push": "The push is not followed",
}
AGAIN = "Begin the flight again."
REPAIR = "Repair it; in simulation, begin the flight again."
CONNECT = "See that the sensor is switched on and connected."
LEAVE_WALL = "Pull it away from the wall; along the wall it follows."
WAIT_FOR_GROUND = "Wait until it stands on the ground, then lift it off again."


class PilotRefusal(NamedTuple):
    """The reason for which a request is refused or a push is not followed, and the remedy, each a sentence."""

    request: str
    why: str
    advice: str

    def __str__(self) -> str:
        return f"{self.why} {self.advice}".rstrip()


class RefusalReason(NamedTuple):
    """A reason.

    Attributes:
        key: its name in `simulation.refusals`.
        text: a clause; {value} and {limit} are numbers, {alarm} is the text of the alarm whose number the value is.
        advice: what to do.
    """

    key: str
    text: str
    advice: str

    @property
    def number(self) -> int:
        """Its number, from 1; 0 stands for no reason."""
        return REASONS.index(self) + 1


CHECK_REASONS = (  # for checks, by the key in `core.faults.CHECKS`
    RefusalReason("imu", "no inertial measurement arrives", CONNECT),
    RefusalReason("motion", "no motion measurement arrives", CONNECT),
    RefusalReason("sensors", "a sensor has failed: {alarm}", REPAIR),
    RefusalReason(
        "hover", "hover needs {value} % of the thrust, limit {limit} %", "Take load off, or take stronger rotors."
    ),
    RefusalReason(
        "level",
        "the vehicle is not level ({value}°, limit {limit}°)",
        "Set it upright; in simulation, begin the flight again.",
    ),
    RefusalReason(
        "rest", "the vehicle is not at rest ({value} m/s, limit {limit} m/s)", "Let go, and wait until it rests."
    ),
    RefusalReason("rotors", "a rotor has failed", REPAIR),
    RefusalReason("tare", "the force sensors are not tared yet", "Keep your hands off until they are."),
    RefusalReason(
        "payload",
        "the estimated mass of the payload, {value} kg, is not plausible",
        "Check the payload against `vehicle.payload.mass`, and tare in still air without touching it.",
    ),
    RefusalReason("joints", "the joints' force sensors disagree", "Let go, and wait until they agree again, or land."),
)
OTHER_REASONS = (
    RefusalReason(
        "scheduled", "lift and landing are scheduled", 'Fly a mission with `pilot.guidance = "interactive"`.'
    ),
    RefusalReason("in_air", "the vehicle is in the air already", "Push it to where it should go, or land it."),
    RefusalReason("on_ground", "the vehicle stands on the ground", "Lift it off first."),
    RefusalReason("landed", "the vehicle stands on the ground already", ""),
    RefusalReason("lifting", "the vehicle is still lifting off", "Wait until it is up."),
    RefusalReason("landing", "the vehicle is landing, which cannot be cancelled", WAIT_FOR_GROUND),
    RefusalReason("stopped", "the rotors were stopped, which is final", AGAIN),
    RefusalReason("once", "rotors that always run lift only once", AGAIN),
    RefusalReason("turning", "the vehicle is not at rest ({value} rad/s, limit {limit} rad/s)", "Wait until it rests."),
    RefusalReason("unknown_sensor", "a sensor has failed", REPAIR),
    RefusalReason("recovering", "the last fault is over for {value} s only, of {limit} s", "Ask again a moment later."),
    RefusalReason("fault", "there is a fault ({alarm})", "Let go, and wait until it is over."),
    RefusalReason("limited", "the vehicle {alarm}", "Push less, and wait until it can follow again."),
    RefusalReason("beam_touches", "the beam touches a wall", LEAVE_WALL),
    RefusalReason("guard_touches", "the guard of quadrotor {value} touches a wall", LEAVE_WALL),
    RefusalReason("disabled", "the pilot is told not to follow pushes", "Let it follow again."),
    RefusalReason("over", "the flight is over", AGAIN),
    RefusalReason("stopped_early", "the flight has crashed or diverged", AGAIN),
    RefusalReason("error", "the flight has ended by an error in the software", AGAIN),
    RefusalReason("weak", "it is below the threshold ({value} N, limit {limit} N)", "Push harder."),
)
REASONS = (*CHECK_REASONS, *OTHER_REASONS)
NUMBER_OF = {reason.key: float(reason.number) for reason in REASONS}
assert tuple(reason.key for reason in CHECK_REASONS) == tuple(check.key for check in CHECKS)


class Refusals(NamedTuple):
    """The refusals that would apply now, or None: of a lift, of a landing, of following a push."""

    lift: PilotRefusal | None
    land: PilotRefusal | None
    push: PilotRefusal | None


def refusals_for(key: str) -> Refusals:
    """The refusals of all requests for the same reason, which has no numbers."""
    return Refusals(*[refusal_of(request, NUMBER_OF[key], 0.0, 0.0) for request in REQUESTS])


def sentences() -> dict[str, list[str]]:
    """The refusals of each request for each reason, by its number, with placeholders in braces."""
    return {request: ["", *[str(_refusal(request, reason)) for reason in REASONS]] for request in REQUESTS}


def refusal_of(request: Request, number: float, value: float, limit: float) -> PilotRefusal | None:
    """The refusal for the number of a reason and the numbers in its text; None for 0, no reason.

    Args:
        request: the refused request.
        number: of the reason.
        value: the number in the text, rounded; for an alarm, its number.
        limit: of the value.
    """
    if not number:
        return None
    refusal = _refusal(request, REASONS[int(number) - 1])
    alarm = ALARM_TEXTS[int(value)] if "{alarm}" in refusal.why else ""
    return refusal._replace(why=refusal.why.format(value=f"{value:g}", limit=f"{limit:g}", alarm=alarm))


def _refusal(request: Request, reason: RefusalReason) -> PilotRefusal:
    """The refusal of a request for a reason, with placeholders in braces."""
    return PilotRefusal(request, f"{OPENINGS[request]}: {reason.text}.", reason.advice)
