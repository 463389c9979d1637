"""Checks before a lift, and before the vehicle follows a person's pushes; `core.faults.CHECKS` names them."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from tandemlift.core.algebra.constants import GRAVITY
from tandemlift.core.algebra.law import Nothing, choice, law
from tandemlift.core.algebra.ops import maximum, where
from tandemlift.core.algebra.vector import dot
from tandemlift.core.faults import CHECKS
from tandemlift.parts.guidance.requests import VehicleStatus
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import body_z_axis
from tandemlift.parts.sensors.health import WELL, WatchdogReport


class PreflightChecks(NamedTuple):
    """Limits of the checks.

    Before a lift: largest fraction of the thrust in hover, smallest cosine of the tilt, speed [m/s], rates [rad/s].
    Before pushes are followed: smallest and largest plausible estimate of the payload's mass [kg].
    """

    thrust_fraction: Any
    min_upright: Any
    speed: Any
    rates: Any
    min_payload: Any
    max_payload: Any


class SensorStatus(NamedTuple):
    """The watchdogs' report; 1 if joints disagree, else 0; 1 once tared, else 0; the estimated payload mass [kg]."""

    report: WatchdogReport
    joints_inconsistent: Any
    tared: Any
    payload: Any


@choice
def sensor_status(sensed: Any, payload: Any) -> Any:
    """`SensorStatus` from readings and estimates; `payload` is the nominal mass [kg], used where none is estimated."""


@sensor_status.register(Nothing)
def _without_sensors(sensed: Nothing, payload: Any) -> SensorStatus:
    return SensorStatus(WELL, 0.0, 1.0, payload)


@law
def first_check(number: Any, fails: Any, others: Any) -> Any:
    """The number of a check if it fails (above 0), else that of the first of the others."""
    return where(fails > 0.0, number, others)


def first_failed(before: str, fails: Mapping[str, Any]) -> Any:
    """The number of the first check before a phase that fails (above 0, by the check's key), or 0."""
    number = 0.0
    for check in reversed([c for c in CHECKS if c.before == before]):
        number = first_check(float(check.number), fails[check.key], number)
    return number


@law
def failed_lift_check(
    c: PreflightChecks, s: SensorStatus, state: State, status: VehicleStatus, mass: Any, reaction: Any, available: Any
) -> Any:
    """The number of the first check that fails before a lift, or 0.

    Args:
        c: limits of the checks.
        s: the sensors.
        state: of the vehicle.
        status: of the vehicle.
        mass: of the vehicle, with the estimated payload [kg].
        reaction: above 0 while there is a reaction to a fault.
        available: thrust of all rotors with their known faults [N].
    """
    r = s.report
    failed = r.joints + r.accelerometer + r.gyroscope + r.position + r.velocity + r.attitude + status.state_invalid
    moving = where(dot(state.velocity, state.velocity) > c.speed * c.speed, 1.0, 0.0)
    turning = where(dot(state.rates, state.rates) > c.rates * c.rates, 1.0, 0.0)
    fails = {
        "imu": maximum(r.imu, 1.0 - r.seen),
        "motion": maximum(r.motion, 1.0 - r.seen),
        "sensors": failed + s.joints_inconsistent + reaction,
        "hover": where(mass * GRAVITY > c.thrust_fraction * available, 1.0, 0.0),
        "level": where(body_z_axis(state.attitude).z < c.min_upright, 1.0, 0.0),
        "rest": moving + turning,
        "rotors": status.rotor_failed,
    }
    return first_failed("lift", fails)


@law
def failed_guidance_check(c: PreflightChecks, s: SensorStatus) -> Any:
    """The number of the first check that fails before pushes are followed, or 0."""
    plausible = where(s.payload < c.min_payload, 0.0, where(s.payload > c.max_payload, 0.0, 1.0))
    fails = {"tare": 1.0 - s.tared, "payload": 1.0 - plausible, "joints": s.joints_inconsistent}
    return first_failed("guided", fails)
