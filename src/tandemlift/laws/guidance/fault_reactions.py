"""What can go wrong in flight, the number of each, and how the worst of it is found: fault → reaction.

An alarm is ten times the number of a fault in `FAULTS`, plus what is wrong with a sensor (`health.KINDS`, from 1).
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import where
from tandemlift.laws.sensors.health import KINDS

HOLDS, LANDS, STOPS = 1.0, 2.0, 3.0
REACTIONS = ("none", "hold", "land", "stop")
FAULTS = (
    "unit stale",
    "joints",
    "accelerometer",
    "gyroscope",
    "motion stale",
    "position",
    "velocity",
    "attitude",
    "joints disagree",
    "attitude disagrees with gyroscope",
    "velocity disagrees with position",
    "state not a number",
    "attitude and gyroscope lost",
    "outside the fence",
    "too little thrust left",
    "tilted too far",
    "turning too fast",
    "too far from the reference",
    "rotor lost",
    "accelerometer disagrees with velocity",
)
CHECKS = (
    "unit not heard",
    "motion not heard",
    "a sensor is not well",
    "hover not feasible",
    "not level",
    "not at rest",
    "a rotor is lost",
    "no tare yet",
    "payload mass not plausible",
    "joints disagree",
)


class ActiveFaults(NamedTuple):
    """By fault, in the order of `FAULTS`: what is wrong (of a sensor, `KINDS` from 1), 1 for a fault, 0 for none."""

    imu: Any
    joints: Any
    accelerometer: Any
    gyroscope: Any
    motion: Any
    position: Any
    velocity: Any
    attitude: Any
    joints_inconsistent: Any
    attitude_inconsistent: Any
    velocity_inconsistent: Any
    state: Any
    orientation: Any
    fence: Any
    thrust: Any
    tilt: Any
    rates: Any
    tracking_error: Any
    rotor: Any
    speed_inconsistent: Any


class FaultReaction(NamedTuple):
    """The strongest reaction that is called for, and the alarm of the first fault that calls for it; or zeros."""

    reaction: Any
    alarm: Any


NO_ALARM = FaultReaction(0.0, 0.0)


@law
def stronger(w: FaultReaction, fault: Any, reaction: Any, alarm: Any) -> FaultReaction:
    """The worst with one more fault, if it is there (above 0) and calls for more."""
    more = where(fault > 0.0, where(reaction > w.reaction, 1.0, 0.0), 0.0)
    return FaultReaction(where(more > 0.0, reaction, w.reaction), where(more > 0.0, alarm, w.alarm))


@law
def strongest_reaction(f: ActiveFaults, r: ActiveFaults) -> FaultReaction:
    """The worst of faults `f`, with the reactions `r` to each."""
    w = stronger(NO_ALARM, f.orientation, r.orientation, 130.0)
    w = stronger(w, f.state, r.state, 120.0)
    w = stronger(w, f.imu, r.imu, 10.0)
    w = stronger(w, f.motion, r.motion, 50.0)
    w = stronger(w, f.joints, r.joints, 20.0 + f.joints)
    w = stronger(w, f.accelerometer, r.accelerometer, 30.0 + f.accelerometer)
    w = stronger(w, f.gyroscope, r.gyroscope, 40.0 + f.gyroscope)
    w = stronger(w, f.position, r.position, 60.0 + f.position)
    w = stronger(w, f.velocity, r.velocity, 70.0 + f.velocity)
    w = stronger(w, f.attitude, r.attitude, 80.0 + f.attitude)
    w = stronger(w, f.joints_inconsistent, r.joints_inconsistent, 90.0)
    w = stronger(w, f.attitude_inconsistent, r.attitude_inconsistent, 100.0)
    w = stronger(w, f.velocity_inconsistent, r.velocity_inconsistent, 110.0)
    w = stronger(w, f.speed_inconsistent, r.speed_inconsistent, 200.0)
    w = stronger(w, f.rotor, r.rotor, 190.0)
    w = stronger(w, f.tilt, r.tilt, 160.0)
    w = stronger(w, f.rates, r.rates, 170.0)
    w = stronger(w, f.fence, r.fence, 140.0)
    w = stronger(w, f.thrust, r.thrust, 150.0)
    return stronger(w, f.tracking_error, r.tracking_error, 180.0)


def alarm_name(alarm: float) -> str:
    """An alarm in words, such as "gyroscope frozen"."""
    fault, kind = divmod(round(alarm), 10)
    return FAULTS[fault - 1] + (f" {KINDS[kind - 1]}" if kind else "")
