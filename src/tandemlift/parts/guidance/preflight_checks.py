"""Checks before a lift, and before the vehicle follows a person's pushes; `core.faults.CHECKS` names them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from tandemlift.core.algebra import maximum, where
from tandemlift.core.faults import CHECKS
from tandemlift.core.keys import Fraction, Positive, Scale, Table, Tilt, key
from tandemlift.core.law import Absent, choice, law
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import dot
from tandemlift.parts.guidance.requests import VehicleStatus
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import body_z_axis
from tandemlift.parts.sensors.health import WELL, WatchdogReport


class ChecksTable(Table):
    """`[supervision.checks]`: checks before a lift, and before the vehicle responds to a person."""

    thrust_fraction: Fraction = key(
        0.85,
        "1",
        "largest fraction of the largest thrust that hover may need",
        source="chosen: leaves 15 % for control",
    )
    tilt: Tilt = key(0.15, "rad", "largest tilt", source="chosen")
    speed: Positive = key(0.1, "m/s", "largest speed", source="chosen")
    rates: Positive = key(0.2, "rad/s", "largest angular speed", source="chosen")
    min_payload_ratio: Scale = key(
        0.5, "1", "minimum accepted mass estimate, as a fraction of the nominal payload mass", source="chosen"
    )
    max_payload_ratio: Scale = key(
        2.0,
        "1",
        "maximum accepted mass estimate, as a multiple of the nominal payload mass",
        rule="above min_payload_ratio",
        source="chosen",
    )


class PreflightChecks(NamedTuple):
    """Limits of the checks.

    Before a lift: largest fraction of the thrust in hover, smallest cosine of the tilt, speed [m/s], rates [rad/s].
    Before pushes are followed: smallest and largest plausible estimate of the payload's mass [kg].
    """

    thrust_fraction: Number
    min_upright: Number
    speed: Number
    rates: Number
    min_payload: Number
    max_payload: Number


class SensorStatus(NamedTuple):
    """The watchdogs' report; 1 if joints disagree, else 0; 1 once tared, else 0; the estimated payload mass [kg]."""

    report: WatchdogReport
    joints_inconsistent: Number
    tared: Number
    payload: Number


@choice
def sensor_status(sensed: object, payload: Number) -> SensorStatus:
    """`SensorStatus` from readings and estimates; `payload` is the nominal mass [kg], used where none is estimated."""


@sensor_status.register(Absent)
def _without_sensors(sensed: Absent, payload: Number) -> SensorStatus:
    return SensorStatus(WELL, 0.0, 1.0, payload)


def first_failed(before: str, fails: Mapping[str, Any]) -> Number:
    """The number of the first check before a phase that fails (above 0, by the check's key), or 0."""
    number = 0.0
    for check in reversed([c for c in CHECKS if c.before == before]):
        number = where(fails[check.key] > 0.0, float(check.number), number)
    return number


@law
def failed_lift_check(
    c: PreflightChecks,
    s: SensorStatus,
    state: State,
    status: VehicleStatus,
    mass: Number,
    reaction: Number,
    available: Number,
) -> Number:
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
def failed_guidance_check(c: PreflightChecks, s: SensorStatus) -> Number:
    """The number of the first check that fails before pushes are followed, or 0."""
    plausible = where(s.payload < c.min_payload, 0.0, where(s.payload > c.max_payload, 0.0, 1.0))
    fails = {"tare": 1.0 - s.tared, "payload": 1.0 - plausible, "joints": s.joints_inconsistent}
    return first_failed("guided", fails)
